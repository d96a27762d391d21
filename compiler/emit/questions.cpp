// What a model is asked as records: families, questions with their options, and what is left out.
#include <algorithm>

#include "compiler/emit/emitter.h"

namespace probe::emit {

bool Emitter::is_asked(sema::QuestionSetId set, TaskId task) const {
  if (tasks_[task] == plan::kNone) return false;
  if (options_.suite.empty()) return true;
  for (const sema::Suite& suite : model_.suites) {
    if (suite.name != options_.suite) continue;
    const auto has = [](const auto& list, auto id) {
      return std::find(list.begin(), list.end(), id) != list.end();
    };
    if (has(suite.questions, set) && has(suite.members, task)) return true;
  }
  return false;
}

// Every family of a set of which anything is asked, or left out.
std::map<sema::QuestionSetId, std::uint32_t> Emitter::add_families() {
  std::vector<bool> wanted(model_.question_sets.size(), false);
  for (const sema::AskedQuestion& asked : model_.asked) {
    if (is_asked(asked.set, asked.task)) wanted[static_cast<std::size_t>(asked.set)] = true;
  }
  for (const sema::LeftOut& left : model_.left_out) {
    if (is_asked(left.set, left.task)) wanted[static_cast<std::size_t>(left.set)] = true;
  }
  std::map<sema::QuestionSetId, std::uint32_t> first;  // of each set's families
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (!wanted[i]) continue;
    const sema::QuestionSetId id = model_.question_sets.id(i);
    const sema::QuestionSet& set = model_.question_sets[id];
    first.emplace(id, size32(records().families));
    for (const sema::Family& family : set.families) {
      plan::FamilyRecord record;
      record.set = writer_.text(set.name);
      record.name = writer_.text(family.name);
      record.text = writer_.text(family.text);
      record.form = static_cast<std::uint32_t>(family.form);
      record.moment = static_cast<std::uint32_t>(family.moment);
      record.pixels = family.pixels;
      add_span(plan::SpanKind::kFamilies, size32(records().families), family.span);
      records().families.push_back(record);
    }
  }
  return first;
}

plan::Slice Emitter::add_options(const std::vector<sema::AskedOption>& options) {
  std::vector<plan::OptionRecord> rows;
  for (const sema::AskedOption& option : options) {
    plan::OptionRecord row;
    row.text = writer_.text(model_.objects[option.object].text.text);
    row.body = option.body.value_or(plan::kNone);
    row.flags = option.must_be_seen ? plan::kMustBeSeen : 0;
    std::vector<plan::StringRef> words;
    for (const std::string& word : option.words) words.push_back(writer_.text(word));
    row.words = plan::append(records().words, std::span<const plan::StringRef>(words));
    rows.push_back(row);
  }
  return plan::append(records().options, std::span<const plan::OptionRecord>(rows));
}

void Emitter::add_questions() {
  if (diagnostics_.has_errors() || (model_.asked.empty() && model_.left_out.empty())) return;
  const std::map<sema::QuestionSetId, std::uint32_t> families = add_families();
  for (const sema::AskedQuestion& asked : model_.asked) {
    if (!is_asked(asked.set, asked.task)) continue;
    plan::QuestionRecord record;
    record.family = families.at(asked.set) + asked.family;
    record.task = tasks_[asked.task];
    record.text = writer_.text(asked.text);
    record.options = add_options(asked.options);
    record.truth = static_cast<std::uint32_t>(asked.truth);
    record.right = asked.right;
    record.a = asked.a;
    record.b = asked.b;
    if (asked.judged) {
      const sema::Task& task = model_.tasks[asked.task];
      const auto program = add_program(task, {&*asked.judged, 1}, lower::bodies_of(model_, task),
                                       task.horizon);
      if (!program) continue;  // reported
      record.program = *program;
    }
    records().questions.push_back(record);
  }
  for (const sema::LeftOut& left : model_.left_out) {
    if (!is_asked(left.set, left.task)) continue;
    records().omissions.push_back({families.at(left.set) + left.family, tasks_[left.task],
                                   static_cast<std::uint32_t>(left.reason)});
  }
}

}  // namespace probe::emit
