// First and last pictures of stored episodes on one sheet, drawn again from their traces.
#pragma once

#include <string>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"

namespace probe::show {

struct SheetOptions {
  std::string tasks = "*";  // glob over task names
  int columns = 6;
  int cell_width = 213;  // pixels of one picture; a cell shows the first and the last
  std::string camera;    // of several, the one that is shown; empty: all, side by side
  AssetRoot assets;      // empty: found by itself
};

// A PNG grid of the first and last picture of every stored episode, with captions, drawn from the
// traces.
Status write_contact_sheet(const std::string& dir, const std::string& png_path,
                           const SheetOptions& options = {});

}  // namespace probe::show
