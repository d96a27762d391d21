#include "runtime/report/asked_model.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "runtime/ask/answers.h"
#include "runtime/ask/queries.h"
#include "runtime/ask/vouch.h"
#include "runtime/plan/family_name.h"
#include "runtime/plan/questions.h"
#include "runtime/plan/roles.h"

namespace probe::report {

std::string family_name(const plan::Plan& plan, std::uint32_t family) {
  return plan::family_name(plan, plan.families()[family]);
}

bool asks_for_source(const plan::Plan& plan, std::uint32_t family) {
  bool any = false;
  if (plan::moment_of(plan.families()[family]) != plan::QuestionMoment::kStart) return false;
  for (const plan::QuestionRecord& q : plan.questions()) {
    if (q.family != family) continue;
    const auto options = plan::slice_of(plan.tables().options, q.options);
    const bool is_choice = plan::form_of(plan.families()[family]) == plan::QuestionForm::kChoice;
    const std::uint32_t right = is_choice                                             ? q.right
                                : plan::truth_of(q) == plan::QuestionTruth::kMentions ? q.a
                                                                                      : plan::kNone;
    const std::uint32_t source = plan::roles_of(plan.tables(), plan.tasks()[q.task]).source;
    if (right == plan::kNone || source == plan::kNone || options[right].body != source)
      return false;
    any = true;
  }
  return any;
}

Result<AskedModel> read_asked_model(const std::string& dir, const plan::Plan& plan) {
  PROBE_ASSIGN(const ask::AskRecord record, ask::read_ask_record(dir));
  PROBE_ASSIGN(const std::vector<ask::AskCall> calls, ask::read_ask_calls(dir));
  AskedModel model;
  model.name = record.identity.model;
  model.dir = dir;
  std::set<std::string> findings;
  for (const ask::AskCall& call : calls) {
    model.is_unchecked = model.is_unchecked || call.proof.is_unchecked;
    for (const std::string& finding : ask::findings_of(call.proof)) {
      if (findings.insert(finding).second) model.findings.push_back(finding);
    }
  }
  ask::Tally tally(plan);
  ask::RowFindings rows;
  PROBE_TRY(ask::for_each_answer(dir, [&](const ask::AnswerRow& row, std::uint32_t) {
    ++model.answers;
    model.invalid += row.invalid ? 1 : 0;
    rows.add(row);
    return tally.add(row);
  }));
  model.doubts = rows.sentences();
  if (std::string missing = ask::missing_shards(calls); !missing.empty())
    model.doubts.push_back(std::move(missing));
  PROBE_TRY(ask::for_each_left_out(dir, [&](const ask::LeftOut&, std::uint32_t) -> Status {
    ++model.left_out;
    return {};
  }));
  const std::vector<ask::Asked> asked = tally.asked();
  model.scores = ask::score(plan, asked);
  for (ask::ScoreRow& row : ask::score(plan, asked, true)) {
    if (row.set != plan::kNone) model.scores.push_back(std::move(row));
  }
  for (std::uint32_t f = 0; f < plan.families().size(); ++f) {
    PROBE_ASSIGN(const auto known, ask::knows(plan, asked, family_name(plan, f)));
    for (const ask::Known& one : known) {
      if (!one.knows) continue;
      const auto index = static_cast<int>(plan.episodes()[one.episode].index);
      model.known.push_back({f, static_cast<int>(one.task), index, one.question, one.seed,
                             *one.knows, static_cast<std::int64_t>(one.asked)});
    }
  }
  return model;
}

}  // namespace probe::report
