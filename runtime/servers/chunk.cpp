// Two ways to use chunks. The mean over answers is SimplerEnv's ActionEnsembler
// (simpler_env/utils/action/action_ensemble.py) with exp(-temperature) as a ratio, so that no
// exponential of the C library's gets into the actions.
#include "runtime/servers/chunk.h"

#include <algorithm>

namespace probe::servers {

ChunkQueue::ChunkQueue(const Profile& profile)
    : length_(profile.chunk_length),
      use_(profile.chunk_use),
      blends_(profile.ensemble == Ensemble::kTemporal),
      ratio_(profile.ensemble_ratio) {}

void ChunkQueue::clear() {
  actions_.clear();
  answers_.clear();
  next_ = end_ = 0;
  has_answer_ = false;
}

bool ChunkQueue::wants_answer() const { return blends_ ? !has_answer_ : next_ >= end_; }

Status ChunkQueue::check(const std::vector<RawAction>& actions) const {
  if (length_ > 0 && actions.size() != static_cast<std::size_t>(length_)) {
    return Failure{Fault::kPolicy,
                   "expected a chunk of " + std::to_string(length_) + " actions, got " +
                       std::to_string(actions.size()) + " (profile field `chunk.length`)",
                   ""};
  }
  if (actions.size() < static_cast<std::size_t>(std::max(use_, 1))) {
    return Failure{Fault::kPolicy,
                   "expected at least " + std::to_string(std::max(use_, 1)) + " actions, got " +
                       std::to_string(actions.size()) + " (profile field `chunk.use`)",
                   ""};
  }
  return {};
}

Status ChunkQueue::put(std::vector<RawAction> actions) {
  PROBE_TRY(check(actions));
  has_answer_ = true;
  if (blends_) {
    answers_.emplace_back(actions.begin(), actions.end());
    return {};
  }
  actions_ = std::move(actions);
  next_ = 0;
  end_ = use_ > 0 ? static_cast<std::size_t>(use_) : actions_.size();
  return {};
}

RawAction ChunkQueue::take() {
  if (!blends_) return actions_[next_++];
  const RawAction action = blended();
  for (auto& answer : answers_) answer.pop_front();
  std::erase_if(answers_, [](const auto& answer) { return answer.empty(); });
  has_answer_ = false;
  return action;
}

RawAction ChunkQueue::blended() const {
  RawAction sum(answers_.front().front().size(), 0.0);
  double weight = 1, total = 0;
  for (const auto& answer : answers_) {  // oldest first
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * answer.front()[i];
    total += weight;
    weight *= ratio_;
  }
  for (double& number : sum) number /= total;
  return sum;
}

}  // namespace probe::servers
