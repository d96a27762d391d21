// `vlaprobe replay`: a stored episode again, from its recorded actions, in a fresh world; and
// pictures of stored episodes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"

namespace probe::run {

struct ReplayOptions {
  bool verify = false;  // compare every measurement and hash, bit for bit
  std::string video;    // path of an mp4 to write; empty: none
  std::string png;      // path of a picture to write; empty: none
  int png_step = 0;     // the observation at this step: 0 is the first, the trace's length the last
  std::string camera;   // of several, the one that is shown; empty: all, side by side
  AssetRoot assets;     // empty: found by itself
};

struct ReplayReport {
  int steps = 0;  // repeated
  int seed = 0;
  bool identical = true;   // of no meaning without `verify`
  std::string difference;  // the first: "step 12: q of `waist` is 0.1, recorded 0.2"
  std::vector<std::string>
      fingerprint_differences;  // what is not as it was when the episode was recorded
};

// Without `seed`: the episode's only seed, or the lowest of several.
Result<ReplayReport> replay(const std::string& dir, const std::string& task, int episode,
                            std::optional<int> seed, const ReplayOptions& options);

}  // namespace probe::run
