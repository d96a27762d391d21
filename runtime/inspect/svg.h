// A top view as one SVG file that needs nothing else. Same view, same text.
#pragma once

#include <string>

#include "runtime/inspect/top_view.h"

namespace probe::inspect {

std::string to_svg(const TopView& view);

}  // namespace probe::inspect
