#include "compiler/check/joint_text.h"

#include <fmt/format.h>

#include <numbers>

#include "compiler/check/starts.h"

namespace probe::sema {
namespace {

std::string position_text(const Fixture::Joint& joint, double position) {
  return joint.slides ? centimetres(position)
                      : fmt::format("{:.4g}deg", position * 180 / std::numbers::pi);
}

}  // namespace

std::string when_joints_stand(const Fixture& fixture, const Travel& travel, const PartBox& box) {
  std::string text;
  const auto joints = travel.joints_of(box);
  for (const std::size_t i : travel.carriers(box.part)) {
    const Fixture::Joint& joint = fixture.joints[i];
    text += fmt::format("{} `{}.{}` stands at {}", text.empty() ? " when" : " and", fixture.name,
                        joint.name, position_text(joint, joints[i]));
  }
  return text;
}

}  // namespace probe::sema
