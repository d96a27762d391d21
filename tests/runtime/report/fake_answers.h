// Folders of made-up answers to a plan's questions, without pictures or servers.
#pragma once

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/ask/answers.h"
#include "runtime/ask/plan_reading.h"
#include "runtime/ask/queries.h"
#include "runtime/ask/truth.h"
#include "runtime/ask/wording.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/ids.h"
#include "runtime/plan/plan.h"
#include "runtime/plan/questions.h"

namespace probe::report {

// What the model says to all orders of a question about a start: right, wrong, or nothing that can
// be read.
enum class Said { kRight, kWrong, kUnclear, kInvalid, kNotAsked };
using AnswerScript =
    std::function<Said(const std::string& family, const std::string& task, int episode)>;

// What is right: as the text proves it, or of what a picture shows, yes, and a point of its own.
inline ask::Truth fake_truth(const plan::Plan& plan, const plan::QuestionRecord& question) {
  if (const auto known = ask::known_truth(plan, question)) return *known;
  if (plan::truth_of(question) == plan::QuestionTruth::kPixelsOf)
    return {.expected = "on `it`, such as (300, 200)"};
  return {.yes = true, .expected = "yes"};
}

// Words that are right, or wrong, and nothing else.
inline std::string fake_words(const plan::Plan& plan, const plan::QuestionRecord& question,
                              const ask::Wording& wording, bool right) {
  const ask::Truth truth = fake_truth(plan, question);
  const auto options = ask::options_of(plan, question);
  switch (plan::form_of(plan.families()[question.family])) {
    case plan::QuestionForm::kChoice:
      for (std::size_t place = 0; place < wording.shown.size(); ++place) {
        if ((wording.shown[place] == *truth.option) == right) return ask::letter_of(place);
      }
      break;
    case plan::QuestionForm::kYesNo:
      return *truth.yes == right ? "yes" : "no";
    case plan::QuestionForm::kNumber:
      return std::to_string(*truth.number + (right ? 0 : 1));
    case plan::QuestionForm::kPoint:
      return right ? "(300, 200)" : "(3, 2)";
    case plan::QuestionForm::kFree:
      return fmt::format("Put the {} on the {}.",
                         plan.text(options[right ? question.a : question.b].text),
                         plan.text(options[right ? question.b : question.a].text));
  }
  return {};
}

// How probable the server says each letter of a choice is; the words are chosen without them.
enum class Letters { kUntold, kRight, kTied };
inline std::vector<std::optional<double>> fake_letters(const plan::Plan& plan,
                                                       const plan::QuestionRecord& question,
                                                       const ask::Wording& wording,
                                                       Letters letters) {
  const bool is_choice =
      plan::form_of(plan.families()[question.family]) == plan::QuestionForm::kChoice;
  if (letters == Letters::kUntold || !is_choice) return {};
  const ask::Truth truth = fake_truth(plan, question);
  std::vector<std::optional<double>> logprobs;
  for (const std::uint32_t option : wording.shown)
    logprobs.emplace_back(letters == Letters::kTied || option == *truth.option ? -0.1 : -5.0);
  return logprobs;
}

// As asking would store it.
inline void fake_answer(const plan::Plan& plan, const plan::QuestionRecord& question, Said said,
                        ask::AnswerRow& row, Letters letters = Letters::kUntold) {
  const ask::Wording wording = ask::word(plan, question, row.rotation, 640, 480);
  row.text = wording.text;
  row.prompt_sha256 = to_hex(sha256(row.text));
  row.usage.letter_logprobs = fake_letters(plan, question, wording, letters);
  const ask::Truth truth = fake_truth(plan, question);
  row.expected = truth.expected;
  if (said == Said::kInvalid) {
    row.invalid = "the server hung up";
    return;
  }
  row.raw =
      said == Said::kUnclear ? "hm" : fake_words(plan, question, wording, said == Said::kRight);
  if (plan::truth_of(question) == plan::QuestionTruth::kMentions) {
    const ask::Restatement restated = ask::restate(plan, question, row.raw, row.usage.finish);
    row.reading = restated.reading;
    row.right = restated.right;
    row.copied = restated.copied;
    return;
  }
  row.reading =
      ask::read_answer(ask::read_context(plan, question, wording.shown, 640, 480), row.raw);
  row.right = row.reading.point ? said == Said::kRight : ask::is_right(truth, row.reading);
}

// Makes DIR, or goes on with it under another arm, with an answer to every question about the start
// of every task in every order.
inline void fake_answers(const std::string& dir, const plan::Plan& plan, const std::string& model,
                         const AnswerScript& script, ask::Arm arm = ask::Arm::kPicture,
                         Letters letters = Letters::kUntold) {
  ask::AskRecord record;
  record.identity.plan_root = to_hex(plan.root());
  record.identity.model = model;
  record.suite = plan.text(plan.suites()[0].name);
  record.fingerprint.entries = {{"cpu", "test"}};
  auto answers = ask::Answers::open(dir, record, plan.bytes());
  REQUIRE_MESSAGE(answers.ok(), to_text(answers.failure()));
  for (std::uint32_t q = 0; q < plan.questions().size(); ++q) {
    const plan::QuestionRecord& question = plan.questions()[q];
    const plan::FamilyRecord& family = plan.families()[question.family];
    if (plan::moment_of(family) != plan::QuestionMoment::kStart) continue;
    const plan::TaskRecord& task = plan.tasks()[question.task];
    for (const plan::EpisodeRecord& episode : plan.episodes(task)) {
      ask::AnswerRow row;
      row.question_id = to_hex(plan::to_sha256(question.question_id));
      row.start_id = to_hex(plan::to_sha256(episode.start_id));
      row.episode = static_cast<int>(episode.index);
      row.set = plan.text(family.set);
      row.family = plan.text(family.name);
      row.task = plan.text(task.name);
      row.model = model;
      row.arm = arm;
      const Said said = script(row.family, row.task, row.episode);
      if (said == Said::kNotAsked) continue;
      for (row.rotation = 0; row.rotation < ask::rotations_of(plan, question); ++row.rotation) {
        fake_answer(plan, question, said, row, letters);
        REQUIRE((*answers)->commit(row, q).ok());
      }
    }
  }
  REQUIRE((*answers)->flush().ok());
}

}  // namespace probe::report
