// What a task looks like before anybody acts: the settled first picture of each of its starts.
#pragma once

#include <cstdint>
#include <string>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/show/contact_sheet.h"

namespace probe::show {

// A PNG grid, captioned with the start's index; the instruction stands in the first caption.
// SheetOptions::tasks is not read.
Status write_preview(const plan::Plan& plan, std::uint32_t task, const std::string& png_path,
                     const SheetOptions& options = {});

// One start's first picture in the camera's own size, as a policy gets it. `camera` as in
// ReplayOptions.
Status write_start(const plan::Plan& plan, std::uint32_t task, std::uint32_t index,
                   const std::string& png_path, const AssetRoot& asset_root = {},
                   const std::string& camera = {});

}  // namespace probe::show
