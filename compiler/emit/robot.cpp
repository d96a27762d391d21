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
  record.control = static_cast<std::uint32_t>(plan::Control::kEeDeltaPose);
  record.control_hz = robot.control_hz;
  for (std::size_t i = 0; i < record.fingers.size(); ++i) {
    record.fingers[i] = {writer_.text(robot.fingers[i].link.text), robot.fingers[i].opens};
  }
  record.grip_closed = robot.grip_closed;
  record.grip_open = robot.grip_open;
  record.finger_friction = robot.finger_friction;
  record.finger_patch = robot.finger_patch;
  record.link_friction = robot.link_friction;
  record.reach_min = robot.reach_min;
  record.reach_max = robot.reach_max;
  std::vector<plan::DriveRecord> drives;
  for (const sema::Drive& drive : robot.drives) {
    drives.push_back({writer_.text(drive.joint.text), drive.stiffness.si(), drive.damping.si(),
                      drive.limit.si()});
  }
  record.drives = plan::append(records().drives, std::span<const plan::DriveRecord>(drives));
  record.meshes = writer_.list(urdf_meshes(*robot.model, robot.urdf, owner));
  records().robots.push_back(record);
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
