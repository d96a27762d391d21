#include "runtime/search/method/parts.h"

#include <algorithm>
#include <cmath>

namespace probe::search {
namespace {

constexpr int kParts = 8;

}  // namespace

bool Side::holds(double x) const {
  switch (kind) {
    case SideKind::kBelow:
      return x < value;
    case SideKind::kAtLeast:
      return x >= value;
    case SideKind::kIs:
      return x == value;
    case SideKind::kIsNot:
      return x != value;
  }
  return false;
}

int part_count(const Axis& axis) {
  if (axis.kind == AxisKind::kContinuous) return kParts;
  return axis.kind == AxisKind::kChoice ? axis.size : std::min(axis.size, kParts);
}

Parts parts_of(const Axis& axis, std::span<const Point> points, std::size_t at) {
  Parts parts;
  const bool is_choice = axis.kind == AxisKind::kChoice;
  parts.count = part_count(axis);
  const double width = axis.kind == AxisKind::kContinuous
                           ? 1.0 / kParts
                           : static_cast<double>(axis.size) / parts.count;
  for (const Point& point : points) {
    const int part = std::clamp(static_cast<int>(point[at] / width + 1e-9), 0, parts.count - 1);
    parts.of.push_back(static_cast<std::uint8_t>(part));
  }
  // Of two options the second alone says all.
  parts.is_ordered = !is_choice || parts.count == 2;
  parts.first_cut = parts.is_ordered ? 1 : 0;
  for (int cut = parts.is_ordered ? 1 : 0; cut < parts.count; ++cut) {
    const double value = axis.kind == AxisKind::kContinuous ? cut * width
                         : is_choice                        ? cut
                                                            : std::ceil(cut * width - 1e-9);
    parts.sides.push_back({is_choice ? SideKind::kIs : SideKind::kAtLeast, value});
  }
  return parts;
}

Side other_side(Side side) {
  switch (side.kind) {
    case SideKind::kBelow:
      return {SideKind::kAtLeast, side.value};
    case SideKind::kAtLeast:
      return {SideKind::kBelow, side.value};
    case SideKind::kIs:
      return {SideKind::kIsNot, side.value};
    case SideKind::kIsNot:
      return {SideKind::kIs, side.value};
  }
  return side;
}

}  // namespace probe::search
