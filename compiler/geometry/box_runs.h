// Boxes of parts of fixtures, looked through quickly: most of them are far from what is asked about.
#pragma once

#include <cstddef>
#include <vector>

#include "compiler/geometry/travel.h"

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

}  // namespace probe::sema
