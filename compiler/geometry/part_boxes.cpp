#include "compiler/geometry/part_boxes.h"

namespace probe::sema {

void PartBoxes::add(const PartBox& box) {
  constexpr std::size_t kLongest = 32;  // a part's whole way is long, and so is the box around it
  const std::size_t at = boxes_.size();
  const Vec3 low = box.solid.centre - box.half, high = box.solid.centre + box.half;
  if (at == 0 || boxes_.back().part != box.part || at - runs_.back().begin == kLongest) {
    runs_.push_back({at, at + 1, low, high});
  } else {
    Run& run = runs_.back();
    run.end = at + 1;
    run.low = run.low.cwiseMin(low);
    run.high = run.high.cwiseMax(high);
  }
  boxes_.push_back(box);
}

}  // namespace probe::sema
