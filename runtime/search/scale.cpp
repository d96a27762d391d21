#include "runtime/search/scale.h"

#include <algorithm>
#include <cmath>

namespace probe::search {

using sema::Spacing;

namespace {

Spacing spacing_of(const sema::SpaceAxis& axis) { return sema::info_of(axis.kind).spacing; }

bool is_whole(const sema::SpaceAxis& axis) {
  return spacing_of(axis) == Spacing::kWhole || spacing_of(axis) == Spacing::kChoice;
}

double share_of(const sema::SpaceAxis& axis, double value) {
  if (is_whole(axis)) return std::round(value - axis.low);
  if (spacing_of(axis) == Spacing::kRatio)
    return std::log(value / axis.low) / std::log(axis.high / axis.low);
  return (value - axis.low) / (axis.high - axis.low);
}

double value_of(const sema::SpaceAxis& axis, double share) {
  if (is_whole(axis)) return axis.low + std::round(share);
  if (spacing_of(axis) == Spacing::kRatio) return axis.low * std::pow(axis.high / axis.low, share);
  return axis.low + share * (axis.high - axis.low);
}

}  // namespace

Axis method_axis(const sema::SpaceAxis& axis) {
  Axis out;
  if (is_whole(axis)) {
    out.kind = spacing_of(axis) == Spacing::kChoice ? AxisKind::kChoice : AxisKind::kCount;
    out.size = static_cast<int>(std::round(axis.high - axis.low)) + 1;
  }
  out.own = share_of(axis, axis.own);
  return out;
}

Space method_space(const sema::Space& space) {
  Space out;
  for (const sema::SpaceAxis& axis : space.axes) out.push_back(method_axis(axis));
  return out;
}

std::vector<double> values_of(const sema::Space& space, const Point& point) {
  std::vector<double> values;
  for (std::size_t i = 0; i < space.axes.size(); ++i) {
    const sema::SpaceAxis& axis = space.axes[i];
    // What is not changed is the task's to the bit.
    values.push_back(point[i] == method_axis(axis).own ? axis.own : value_of(axis, point[i]));
  }
  return values;
}

Point point_of(const sema::Space& space, const std::vector<double>& values) {
  Point point;
  for (std::size_t i = 0; i < space.axes.size(); ++i)
    point.push_back(share_of(space.axes[i], values[i]));
  return point;
}

double AxisSide::value_at(const sema::SpaceAxis& of, double level) const {
  if (level <= 0) return of.own;
  const double end = up ? of.high : of.low;
  const double share = level / (levels - 1);
  if (spacing_of(of) == Spacing::kRatio) return of.own * std::pow(end / of.own, share);
  return of.own + share * (end - of.own);
}

std::vector<AxisSide> sides_of(const sema::Space& space, int levels) {
  std::vector<AxisSide> sides;
  for (std::size_t i = 0; i < space.axes.size(); ++i) {
    const sema::SpaceAxis& axis = space.axes[i];
    if (spacing_of(axis) == Spacing::kChoice) continue;
    for (const bool up : {false, true}) {
      const double far = up ? axis.high - axis.own : axis.own - axis.low;
      if (far <= 0) continue;
      sides.push_back({i, up, is_whole(axis) ? static_cast<int>(std::round(far)) + 1 : levels});
    }
  }
  return sides;
}

std::string side_text(const sema::Space& space, const AxisSide& side) {
  const sema::SpaceAxis& axis = space.axes[side.axis];
  const bool has_both = axis.low < axis.own && axis.own < axis.high;
  return axis.name + (has_both ? side.up ? " up" : " down" : "");
}

int ways_of(sema::SpaceAxisKind kind) {
  constexpr int kWays = 4;
  return kind == sema::SpaceAxisKind::kDirection || kind == sema::SpaceAxisKind::kCameraTurn ? kWays
                                                                                             : 1;
}

}  // namespace probe::search
