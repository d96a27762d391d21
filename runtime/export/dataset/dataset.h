// Runs as datasets that policies are trained on: every valid episode, its pictures rendered again
// from its trace and held against the hashes of what the policy saw, in the layout of a known
// format. README.md says what is in each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"

namespace probe::dataset {

struct DatasetOptions {
  std::string tasks = "*";           // glob over task names
  std::vector<std::string> cameras;  // empty: all of a task's
  int width = 0, height = 0;         // of every picture; 0: as the policy saw it
  bool only_success = false;
  // A table of wordings (compiler/rephrase); empty: the episodes' own instructions. Each
  // demonstration is told in so many wordings of the split `train`.
  std::string rephrase;
  int wordings = 1;
  // Frames a second, less than one beside the control rate; 0: that, which then has to be a whole
  // number.
  int fps = 0;
  int jobs = 1;        // threads; the bytes do not depend on it
  AssetRoot assets;  // empty: found by itself
  // Sizes at which a new file is begun, bytes.
  std::uint64_t most_data = 100'000'000, most_video = 200'000'000;
  // Called from worker threads, one call at a time: demonstrations done, and all there are.
  std::function<void(std::size_t done, std::size_t total)> progress;
};

struct DatasetReport {
  std::int64_t demonstrations = 0, episodes = 0, frames = 0;
  std::int64_t kept = 0;              // of the demonstrations: drawn by an export that was killed
  std::vector<std::string> left_out;  // a sentence each: what is not in it, and why
  std::vector<std::string> refused;   // of these, what the traces do not bear
};

enum class Format { kLerobot, kRobomimic, kRlds };

// Writes the folder `out`, whole or not at all: it is made in OUT.partial; a later call that
// makes the same goes on with the demonstrations that a killed one had finished. Fails with kUsage
// where runs do not go into one dataset or `out` is there, with kTrace naming episode and step when
// a picture is not the one that the policy saw, and with kIo or kVideo naming the file that cannot
// be written.
Result<DatasetReport> export_dataset(const std::vector<std::string>& runs, const std::string& out,
                                     Format format, const DatasetOptions& options = {});

}  // namespace probe::dataset
