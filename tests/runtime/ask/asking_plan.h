// A plan that asks one question of each form about carrot_on_plate, made without the compiler, and
// a small reader of plain answers.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/ask/ask.h"
#include "runtime/base/check.h"
#include "runtime/plan/questions.h"
#include "tests/runtime/run/table_plan.h"

namespace probe::ask {

struct WrittenOption {
  std::string text;
  std::uint32_t body = plan::kNone;
  bool must_be_seen = false;
};

// Families and questions of task 0, in the order of the calls.
class QuestionWriter {
 public:
  explicit QuestionWriter(plan::Writer& writer) : writer_(writer) {}

  plan::FamilyRecord& family(const std::string& name, plan::QuestionForm form,
                             std::uint32_t pixels = 64) {
    plan::FamilyRecord family;
    family.set = writer_.text("understanding");
    family.name = writer_.text(name);
    family.text = writer_.text(name + "?");
    family.form = static_cast<std::uint32_t>(form);
    family.moment = static_cast<std::uint32_t>(plan::QuestionMoment::kStart);
    family.pixels = pixels;
    writer_.records.families.push_back(family);
    return writer_.records.families.back();
  }

  // Of the last family.
  plan::QuestionRecord& question(const std::string& text, plan::QuestionTruth truth,
                                 const std::vector<WrittenOption>& options) {
    plan::QuestionRecord question;
    question.family = static_cast<std::uint32_t>(writer_.records.families.size() - 1);
    question.task = 0;
    question.text = writer_.text(text);
    question.truth = static_cast<std::uint32_t>(truth);
    std::vector<plan::OptionRecord> records;
    for (const WrittenOption& option : options) {
      plan::OptionRecord record;
      record.text = writer_.text(option.text);
      record.body = option.body;
      record.flags = option.must_be_seen ? plan::kMustBeSeen : 0;
      records.push_back(record);
    }
    question.options = plan::append<plan::OptionRecord>(writer_.records.options, records);
    writer_.records.questions.push_back(question);
    return writer_.records.questions.back();
  }

 private:
  plan::Writer& writer_;
};

// source (3 options), there, many, left, where, restate, done (at the end).
inline void ask_everything(plan::Writer& writer) {
  using enum plan::QuestionForm;
  using plan::QuestionTruth;
  QuestionWriter q(writer);
  const WrittenOption carrot{"carrot", 0, true}, plate{"plate", 1, true}, towel{"towel"};
  q.family("source", kChoice);
  q.question("A robot is told: \"put carrot on plate\". Which object must it pick up?",
             QuestionTruth::kProved, {carrot, plate, towel})
      .right = 0;
  q.family("there", kYesNo);
  q.question("Is there a towel on the table?", QuestionTruth::kProved, {towel}).right = 0;
  q.family("many", kNumber);
  q.question("How many carrots are in the picture?", QuestionTruth::kProved, {carrot}).right = 1;
  q.family("left", kYesNo);
  auto& left = q.question("Is the carrot to the left of the plate in the picture?",
                          QuestionTruth::kLeftOf, {carrot, plate});
  left.a = 0;
  left.b = 1;
  q.family("where", kPoint);
  q.question("Point at the carrot. Answer with x, y in pixels.", QuestionTruth::kPixelsOf, {carrot})
      .a = 0;
  q.family("restate", kFree);
  auto& restate = q.question("Say in one short sentence what the robot has to do.",
                             QuestionTruth::kMentions, {carrot, plate});
  restate.a = 0;
  restate.b = 1;
}

// Whether the carrot is over the plate.
inline void ask_over(plan::Writer& writer, const std::string& name, const std::string& text,
                     plan::QuestionMoment moment, plan::QuestionTruth truth) {
  using enum plan::Op;
  const auto make = [](plan::Op op, unsigned dst, unsigned a = 0, unsigned b = 0) {
    return plan::Instruction{static_cast<std::uint8_t>(op), 0, static_cast<std::uint16_t>(dst),
                             static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b)};
  };
  plan::Records& r = writer.records;
  const std::vector<double> constants = {0.05};
  const std::vector<plan::Instruction> code = {
      make(kPOS, 0, 0), make(kPOS, 1, 1),   make(kVSUB, 2, 0, 1),  make(kVLENXY, 3, 2),
      make(kKR, 4, 0),  make(kLE, 5, 3, 4), make(kEMITB, 6, 5, 0), make(kEND, 6)};
  const std::vector<plan::MetricRecord> metrics = {
      {writer.text(name), static_cast<std::uint32_t>(plan::MetricType::kBool),
       static_cast<std::uint32_t>(plan::Readout::kAtEnd)}};
  plan::ProgramRecord program;
  program.constants = plan::append<double>(r.constants, constants);
  program.states.first = static_cast<std::uint32_t>(r.states.size());
  program.code = plan::append<plan::Instruction>(r.code, code);
  program.metrics = plan::append<plan::MetricRecord>(r.metrics, metrics);
  r.programs.push_back(program);
  QuestionWriter q(writer);
  q.family(name, plan::QuestionForm::kYesNo).moment = static_cast<std::uint32_t>(moment);
  q.question(text, truth, {}).program = static_cast<std::uint32_t>(r.programs.size() - 1);
}

// About the end of a recorded episode.
inline void ask_done(plan::Writer& writer) {
  ask_over(writer, "done", "The robot was told: \"put carrot on plate\". Has it done so?",
           plan::QuestionMoment::kEnd, plan::QuestionTruth::kRecorded);
}
// About the settled start.
inline void ask_begun(plan::Writer& writer) {
  ask_over(writer, "begun", "Is the carrot over the plate?", plan::QuestionMoment::kStart,
           plan::QuestionTruth::kSettled);
}

inline plan::Plan asking_plan(std::uint32_t episodes,
                              const std::function<void(plan::Writer&)>& ask = ask_everything) {
  run::TablePlan table(std::string(VLAPROBE_SOURCE_DIR) + "/assets");
  auto bytes = table.write_with(episodes, 3, ask);
  PROBE_CHECK(bytes.ok(), bytes.ok() ? "" : to_text(bytes.failure()).c_str());
  return plan::Plan::from_bytes(std::move(*bytes)).value();
}

}  // namespace probe::ask
