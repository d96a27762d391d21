// MJCF files of the user's as an asset folder with a text for each.
#pragma once

#include <string>
#include <vector>

#include "runtime/assets/mujoco.h"
#include "runtime/base/result.h"

namespace probe::assets {

struct MujocoFolderOptions {
  std::vector<std::string> files;
  std::string to;    // folder to make
  std::string name;  // of one file's thing; empty: from the file's stem
  std::string merged_into;
  MujocoKind kind = MujocoKind::kEither;
};

struct MujocoLine {
  std::string word;  // "object", "fixture", "backdrop": what was made; "note"
  std::string text;
};

struct MujocoFolder {
  std::vector<MujocoLine> lines;
  std::size_t files = 0;
  std::uint64_t bytes = 0;
};

// Converts each file (convert_mujoco) and writes FOLDER/objects/NAME, FOLDER/fixtures/NAME or
// FOLDER/scenes/NAME, FOLDER/NAME.probe and manifest.json. Names that stems share get a number.
// Fails (kUsage) on a name for several files or one that no text can say, and as convert_mujoco and
// OutputFolder do; then nothing is left.
Result<MujocoFolder> make_mujoco_folder(const MujocoFolderOptions& options);

}  // namespace probe::assets
