#include "runtime/vm/told.h"

#include "runtime/plan/later.h"

namespace probe::vm {

Told::Told(const plan::Plan& plan, std::uint32_t task) {
  for (const std::string_view sentence : plan::sentences_of(plan.tables(), task))
    sentences_.emplace_back(sentence);
  for (const plan::LaterRecord& later : plan::later_of(plan.tables(), task))
    conditions_.emplace_back(plan, task, later.program);
}

Status Told::begin(std::span<const BodyStart> starts) {
  sentence_ = 0;
  for (Judge& condition : conditions_) PROBE_TRY(condition.begin(starts));
  return {};
}

Status Told::step(const StepSample& sample) {
  for (Judge& condition : conditions_) PROBE_TRY(condition.step(sample));
  if (sentence_ < conditions_.size() && conditions_[sentence_].truth(0)) ++sentence_;
  return {};
}

ToldState Told::save() const {
  ToldState state{sentence_, {}};
  for (const Judge& condition : conditions_) state.conditions.push_back(condition.save());
  return state;
}

Status Told::restore(std::span<const BodyStart> starts, const ToldState& state) {
  if (state.conditions.size() != conditions_.size() || state.sentence > conditions_.size())
    return Failure{Fault::kJudge, "the saved state has other sentences than this task", ""};
  for (std::size_t i = 0; i < conditions_.size(); ++i)
    PROBE_TRY(conditions_[i].restore(starts, state.conditions[i]));
  sentence_ = state.sentence;
  return {};
}

}  // namespace probe::vm
