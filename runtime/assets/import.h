// A user's SimplerEnv / ManiSkill2_real2sim data turned into an asset folder of the same form as
// this repository's `assets`: `--assets OUT` then runs the suite on it.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/result.h"

namespace probe::assets {

// Whose assets the result stands for: the models of a suite's tasks have its names and sizes.
enum class ImportFor { kBridge, kGoogle };

struct ImportOptions {
  std::string from, to;
  // Takes what the suite needs and the data does not have from here, an asset folder of ours.
  // Empty: nothing is filled in.
  std::string fill_from;
  ImportFor suite = ImportFor::kBridge;
  // An asset folder of ours: for kGoogle the suite's own robot, cabinet, rooms and textures are
  // copied from here, which the data has nothing for. Empty: they are missing.
  // The first of several that has a thing gives it.
  std::vector<std::string> own = {};
};

// kOwn: copied from ours, as no data has it in that form.
enum class Verdict { kTaken, kOdd, kMissing, kFilled, kOwn };

// One a thing of the data: a model, a scene, the robot.
struct ImportLine {
  Verdict verdict = Verdict::kTaken;
  std::string name;  // "objects/carrot"
  std::string text;  // what it was made from, what is odd or missing
};
const char* to_word(Verdict verdict);

struct ImportReport {
  std::vector<ImportLine> lines;  // the suite's things first
  std::size_t files = 0;
  std::uint64_t bytes = 0;
};

// OUT appears whole or not at all. What cannot be read is a line, not a failure. Fails
// (kAsset, kIo) when `from` holds no such data, nothing of it can be used, or `to` is there
// already.
Result<ImportReport> import_data(const ImportOptions& options);

}  // namespace probe::assets
