#include "compiler/geometry/box_runs.h"

namespace probe::sema {

std::vector<BoxRun> runs_of(const std::vector<PartBox>& boxes) {
  constexpr std::size_t kLongest = 32;  // a part's whole way is long, and so is the box around it
  std::vector<BoxRun> runs;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Vec3 low = boxes[i].solid.centre - boxes[i].half;
    const Vec3 high = boxes[i].solid.centre + boxes[i].half;
    if (i == 0 || boxes[i].part != boxes[i - 1].part || i - runs.back().begin == kLongest) {
      runs.push_back({i, i + 1, low, high});
      continue;
    }
    BoxRun& run = runs.back();
    run.end = i + 1;
    run.low = run.low.cwiseMin(low);
    run.high = run.high.cwiseMax(high);
  }
  return runs;
}

}  // namespace probe::sema
