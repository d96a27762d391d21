// The small plan with a question of each form asked of its first task, one left out of the second.
#pragma once

#include "runtime/plan/questions.h"
#include "tests/runtime/plan/small_plan.h"

namespace probe::plan {

inline void add_family(Writer& w, std::string_view name, QuestionForm form,
                       QuestionMoment moment = QuestionMoment::kStart) {
  FamilyRecord family;
  family.set = w.text("understanding");
  family.name = w.text(name);
  family.text = w.text("What of {source}?");
  family.form = static_cast<std::uint32_t>(form);
  family.moment = static_cast<std::uint32_t>(moment);
  family.pixels = 64;
  w.records.families.push_back(family);
}

// One truth, read at the end: whether the tool is near the carrot.
inline std::uint32_t add_truth(Writer& w) {
  using enum Op;
  Records& r = w.records;
  ProgramRecord program;
  program.constants = append<double>(r.constants, std::vector<double>{0.05});
  const std::vector<Instruction> code = {
      make_instruction(kPOS, 0, 0),      make_instruction(kTCP, 1),
      make_instruction(kVSUB, 2, 0, 1),  make_instruction(kVLEN, 3, 2),
      make_instruction(kKR, 4, 0),       make_instruction(kLT, 5, 3, 4),
      make_instruction(kEMITB, 6, 5, 0), make_instruction(kEND, 6)};
  program.states = {static_cast<std::uint32_t>(r.states.size()), 0};
  program.code = append<Instruction>(r.code, code);
  program.metrics = append<MetricRecord>(
      r.metrics,
      std::vector<MetricRecord>{{w.text("done"), static_cast<std::uint32_t>(MetricType::kBool),
                                 static_cast<std::uint32_t>(Readout::kAtEnd)}});
  r.programs.push_back(program);
  return static_cast<std::uint32_t>(r.programs.size() - 1);
}

inline Slice add_options(Writer& w, bool with_absent) {
  Records& r = w.records;
  const auto words = [&](std::string_view word) {
    return append<StringRef>(r.words, std::vector<StringRef>{w.text(word)});
  };
  std::vector<OptionRecord> options(2);
  options[0].text = w.text("carrot");
  options[0].body = 0;
  options[0].flags = kMustBeSeen;
  options[0].words = words("orange thing");
  options[1].text = w.text("plate");
  options[1].body = 1;
  if (with_absent) {
    options.push_back({});
    options[2].text = w.text("spoon");
    options[2].words = words("shiny thing");
  }
  return append<OptionRecord>(r.options, options);
}

inline QuestionRecord& add_question(Writer& w, std::uint32_t family, QuestionTruth truth) {
  QuestionRecord question;
  question.family = family;
  question.task = 0;
  question.text = w.text("What of the carrot?");
  question.truth = static_cast<std::uint32_t>(truth);
  question.options = add_options(w, family == 0);
  w.records.questions.push_back(question);
  return w.records.questions.back();
}

// Is there a spoon? It is in no scene.
inline void add_presence(Writer& w, std::uint32_t family) {
  QuestionRecord question;
  question.family = family;
  question.task = 0;
  question.text = w.text("Is there a spoon on the table?");
  question.truth = static_cast<std::uint32_t>(QuestionTruth::kProved);
  OptionRecord spoon;
  spoon.text = w.text("spoon");
  question.options = append<OptionRecord>(w.records.options, std::vector<OptionRecord>{spoon});
  question.right = 0;
  w.records.questions.push_back(question);
}

inline Writer question_writer() {
  Writer w = small_writer();
  add_family(w, "which", QuestionForm::kChoice);
  add_family(w, "left", QuestionForm::kYesNo);
  add_family(w, "many", QuestionForm::kNumber);
  add_family(w, "where", QuestionForm::kPoint);
  add_family(w, "say", QuestionForm::kFree);
  add_family(w, "done", QuestionForm::kYesNo, QuestionMoment::kEnd);
  add_family(w, "there", QuestionForm::kYesNo);
  add_question(w, 0, QuestionTruth::kProved).right = 0;
  QuestionRecord& left = add_question(w, 1, QuestionTruth::kLeftOf);
  left.a = 0;
  left.b = 1;
  add_question(w, 2, QuestionTruth::kProved).right = 7;
  add_question(w, 3, QuestionTruth::kPixelsOf).a = 0;
  QuestionRecord& say = add_question(w, 4, QuestionTruth::kMentions);
  say.a = 0;
  say.b = 1;
  const std::uint32_t program = add_truth(w);
  add_question(w, 5, QuestionTruth::kRecorded).program = program;
  add_presence(w, 6);
  w.records.omissions.push_back({0, 1, static_cast<std::uint32_t>(OmissionReason::kPhraseIsName)});
  w.records.omissions.push_back({3, 1, static_cast<std::uint32_t>(OmissionReason::kCondition)});
  return w;
}

inline std::vector<std::byte> question_plan() {
  Writer w = question_writer();
  auto bytes = w.finish();
  return bytes.ok() ? *bytes : std::vector<std::byte>{};
}

}  // namespace probe::plan
