#include "compiler/check/part_boxes.h"

#include <fmt/format.h>

#include <numbers>

#include "compiler/check/starts.h"

namespace probe::sema {
namespace {

std::string stands(const Fixture::Joint& joint, double position) {
  return joint.slides ? centimetres(position)
                      : fmt::format("{:.4g}deg", position * 180 / std::numbers::pi);
}

}  // namespace

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

std::string when(const Fixture& fixture, const Travel& travel, const PartBox& box) {
  std::string text;
  const auto joints = travel.joints_of(box);
  for (const std::size_t i : travel.carriers(box.part)) {
    const Fixture::Joint& joint = fixture.joints[i];
    text += fmt::format("{} `{}.{}` stands at {}", text.empty() ? " when" : " and", fixture.name,
                        joint.name, stands(joint, joints[i]));
  }
  return text;
}

}  // namespace probe::sema
