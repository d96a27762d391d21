// Where the files lie that plans name.
#pragma once

#include <string>
#include <string_view>

#include "runtime/base/result.h"

namespace probe {

// The folder that the plan's asset paths are relative to: `chosen` if not empty, else the
// environment's VLAPROBE_ASSETS, else `assets` beside the folder of the program (or of our library,
// in somebody else's program), else that of the source tree it was built from. Fails (kAsset) naming every place it looked at.
Result<std::string> find_asset_root(std::string_view chosen = {});

}  // namespace probe
