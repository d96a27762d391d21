// Robots as records, with every mesh that the URDF names.
#include <algorithm>
#include <filesystem>

#include "compiler/emit/emitter.h"

namespace probe::emit {

void Emitter::add_robot(sema::RobotId id) {
  if (!robots_.add(id, size32(records().robots))) return;
  const sema::Robot& robot = model_.robots[id];
  plan::RobotRecord record;
  record.name = writer_.text(robot.name);
  record.tcp = writer_.text(robot.tcp.text);
  const AssetOwner owner{AssetOwner::Kind::kRobot, static_cast<std::uint32_t>(id)};
  record.urdf = assets_.add(robot.urdf.text, plan::AssetKind::kUrdf, robot.urdf.span, owner);
  add_law(robot, &record);
  record.control_hz = robot.control_hz;
  std::vector<plan::FingerRecord> more;
  for (std::size_t i = 0; i < robot.fingers.size(); ++i) {
    const plan::FingerRecord finger{writer_.text(robot.fingers[i].link.text),
                                    robot.fingers[i].opens};
    if (i < record.fingers.size()) {
      record.fingers[i] = finger;
    } else {
      more.push_back(finger);
    }
  }
  if (!more.empty()) {
    record.more_fingers =
        plan::append(records().fingers, std::span<const plan::FingerRecord>(more));
  }
  record.grip_closed = robot.grip_closed;
  record.grip_open = robot.grip_open;
  record.finger_friction = robot.finger_friction;
  record.finger_patch = robot.finger_patch;
  record.link_friction = robot.link_friction;
  record.reach_min = robot.reach_min;
  record.reach_max = robot.reach_max;
  std::vector<plan::DriveRecord> drives;
  std::vector<plan::GearRecord> gears;
  bool has_gears = false;
  for (const sema::Drive& drive : robot.drives) {
    drives.push_back({writer_.text(drive.joint.text), drive.stiffness, drive.damping, drive.limit});
    gears.push_back({drive.friction, drive.armature});
    has_gears = has_gears || drive.friction != 0 || drive.armature != 0;
  }
  if (has_gears)
    record.gears = plan::append(records().gears, std::span<const plan::GearRecord>(gears));
  record.drives = plan::append(records().drives, std::span<const plan::DriveRecord>(drives));
  record.meshes = writer_.list(urdf_meshes(*robot.model, robot.urdf, owner));
  records().robots.push_back(record);
}

void Emitter::add_law(const sema::Robot& robot, plan::RobotRecord* record) {
  plan::LawRecord law;
  const auto put = [&](plan::Control control) {
    record->control = static_cast<std::uint32_t>(control);
    if (control == plan::Control::kEeDeltaPose) return;
    record->law = plan::append(records().laws, std::span<const plan::LawRecord>(&law, 1));
  };
  if (const auto* osc = std::get_if<robot::OscPose>(&robot.law)) {
    law.kp = osc->kp;
    law.damping = osc->damping;
    law.output = osc->output;
    law.null_kp = osc->null_kp;
    law.ramp = osc->ramp;
    law.grip_pace = osc->grip.pace;
    law.grip_stiffness = osc->grip.stiffness;
    law.grip_limit = osc->grip.limit;
    law.home = writer_.reals(osc->home);
    if (osc->uncouple) law.flags |= plan::kLawUncoupled;
    put(plan::Control::kOscPose);
  } else if (const auto* steps = std::get_if<robot::JointDelta>(&robot.law)) {
    law.most = steps->most;
    if (steps->from_target) law.flags |= plan::kLawFromTarget;
    put(plan::Control::kJointDelta);
  } else if (std::holds_alternative<robot::JointPosition>(robot.law)) {
    put(plan::Control::kJointPosition);
  } else if (const auto* paths = std::get_if<robot::EeDeltaInterpolated>(&robot.law)) {
    law.arm_path = {paths->arm.speed, paths->arm.acceleration, paths->arm.jerk};
    law.finger_path = {paths->fingers.speed, paths->fingers.acceleration, paths->fingers.jerk};
    put(plan::Control::kEeDeltaInterpolated);
  } else {
    put(plan::Control::kEeDeltaPose);
  }
}

std::vector<std::uint32_t> Emitter::urdf_meshes(const robot::RobotModel& model,
                                                const sema::Spelled& urdf, AssetOwner owner) {
  std::vector<std::uint32_t> meshes;
  const std::filesystem::path folder = std::filesystem::path(urdf.text).parent_path();
  const auto add = [&](const robot::MeshRef& mesh, plan::AssetKind kind) {
    const std::string path = (folder / mesh.path).lexically_normal().generic_string();
    const std::uint32_t index = assets_.add(path, kind, urdf.span, owner);
    if (std::find(meshes.begin(), meshes.end(), index) == meshes.end()) meshes.push_back(index);
  };
  for (const robot::Link& link : model.links) {
    for (const robot::MeshRef& mesh : link.visuals) add(mesh, plan::AssetKind::kVisualMesh);
    for (const robot::MeshRef& mesh : link.collisions) add(mesh, plan::AssetKind::kCollisionMesh);
  }
  return meshes;
}

}  // namespace probe::emit
