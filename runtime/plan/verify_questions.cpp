// Stage 2, what a model is asked: families, questions, options, words, omissions; each by itself,
// then what they say of one another.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/plan/limits.h"
#include "runtime/plan/questions.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/verify.h"
#include "runtime/plan/verify_records.h"

namespace probe::plan {

Status RecordCheck::check(const FamilyRecord& f) const {
  PROBE_TRY(check_word(f.set, "the name of a set of questions"));
  PROBE_TRY(check_word(f.name, "the name of a question"));
  PROBE_TRY(check_name(f.text, "a question"));
  if (find_form(f.form) == nullptr)
    return fail(Rule::kQuestionKind, &f.form, fmt::format("form {} is not known", f.form));
  if (find_moment(f.moment) == nullptr)
    return fail(Rule::kQuestionKind, &f.moment, fmt::format("moment {} is not known", f.moment));
  PROBE_TRY(check_zero(f.zero));
  return check_zero(f.zero2);
}

Status RecordCheck::check(const QuestionRecord& q) const {
  PROBE_TRY(check_index(q.family, t.families.size(), "QFAM"));
  PROBE_TRY(check_index(q.task, t.tasks.size(), "TASK"));
  PROBE_TRY(check_name(q.text, "a question"));
  PROBE_TRY(check_slice(q.options, t.options.size(), "QOPT"));
  if (find_truth(q.truth) == nullptr)
    return fail(Rule::kQuestionKind, &q.truth, fmt::format("truth {} is not known", q.truth));
  if (q.a != kNone) PROBE_TRY(check_index(q.a, q.options.count, "its options"));
  if (q.b != kNone) PROBE_TRY(check_index(q.b, q.options.count, "its options"));
  if (q.program != kNone) PROBE_TRY(check_index(q.program, t.programs.size(), "PROG"));
  PROBE_TRY(check_zero(q.zero));
  return check_zero(q.zero2);
}

Status RecordCheck::check(const OptionRecord& o) const {
  PROBE_TRY(check_name(o.text, "an option"));
  if ((o.flags & ~kMustBeSeen) != 0)
    return fail(Rule::kOptionBody, &o.flags, fmt::format("flags {:#x} are not known", o.flags));
  if (o.body == kNone && o.flags != 0)
    return fail(Rule::kOptionBody, &o.flags, "what is not in the scene need not be seen");
  PROBE_TRY(check_slice(o.words, t.words.size(), "QWRD"));
  return check_zero({&o.zero, 1});
}

Status RecordCheck::check(const StringRef& word) const {
  return check_name(word, "a word for an option");
}

Status RecordCheck::check(const OmissionRecord& o) const {
  PROBE_TRY(check_index(o.family, t.families.size(), "QFAM"));
  PROBE_TRY(check_index(o.task, t.tasks.size(), "TASK"));
  if (find_omission(o.reason) == nullptr)
    return fail(Rule::kQuestionKind, &o.reason, fmt::format("reason {} is not known", o.reason));
  return check_zero(o.zero);
}

namespace {

// By a program: of a recorded episode, or where things have come to rest.
bool is_judged(QuestionTruth truth) {
  return truth == QuestionTruth::kRecorded || truth == QuestionTruth::kSettled;
}

// What a form can have as its truth.
bool can_be(QuestionForm form, QuestionTruth truth) {
  switch (form) {
    case QuestionForm::kChoice:
    case QuestionForm::kNumber:
      return truth == QuestionTruth::kProved;
    case QuestionForm::kYesNo:
      return truth == QuestionTruth::kProved || truth == QuestionTruth::kLeftOf ||
             truth == QuestionTruth::kNearerThan || is_judged(truth);
    case QuestionForm::kPoint:
      return truth == QuestionTruth::kPixelsOf;
    case QuestionForm::kFree:
      return truth == QuestionTruth::kMentions;
  }
  return false;
}

class QuestionCheck : FieldCheck {
 public:
  using FieldCheck::FieldCheck;

