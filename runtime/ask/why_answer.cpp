#include "runtime/ask/why_answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "runtime/ask/answers.h"
#include "runtime/ask/queries.h"
#include "runtime/ask/wording.h"
#include "runtime/plan/family_name.h"
#include "runtime/plan/ids.h"
#include "runtime/plan/questions.h"
#include "runtime/plan/source_line.h"

namespace probe::ask {
namespace {

std::optional<Written> written(const plan::Plan& plan, plan::SpanKind what, std::uint32_t index) {
  const plan::SpanRecord* span = plan.span_of(what, index);
  if (span == nullptr) return std::nullopt;
  const plan::TextRecord& text = plan.texts()[span->text];
  const plan::SourceLine line = plan::line_at(plan.tables().source(text), span->begin);
  return Written{std::string(plan.tables().path(text)), static_cast<int>(line.number),
                 std::string(line.text)};
}

// The declaration of the object that a proved choice, or a truth about one object, names.
std::optional<Written> right_object(const plan::Plan& plan, const plan::TaskRecord& task,
                                    const plan::QuestionRecord& question) {
  const bool is_choice =
      plan::form_of(plan.families()[question.family]) == plan::QuestionForm::kChoice;
  const std::uint32_t option = is_choice ? question.right : question.a;
  if (option == plan::kNone) return std::nullopt;
  const std::uint32_t body = options_of(plan, question)[option].body;
  if (body == plan::kNone) return std::nullopt;
  return written(plan, plan::SpanKind::kObjects, plan.bodies(task)[body].index);
}

bool is_asked(const plan::Plan& plan, std::uint32_t family, const std::string& name) {
  const plan::FamilyRecord& record = plan.families()[family];
  return name.empty() || plan::is_called(plan, record, name);
}

}  // namespace

Result<StartWhy> why_answers(const std::string& dir, const std::string& task, int episode,
                             std::optional<int> seed, const std::string& family) {
  PROBE_ASSIGN(const AskRecord record, read_ask_record(dir));
  PROBE_ASSIGN(const plan::Plan plan, open_asked_plan(dir));
  const auto found = plan.find_task(task);
  if (!found) return Failure{Fault::kUsage, fmt::format("the plan has no task `{}`", task), dir};
  const plan::TaskRecord& of_plan = plan.tasks()[*found];
  if (episode < 0 || static_cast<std::uint32_t>(episode) >= of_plan.episodes.count) {
    return Failure{
        Fault::kUsage,
        fmt::format("`{}` has starts 0 to {}, not {}", task, of_plan.episodes.count - 1, episode),
        dir};
  }
  const plan::EpisodeRecord& start = plan.episodes(of_plan)[static_cast<std::size_t>(episode)];
  const std::string start_id = to_hex(plan::to_sha256(start.start_id));
  StartWhy why{std::string(plan.text(of_plan.name)),
               episode,
               record.identity.model,
               std::string(plan.text(of_plan.prompt)),
               {}};
  std::vector<std::string> ids;
  for (std::uint32_t q = 0; q < plan.questions().size(); ++q) {
    const plan::QuestionRecord& question = plan.questions()[q];
    if (question.task != *found || !is_asked(plan, question.family, family)) continue;
    const plan::FamilyRecord& of = plan.families()[question.family];
    ids.push_back(to_hex(plan::to_sha256(question.question_id)));
    why.questions.push_back({plan::family_name(plan, of),
                             std::string(plan.text(question.text)),
                             std::string(plan::find_truth(question.truth)->says),
                             written(plan, plan::SpanKind::kFamilies, question.family),
                             right_object(plan, of_plan, question),
                             {},
                             {}});
  }
  if (ids.empty()) {
    return Failure{Fault::kUsage,
                   family.empty() ? fmt::format("nothing is asked of `{}`", task)
                                  : fmt::format("`{}` is not asked of `{}`", family, task),
                   dir};
  }
  // Tasks that ask the same of the same start share an answer, and so do sets.
  const auto is_meant = [&](int seed_of_row) {
    return !seed || seed_of_row == *seed || seed_of_row == -1;
  };
  PROBE_TRY(for_each_answer(dir, [&](const AnswerRow& row, std::uint32_t) -> Status {
    if (row.start_id != start_id || row.episode != episode || !is_meant(row.seed)) return {};
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] == row.question_id) why.questions[i].answers.push_back(row);
    }
    return {};
  }));
  PROBE_TRY(for_each_left_out(dir, [&](const LeftOut& left_out, std::uint32_t) -> Status {
    if (left_out.start_id != start_id || left_out.episode != episode || !is_meant(left_out.seed))
      return {};
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] == left_out.question_id) why.questions[i].left_out.push_back(left_out.why);
    }
    return {};
  }));
  for (AnswerWhy& question : why.questions) {
    std::ranges::stable_sort(question.answers, {}, [](const AnswerRow& row) {
      return std::tuple(row.seed, row.arm, row.rotation);
    });
  }
  return why;
}

}  // namespace probe::ask
