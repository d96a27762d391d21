// Boxes of parts of fixtures, looked through quickly: most of them are far from what is asked
// about.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/scene/solid.h"

namespace probe::sema {

// One box of a part, in the world (m).
struct PartBox {
  std::uint32_t part = 0;    // of Fixture::parts
  std::uint32_t sample = 0;  // of Travel::joints_of(): where the joints stand
  scene::Solid solid;
  Vec3 half = Vec3::Zero();  // of the upright box around it
};

// Whether the upright box around a part meets another, given by its middle and half extents (m).
inline bool may_overlap(const PartBox& box, const Vec3& centre, const Vec3& half) {
  const Vec3 apart = (box.solid.centre - centre).cwiseAbs();
  return (apart.array() < (box.half + half).array()).all();
}

// Boxes in the order in which they are added.
class PartBoxes {
 public:
  PartBoxes() = default;
  explicit PartBoxes(const std::vector<PartBox>& boxes) {
    for (const PartBox& box : boxes) add(box);
  }
  void add(const PartBox& box);

  const std::vector<PartBox>& all() const { return boxes_; }
  // `look(box)` for all that may_overlap, in their order.
  template <typename Look>
  void each_near(const Vec3& centre, const Vec3& half, const Look& look) const {
    for (const Run& run : runs_) {
      if (!run.may_overlap(centre, half)) continue;
      for (std::size_t i = run.begin; i < run.end; ++i) {
        if (sema::may_overlap(boxes_[i], centre, half)) look(boxes_[i]);
      }
    }
  }

 private:
  // Boxes of one part that follow each other, and the upright box around them: what does not meet
  // it meets none of them.
  struct Run {
    std::size_t begin = 0, end = 0;
    Vec3 low, high;

    bool may_overlap(const Vec3& centre, const Vec3& half) const {
      return (low.array() < (centre + half).array()).all() &&
             ((centre - half).array() < high.array()).all();
    }
  };

  std::vector<PartBox> boxes_;
  std::vector<Run> runs_;
};

}  // namespace probe::sema