  Status run() const {
    PROBE_TRY(family_names());
    PROBE_TRY(order(t.questions, "questions", false));
    PROBE_TRY(order(t.omissions, "omissions", true));
    PROBE_TRY(ownership());
    for (const QuestionRecord& q : t.questions) {
      PROBE_TRY(options(q));
      PROBE_TRY(truth(q));
    }
    return {};
  }

 private:
  Status family_names() const {
    std::vector<std::pair<std::string_view, std::string_view>> names;
    for (const FamilyRecord& f : t.families) names.emplace_back(t.text(f.set), t.text(f.name));
    std::ranges::sort(names);
    const auto twice = std::ranges::adjacent_find(names);
    if (twice == names.end()) return {};
    return fail(Rule::kFamilyName, t.families.data(),
                fmt::format("two questions of `{}` are called `{}`", twice->first, twice->second));
  }

  template <typename Record>
  Status order(std::span<const Record> records, const char* what, bool once) const {
    for (std::size_t i = 1; i < records.size(); ++i) {
      const auto before = std::pair(records[i - 1].task, records[i - 1].family);
      const auto here = std::pair(records[i].task, records[i].family);
      if (before < here || (before == here && !once)) continue;
      return fail(Rule::kQuestionOrder, &records[i],
                  fmt::format("{} ascend by task and family", what));
    }
    return {};
  }

  Status ownership() const {
    std::uint64_t options = 0, words = 0;
    for (const QuestionRecord& q : t.questions) {
      if (q.options.count > 0 && q.options.first != options)
        return fail(Rule::kOptionsFollow, &q.options,
                    fmt::format("its options must begin at record {} of QOPT", options));
      options += q.options.count;
    }
    if (options != t.options.size())
      return fail(Rule::kOptionsFollow, &t.options[options], "an option belongs to a question");
    for (const OptionRecord& o : t.options) {
      if (o.words.count > 0 && o.words.first != words)
        return fail(Rule::kWordsFollow, &o.words,
                    fmt::format("its words must begin at record {} of QWRD", words));
      words += o.words.count;
    }
    if (words != t.words.size())
      return fail(Rule::kWordsFollow, &t.words[words], "a word belongs to an option");
    return {};
  }

  Status options(const QuestionRecord& q) const {
    const bool is_choice = form_of(t.families[q.family]) == QuestionForm::kChoice;
    if (q.options.count > (is_choice ? kMaxOptions : kMaxBodies) ||
        (is_choice && q.options.count < 2)) {
      return fail(Rule::kOptionCount, &q.options,
                  fmt::format("a question has {} options", q.options.count));
    }
    const TaskRecord& task = t.tasks[q.task];
    const std::uint32_t objects = roles_of(t, task).objects;
    std::vector<std::string_view> texts;
    for (const OptionRecord& o : slice_of(t.options, q.options)) {
      if (o.body != kNone && o.body >= objects)
        return fail(Rule::kOptionBody, &o.body,
                    fmt::format("body {} of task `{}` is no object", o.body, t.text(task.name)));
      PROBE_TRY(called(task, o));
      texts.push_back(t.text(o.text));
      for (const StringRef& word : slice_of(t.words, o.words)) texts.push_back(t.text(word));
    }
    // Things of one name can be counted.
    if (form_of(t.families[q.family]) == QuestionForm::kNumber) return {};
    std::ranges::sort(texts);
    const auto twice = std::ranges::adjacent_find(texts);
    if (twice == texts.end()) return {};
    return fail(Rule::kOptionTwice, &q.options,
                fmt::format("`{}` stands for two options of a question", *twice));
  }

