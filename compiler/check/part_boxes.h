// Boxes of parts of fixtures, as both checks of their ways look at them and speak of them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compiler/geometry/travel.h"
#include "compiler/model/model.h"

namespace probe::sema {

// Whether the upright box around a part meets another, given by its middle and half extents (m).
inline bool may_overlap(const PartBox& box, const Vec3& centre, const Vec3& half) {
  const Vec3 apart = (box.solid.centre - centre).cwiseAbs();
  return (apart.array() < (box.half + half).array()).all();
}

// Boxes that stand one behind the other in a list, and the upright box around them: what does not
// meet it meets none of them.
struct BoxRun {
  std::size_t begin = 0, end = 0;
  Vec3 low, high;

  bool may_overlap(const Vec3& centre, const Vec3& half) const {
    return (low.array() < (centre + half).array()).all() &&
           ((centre - half).array() < high.array()).all();
  }
};
std::vector<BoxRun> runs_of(const std::vector<PartBox>& boxes);

// " when `cabinet.top` stands at 4cm": all joints that carry the part of a box of everywhere().
std::string when(const Fixture& fixture, const Travel& travel, const PartBox& box);

}  // namespace probe::sema
