// `vlaprobe sweep`: several checkpoints of one policy on a suite's original tasks, the best of them
// on the whole suite. Each has a folder of its own, an ordinary run that can be continued.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/run/run.h"

namespace probe::run {

struct SweepOptions {
  // Of each run: `policy` (and `name`, if given) have `{}` where a checkpoint's text goes; `out` is
  // the folder of all.
  RunOptions run;
  std::vector<std::string> checkpoints;
  // What is done next, and what came out: sentences.
  std::function<void(const std::string&)> tell;
};

// On the original tasks, those that are no variant of another.
struct CheckpointScore {
  std::string checkpoint;
  std::string dir;
  int tasks = 0, episodes = 0;
  double success = 0, intention = 0;  // mean over the tasks of the share of episodes
  // What its server answered to the questions at the run's beginning, see policy::Reading; empty of
  // a policy in this process.
  std::string answers_sha256 = "";
};

struct SweepSummary {
  std::vector<CheckpointScore> scores;  // in the order of the checkpoints
  std::size_t best = 0;                 // highest success, then intention, then the first named
  // Of checkpoints whose servers gave bit-equal answers: sentences.
  std::vector<std::string> alike;
  RunSummary whole;  // the best one's run of the whole suite
};

// Fails (kUsage) without a `{}`, with a checkpoint named twice, and where a run of one could not
// be.
Status check_sweep(const SweepOptions& options);

// Runs what is missing, also when it was killed before. Writes OUT/sweep.json with scores, rule and
// choice. Fails as check_sweep does before the first is run, and (kPolicy)
// when an episode of the original tasks is invalid: nothing is chosen by halves.
Result<SweepSummary> sweep(const plan::Plan& plan, const SweepOptions& options);

// The folder of a checkpoint below OUT: its text where that is a plain name, else the end of it
// with a hash.
std::string checkpoint_folder(const std::string& checkpoint);

}  // namespace probe::run
