// What checks of ways share: what each fixture fills, arms as scenes begin, fixtures as tasks do.
#include <algorithm>
#include <filesystem>
#include <string>

#include "compiler/check/starts.h"
#include "compiler/define/fixture.h"
#include "compiler/geometry/footprint.h"
#include "compiler/geometry/mesh_bounds.h"
#include "compiler/geometry/pose.h"
#include "runtime/base/file.h"
#include "runtime/robot/kinematics.h"
#include "runtime/scene/link_solids.h"

namespace probe::sema {
namespace {

std::vector<ArmLink> arm_of(const Model& model, const Scene& scene, const AssetRoot& asset_root) {
  std::vector<ArmLink> links;
  if (scene.robot == RobotId::kNone) return links;
  const Robot& robot = model.robots[scene.robot];
  if (!robot.model || scene.joints.size() != robot.drives.size()) return links;
  std::vector<std::string> names;
  std::vector<double> joints;
  for (std::size_t i = 0; i < robot.drives.size(); ++i) {
    names.push_back(robot.drives[i].joint.text);
    joints.push_back(scene.joints[i].si());
  }
  const auto tree = robot::Tree::create(*robot.model, names);
  if (!tree.ok()) return links;
  std::vector<Pose> poses(tree->link_count());
  tree->link_poses(joints, poses);
  const Pose base = pose_of(scene.base_position, scene.base_turn.rotation);
  const std::string folder =
      std::filesystem::path(asset_root.file(robot.urdf.text)).parent_path().string();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (const scene::Solid& solid : scene::link_solids(robot.model->links[i], folder))
      links.push_back({robot.model->links[i].name, moved(solid, base * poses[i])});
  }
  return links;
}

}  // namespace

const std::optional<Travel>& Travels::of(const Scene& scene, FixtureId id) {
  const auto [known, is_new] = known_.try_emplace({id, scene.fixtures_lift});
  if (is_new) known->second = Travel::of(scene, model_.fixtures[id], asset_root_);
  return known->second;
}

const std::vector<ArmLink>& Travels::arm(SceneId id) {
  const auto [known, is_new] = arms_.try_emplace(id);
  if (is_new) known->second = arm_of(model_, model_.scenes[id], asset_root_);
  return known->second;
}

std::optional<Travels::Heights> Travels::heights(const Scene& scene) {
  Heights all{scene.surface_z, scene.surface_z};
  const auto add = [&](double low, double high) {
    all.low = std::min(all.low, low);
    all.high = std::max(all.high, high);
  };
  for (const FixtureId id : scene.fixtures) {
    const auto& travel = of(scene, id);
    if (!travel) return std::nullopt;
    for (const PartBox& box : travel->everywhere().all())
      add(box.solid.centre.z() - box.half.z(), box.solid.centre.z() + box.half.z());
  }
  if (scene.fixture) {
    const auto text =
        read_file(asset_root_.file("fixtures/" + scene.fixture->text + "/collision.obj"));
    const auto bounds = text ? bounds_of_obj(*text) : std::nullopt;
    if (!bounds) return std::nullopt;
    add(scene.fixture_position[2] + bounds->low[2], scene.fixture_position[2] + bounds->high[2]);
  }
  return all;
}

std::vector<BegunFixture> begun_fixtures(const TaskStarts& starts, Travels& travels) {
  std::vector<std::vector<double>> all;
  for (const Start& start : starts.task.starts) {
    all.push_back(joint_starts_of(starts.model, starts.task, start));
    if (starts.layout.given_joints.empty()) break;
  }
  std::ptrdiff_t at = 0;
  std::vector<BegunFixture> begun;
  const Scene& scene = starts.model.scenes[starts.task.scene];
  for (const FixtureId id : scene.fixtures) {
    const Fixture& fixture = starts.model.fixtures[id];
    const std::ptrdiff_t from = at;
    at += static_cast<std::ptrdiff_t>(fixture.joints.size());
    const auto& travel = travels.of(scene, id);
    if (!travel) continue;
    BegunFixture one{fixture, *travel, {}};
    for (const std::vector<double>& joints : all)
      one.joints.emplace_back(joints.begin() + from, joints.begin() + at);
    const auto is_first = [&](const std::vector<double>& joints) {
      return joints == one.joints.front();
    };
    if (std::ranges::all_of(one.joints, is_first)) one.joints.resize(1);
    begun.push_back(std::move(one));
  }
  return begun;
}

scene::Solid solid_of(const TaskStarts& starts, const Start::Placed& placed) {
  const Object& object = starts.object(placed);
  const Mat3 turn = axes_of(placed.turn);
  const double surface = starts.model.scenes[starts.task.scene].surface_z;
  return solid(object, turn,
               {placed.x, placed.y, placed.z.value_or(surface - lowest(object, turn))});
}

}  // namespace probe::sema
