// A run that stops by what it finds (`run --until`): its order out of what was chosen, what another run
// found of the same episodes, and the source of its jobs.
#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/adaptive/chooser.h"
#include "runtime/adaptive/rule.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/run/episode.h"
#include "runtime/run/run.h"
#include "runtime/run/workers.h"
#include "runtime/store/store.h"

namespace probe::run {

// Refuses (kUsage) what the rule cannot be vouched for with: successes alone, a recorded run, a shard
// where tasks share an order, a task without `success`.
Status check_adaptive(const adaptive::Rule& rule, const plan::Plan& plan, const RunOptions& options,
                      bool is_recorded, bool is_of_successes, std::span<const EpisodeJob> jobs);

// Sorts the jobs by the rule's order. For a decision `rule` gets the policy and the outcomes of the
// run in its folder, which has to be of the same plan, run whole, with a valid row for each of the jobs.
Result<std::vector<store::OrderedEpisode>> put_in_order(adaptive::Rule& rule, const plan::Plan& plan,
                                                        const std::string& out,
                                                        std::vector<EpisodeJob>& jobs);
// The same of a folder's rule, whose other run may be gone: `other` is what the folder has.
std::vector<store::OrderedEpisode> put_in_order_again(
    const adaptive::Rule& rule, const plan::Plan& plan,
    std::span<const store::OrderedEpisode> stored, std::vector<EpisodeJob>& jobs);

// Job `i` is place `i` of the order.
class AdaptiveJobs final : public JobSource {
 public:
  AdaptiveJobs(const adaptive::Rule& rule, const plan::Plan& plan, std::span<const EpisodeJob> jobs,
               std::span<const store::OrderedEpisode> order,
               std::span<const store::StoredEpisode> stored);

  bool is_done();
  std::optional<std::size_t> next() override;
  void stop() override;
  // How an episode ended that was handed out, now or before.
  void tell(const store::EpisodeKey& key, adaptive::Outcome outcome);

 private:
  std::mutex mutex_;
  std::condition_variable told_;
  bool is_stopped_ = false;
  std::map<store::EpisodeKey, std::size_t> places_;
  adaptive::Chooser chooser_;
};

}  // namespace probe::run
