#include "runtime/search/shown_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/model/space.h"

namespace probe::search {
namespace {

using sema::SpaceAxisKind;
using sema::Spacing;

// By the label that is the axis' whole name: axes of which a task has several (cameras, phrases)
// are even or choices.
Spacing spacing_of(std::string_view axis) {
  constexpr SpaceAxisKind kKinds[] = {
#define PROBE_SPACE_AXIS(Name, label, unit, per_si, how, moves) SpaceAxisKind::k##Name,
#include "compiler/model/space_axes.def"
  };
  for (const SpaceAxisKind kind : kKinds) {
    if (sema::info_of(kind).label == axis) return sema::info_of(kind).spacing;
  }
  return Spacing::kEven;
}

}  // namespace

std::string shown_text(std::string_view axis, std::string_view unit, double value) {
  const bool is_whole = spacing_of(axis) == Spacing::kWhole;
  const bool is_factor = axis == sema::info_of(SpaceAxisKind::kPower).label;
  const bool is_word = unit.size() > 3;  // "steps"
  std::string text = is_factor ? "x " : "";
  text += is_whole ? fmt::format("{:.0f}", std::round(value)) : fmt::format("{:.3g}", value + 0.0);
  if (is_word) text += ' ';
  text += unit;
  return text;
}

double share_of_side(std::string_view axis, double own, double end, double value) {
  if (own == end) return 0;
  const bool has_ratio = own > 0 && end > 0 && value > 0;
  const double share = spacing_of(axis) == Spacing::kRatio && has_ratio
                           ? std::log(value / own) / std::log(end / own)
                           : (value - own) / (end - own);
  return std::clamp(share, 0.0, 1.0);
}

}  // namespace probe::search
