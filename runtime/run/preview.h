// `vlaprobe preview`: what a task looks like at each of its starts, after settling and before the
// first action.
#pragma once

#include <cstdint>
#include <string>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/run/replay.h"

namespace probe::run {

// A PNG grid with one picture a start, the start's number under each and the instruction below all.
// `task` is an index of plan.tasks().
Status write_preview(const plan::Plan& plan, std::uint32_t task, const std::string& png_path,
                     const SheetOptions& options = {});

}  // namespace probe::run
