// Between what an axis of a space is and the numbers that methods search.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/model/space.h"
#include "runtime/search/method/space.h"

namespace probe::search {

Axis method_axis(const sema::SpaceAxis& axis);
Space method_space(const sema::Space& space);

// Values of the space's axes for the numbers of a method, and back.
std::vector<double> values_of(const sema::Space& space, const Point& point);
Point point_of(const sema::Space& space, const std::vector<double>& values);

// One way along one axis, from the task's own value to an end of the space.
struct AxisSide {
  std::size_t axis = 0;
  bool up = true;
  int levels = 0;  // 0 is the own value, the last the end
  double value_at(const sema::SpaceAxis& axis, double level) const;
};
// Of every axis that has an order, the sides that are there; of counts a level each, of others
// `levels`.
std::vector<AxisSide> sides_of(const sema::Space& space, int levels);

// "light.ambient down"; an axis with one side alone has its name.
std::string side_text(const sema::Space& space, const AxisSide& side);

// How many points a level has whose direction is drawn: a step in one direction alone would be
// the tolerance of that.
int ways_of(sema::SpaceAxisKind kind);

}  // namespace probe::search
