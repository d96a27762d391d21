#include "runtime/ask/prepared.h"

#include <algorithm>

#include "runtime/ask/wording.h"
#include "runtime/plan/questions.h"
#include "runtime/rejudge/rescore.h"
#include "runtime/store/stored_trace.h"
#include "runtime/vm/judge.h"

namespace probe::ask {
namespace {

// The question's program over the recorded episode.
Result<bool> judge_recorded(const plan::Plan& plan, const plan::QuestionRecord& question,
                            const store::Trace& trace) {
  PROBE_TRY(rejudge::check_measures(plan, question.task, trace));
  vm::Judge judge(plan, question.task, question.program);
  PROBE_TRY(judge.begin(trace.start->starts));
  for (const store::TraceStep& step : trace.steps) PROBE_TRY(judge.step(step.sample));
  return judge.truth(0);
}

bool wants(const std::vector<Query>& queries, Arm arm) {
  return std::ranges::any_of(queries, [arm](const Query& query) { return query.arm == arm; });
}

Result<SentPicture> made_of(const View& view, const PictureRule& rule, bool sends) {
  SentPicture sent;
  std::tie(sent.width, sent.height) = sent_size(view, rule);
  if (!sends) return sent;
  PROBE_ASSIGN(sent, to_sent(view, rule));
  sent.data_uri = data_uri_of(sent.png);
  return sent;
}

Status fill(const plan::Plan& plan, const Look& look, const RecordedRows& recorded,
            const PictureRule& rule, bool sends, Viewer& viewer, PreparedLook& made) {
  View view;
  store::Trace trace;
  if (look.recorded) {
    PROBE_ASSIGN(trace, store::read_stored_trace(recorded[*look.recorded]));
    PROBE_ASSIGN(view, viewer.end(look.episode, trace));
  } else {
    PROBE_ASSIGN(view, viewer.start(look.episode));
  }
  for (const Query& query : made.queries) {
    if (made.truths.contains(query.question)) continue;
    const plan::QuestionRecord& question = plan.questions()[query.question];
    std::optional<bool> judged;
    if (plan::truth_of(question) == plan::QuestionTruth::kRecorded) {
      PROBE_ASSIGN(judged, judge_recorded(plan, question, trace));
    }
    if (plan::truth_of(question) == plan::QuestionTruth::kSettled) {
      PROBE_ASSIGN(judged, viewer.judge_start(question));
    }
    made.truths.emplace(query.question, find_truth(plan, question, view, rule, judged));
  }
  PROBE_ASSIGN(made.picture, made_of(view, rule, sends && wants(made.queries, Arm::kPicture)));
  if (!wants(made.queries, Arm::kPrior)) return {};
  made.prior_episode = prior_of(plan, look.episode);
  if (!made.prior_episode)
    return Failure{Fault::kUsage, "the plan has no other start to show in its place", ""};
  PROBE_ASSIGN(view, viewer.start(*made.prior_episode));
  PROBE_ASSIGN(made.prior, made_of(view, rule, sends));
  return {};
}

}  // namespace

std::string start_id_of(const plan::Plan& plan, std::uint32_t episode) {
  return to_hex(Sha256{plan.episodes()[episode].start_id});
}

AnswerKey key_of(const plan::Plan& plan, const Query& query) {
  return {to_hex(Sha256{plan.questions()[query.question].question_id}), query.rotation, query.arm,
          index_in_task(plan, query.episode), query.seed.value_or(-1)};
}

std::vector<Query> open_queries(const plan::Plan& plan, const Queries& queries, const Look& look,
                                const Answers::Stored& stored) {
  std::vector<Query> open = queries.of(look);
  std::erase_if(open, [&](const Query& query) { return stored.has(key_of(plan, query)); });
  return open;
}

PreparedLook prepare(const plan::Plan& plan, const Look& look, std::vector<Query> open,
                     const RecordedRows& recorded, const PictureRule& rule, bool sends,
                     Viewer& viewer) {
  PreparedLook made;
  made.queries = std::move(open);
  if (auto filled = fill(plan, look, recorded, rule, sends, viewer, made); !filled)
    made.failure = "picture: " + to_text(filled.failure());
  return made;
}

std::optional<bool> has_answer(const plan::Plan& plan, const plan::QuestionRecord& question,
                               std::uint32_t episode) {
  const bool is_choice =
      plan::form_of(plan.families()[question.family]) == plan::QuestionForm::kChoice;
  const std::uint32_t option = is_choice ? question.right : question.a;
  const auto options = options_of(plan, question);
  if (option == plan::kNone || options[option].body == plan::kNone) return std::nullopt;
  const std::uint32_t object = plan.bodies(plan.tasks()[question.task])[options[option].body].index;
  const auto there = plan.bodies(plan.tasks()[plan.episodes()[episode].task]);
  return std::ranges::any_of(there, [object](const plan::BodyRecord& body) {
    return body.kind == static_cast<std::uint32_t>(plan::BodyKind::kObject) && body.index == object;
  });
}

}  // namespace probe::ask
