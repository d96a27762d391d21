#include "compiler/define/arm_start.h"

#include <algorithm>
#include <span>

#include "runtime/base/hash_number.h"
#include "runtime/base/sha256.h"

namespace probe::sema {
namespace {

// From -1 to 1, of 53 bits.
double arm_draw(std::size_t index, const std::string& joint) {
  Hasher hasher;
  hasher.text("joints jitter").u64(index).text(joint);
  const std::uint64_t bits = big_endian_number(hasher.finish()) >> 11;
  return static_cast<double>(bits) * 0x1p-52 - 1;
}

}  // namespace

std::vector<double> arm_start_of(const Model& model, const Task& task, std::size_t index) {
  const Layout& layout = model.layouts[task.layout];
  const double most = layout.joints_jitter;
  std::span<const GivenJoint> given;
  if (!layout.given_joints.empty()) given = layout.given_joints[task.starts[index].given];
  const auto is_arm = [](const GivenJoint& joint) { return joint.robot != RobotId::kNone; };
  if (most == 0 && std::ranges::none_of(given, is_arm)) return {};
  const Scene& scene = model.scenes[task.scene];
  const Robot& robot = model.robots[scene.robot];
  std::vector<double> start;
  for (std::size_t i = 0; i < scene.joints.size() && i < robot.drives.size(); ++i) {
    const Drive& drive = robot.drives[i];
    start.push_back(scene.joints[i].si());
    double& q = start.back();
    for (const GivenJoint& joint : given) {
      if (joint.robot == scene.robot && joint.joint == i) q = joint.value;
    }
    if (drive.slides || most == 0) continue;
    q += most * arm_draw(index, drive.joint.text);
    const int joint = robot.model ? robot.model->find_joint(drive.joint.text) : -1;
    if (joint < 0) continue;
    const robot::Joint& limits = robot.model->joints[static_cast<std::size_t>(joint)];
    if (limits.kind == robot::JointKind::kRevolute) q = std::clamp(q, limits.lower, limits.upper);
  }
  return start;
}

}  // namespace probe::sema
