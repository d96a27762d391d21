#include "runtime/search/shown_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/model/space.h"
#include "compiler/space/points.h"

namespace probe::search {
namespace {

using sema::SpaceAxisKind;
using sema::Spacing;

// Of the axis whose whole name is a label; those of which a task has several (cameras, phrases) are
// even or choices.
sema::SpaceAxisInfo info_called(std::string_view axis, std::string_view unit) {
  constexpr SpaceAxisKind kKinds[] = {
#define PROBE_SPACE_AXIS(Name, label, unit, per_si, how, moves) SpaceAxisKind::k##Name,
#include "compiler/model/space_axes.def"
  };
  sema::SpaceAxisInfo info{.label = axis, .unit = unit};
  for (const SpaceAxisKind kind : kKinds) {
    if (sema::info_of(kind).label == axis) info.spacing = sema::info_of(kind).spacing;
  }
  return info;
}

}  // namespace

std::string k_of_n(const stats::Count& count) { return fmt::format("{} of {}", count.k, count.n); }

std::string shown_text(std::string_view axis, std::string_view unit, double value) {
  return space::amount_text(info_called(axis, unit), value);
}

double share_of_side(std::string_view axis, double own, double end, double value) {
  if (own == end) return 0;
  const bool has_ratio = own > 0 && end > 0 && value > 0;
  const double share = info_called(axis, "").spacing == Spacing::kRatio && has_ratio
                           ? std::log(value / own) / std::log(end / own)
                           : (value - own) / (end - own);
  return std::clamp(share, 0.0, 1.0);
}

}  // namespace probe::search
