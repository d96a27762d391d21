// `vlaprobe run`: every chosen episode of a plan, once, in parallel worlds, into a folder that a
// later call with the same arguments continues. Traces and rows do not depend on the number of
// jobs, on order or on interruptions. What cannot work is refused before the folder is made; a
// shard without an episode makes none.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/run/results.h"

namespace probe::plan {
class Plan;
}

namespace probe::run {

enum class VideoChoice { kNone, kFailures, kAll };

struct RunProgress {
  int done = 0;                    // episodes finished by this call
  int skipped = 0;                 // found valid in the folder
  int total = 0;                   // chosen episodes
  const ResultRow* row = nullptr;  // the one just committed; null for the first report
};

struct RunOptions {
  std::string policy;       // "expert", "noisy:0.01", ...
  std::string out;          // folder, made if absent
  std::string suite;        // empty: the plan's first suite, or all tasks if it has none
  std::string tasks = "*";  // glob over task names, with or without the suite's prefix: * and ?
  std::optional<std::pair<int, int>> episodes;  // first and last index, both included
  // Empty: the suite's seeds; and if the policy draws nothing (every seed would repeat the same
  // episode), only the first of them. Seeds given here are always run.
  std::vector<int> seeds;
  int jobs = 1;               // worlds in parallel, one thread each
  int shard = 1, shards = 1;  // this call's share: every shards-th episode from the shard-th
  VideoChoice video = VideoChoice::kNone;  // DIR/videos/TASK/EPISODE-SEED.mp4
  std::string assets;                      // asset root, see find_asset_root
  // Called from worker threads, one call at a time.
  std::function<void(const RunProgress&)> progress;
};

struct RunSummary {
  int total = 0, done = 0, skipped = 0, invalid = 0;
  std::vector<std::string> notes;  // sentences for stderr, such as why seeds were dropped
};

Result<RunSummary> run(const plan::Plan& plan, const RunOptions& options);

}  // namespace probe::run
