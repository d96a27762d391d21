// Which episodes a call of `run` means: suite, tasks, episodes, seeds and shard as a list of jobs.
// Pure.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/run/episode.h"
#include "runtime/run/run.h"

namespace probe::run {

struct Selection {
  std::string suite;  // empty if the plan has none
  std::vector<int> seeds;
  std::vector<EpisodeJob> jobs;  // in the plan's order of tasks, then episode, then seed
  std::vector<std::string> notes;
};

// Which of 1 .. shards an episode belongs to: by a hash of its id and seed, whatever else is
// chosen, so that a changed selection moves no episode to another shard's folder.
int shard_of(const Sha256& episode_id, int seed, int shards);

// `draws`: whether the policy can do two different things with two seeds. `recorded`: rows of the
// run whose actions are repeated; then only episodes and seeds that it holds are chosen, with
// `options.seeds` only narrowing them. Fails (kUsage) on an unknown suite, a glob that no
// task matches, episodes that no chosen task has, and a shard outside 1/1 .. N/N.
Result<Selection> select_jobs(const plan::Plan& plan, const RunOptions& options, bool draws,
                              const std::vector<store::ResultRow>* recorded = nullptr);

}  // namespace probe::run