  // A question that was tied to another task would call its objects by other names, or ask for what
  // is there as if it were not.
  Status called(const TaskRecord& task, const OptionRecord& o) const {
    const std::string_view name = t.text(o.text);
    const auto bodies = slice_of(t.bodies, task.bodies).first(roles_of(t, task).objects);
    const auto name_of = [&](const BodyRecord& body) { return t.text(t.objects[body.index].text); };
    if (o.body != kNone) {
      if (name_of(bodies[o.body]) == name) return {};
      return fail(Rule::kOptionName, &o.text,
                  fmt::format("`{}` is called \"{}\" in task `{}`", name, name_of(bodies[o.body]),
                              t.text(task.name)));
    }
    if (std::ranges::find(bodies, name, name_of) == bodies.end()) return {};
    return fail(Rule::kOptionName, &o.text,
                fmt::format("`{}` is an object of task `{}`", name, t.text(task.name)));
  }

  // Is there a carrot?
  Status presence(const QuestionRecord& q) const {
    const bool asks = form_of(t.families[q.family]) == QuestionForm::kYesNo &&
                      truth_of(q) == QuestionTruth::kProved;
    if (!asks) return {};
    if (q.options.count != 1)
      return fail(Rule::kQuestionPresence, &q.options,
                  fmt::format("it asks for {} objects", q.options.count));
    const bool is_there = t.options[q.options.first].body != kNone;
    if (q.right == (is_there ? 1 : 0)) return {};
    return fail(
        Rule::kQuestionPresence, &q.right,
        fmt::format("{} is no answer about what is {}there", q.right, is_there ? "" : "not "));
  }

  Status truth(const QuestionRecord& q) const {
    const FamilyRecord& family = t.families[q.family];
    const QuestionForm form = form_of(family);
    const QuestionTruth truth = truth_of(q);
    const bool at_end = moment_of(family) == QuestionMoment::kEnd;
    const bool is_then = at_end == (truth == QuestionTruth::kRecorded);
    if (!can_be(form, truth) || (is_judged(truth) && !is_then))
      return fail(Rule::kQuestionForm, &q.truth,
                  fmt::format("a question of form `{}` cannot have truth {}",
                              find_form(family.form)->word, q.truth));
    if (!is_right(form, q))
      return fail(Rule::kQuestionRight, &q.right, fmt::format("{} is no right answer", q.right));
    PROBE_TRY(presence(q));
    PROBE_TRY(about(q));
    const bool has_program = q.program != kNone;
    if (has_program != is_judged(truth) || (has_program && !is_truth(q.program)))
      return fail(Rule::kQuestionProgram, &q.program,
                  "what is judged has a program with one truth");
    return {};
  }

  static bool is_right(QuestionForm form, const QuestionRecord& q) {
    if (truth_of(q) != QuestionTruth::kProved) return q.right == kNone;
    if (form == QuestionForm::kChoice) return q.right < q.options.count;
    if (form == QuestionForm::kYesNo) return q.right <= 1;
    return q.right != kNone;
  }

  // A proved truth may be about an option, or about none: "is there a carrot?".
  Status about(const QuestionRecord& q) const {
    const int takes = find_truth(q.truth)->takes;
    const auto options = slice_of(t.options, q.options);
    const bool has_a = q.a != kNone && options[q.a].body != kNone;
    const bool has_b = q.b != kNone && options[q.b].body != kNone;
    const bool fits = takes == 0   ? q.b == kNone
                      : takes == 1 ? has_a && q.b == kNone
                                   : has_a && has_b && q.a != q.b;
    if (fits) return {};
    return fail(Rule::kQuestionAbout, &q.a,
                fmt::format("truth {} is about {} objects", q.truth, takes));
  }

  bool is_truth(std::uint32_t program) const {
    const auto metrics = slice_of(t.metrics, t.programs[program].metrics);
    return metrics.size() == 1 &&
           metrics[0].type == static_cast<std::uint32_t>(MetricType::kBool) &&
           metrics[0].readout == static_cast<std::uint32_t>(Readout::kAtEnd);
  }
};

}  // namespace

Status verify_questions(std::span<const std::byte> bytes, const Tables& tables) {
  return QuestionCheck(bytes, tables).run();
}

}  // namespace probe::plan
