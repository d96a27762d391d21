#include "runtime/inspect/top_view.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <tuple>

#include "runtime/base/geometry.h"
#include "runtime/base/trig.h"
#include "runtime/inspect/checked_urdf.h"
#include "runtime/inspect/ground_image.h"
#include "runtime/inspect/top_fixtures.h"
#include "runtime/plan/later.h"
#include "runtime/plan/moves.h"
#include "runtime/plan/roles.h"
#include "runtime/robot/kinematics.h"
#include "runtime/robot/urdf.h"

namespace probe::inspect {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kFar = 20;  // m; the picture of the table ends here where it has no other end

Vec3 to_vec(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }
Quat to_quat(const std::array<double, 4>& q) { return {q[0], q[1], q[2], q[3]}; }

// Direction of a frame's x axis seen from above, to a billionth of a degree.
double yaw_deg(const Quat& rotation) {
  const Vec3 x = rotation * Vec3::UnitX();
  return std::nearbyint(portable_atan2(x.y(), x.x()) * kDegrees * 1e9) / 1e9 + 0.0;
}

Footprint footprint_of(const plan::Plan& plan, const plan::PlacementRecord& placement, Role role) {
  const plan::ObjectRecord& object = plan.objects()[placement.object];
  const Quat rotation = to_quat(placement.rotation);
  const Vec3 low = to_vec(object.box_min);
  const Vec3 high = to_vec(object.box_max);
  const Vec3 half = (high - low) / 2;
  const Vec3 middle = rotation * ((low + high) / 2);
  Footprint print;
  print.role = role;
  print.object = plan.text(object.name);
  print.at = {placement.position[0], placement.position[1]};
  print.yaw_deg = yaw_deg(rotation);
  print.outline = box_outline({rotation * Vec3(half.x(), 0, 0), rotation * Vec3(0, half.y(), 0),
                               rotation * Vec3(0, 0, half.z())});
  for (Point& corner : print.outline) {
    corner.x += print.at.x + middle.x();
    corner.y += print.at.y + middle.y();
  }
  return print;
}

void add_way(std::span<const plan::MoveRecord> legs, Footprint& print) {
  for (const auto& [x, y] : plan::corners_of(legs))
    print.way.push_back({print.at.x + x, print.at.y + y});
  print.moves = plan::move_text(legs);
}

Role role_of(const plan::TaskRoles& roles, std::uint32_t body) {
  if (body == roles.source) return Role::kSource;
  if (body == roles.target) return Role::kTarget;
  if (roles.is_distractor(body)) return Role::kDistractor;
  return body < roles.distractors.first ? Role::kOther : Role::kPlaced;
}

// Every different way in which something stands, in the order of the first start that has it.
void add_starts(const plan::Plan& plan, const plan::TaskRecord& task, TopView& view) {
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), task);
  std::map<std::tuple<Role, std::uint32_t, std::array<double, 3>, std::array<double, 4>>,
           std::size_t>
      known;
  const auto moves = plan::moves_of(plan.tables(), task);
  for (const plan::EpisodeRecord& episode : plan.episodes(task)) {
    const auto placements = plan.placements(episode);
    for (std::size_t i = 0; i < placements.size(); ++i) {
      const plan::PlacementRecord& placement = placements[i];
      const Role role = role_of(roles, static_cast<std::uint32_t>(i));
      const auto [at, is_new] = known.try_emplace(
          {role, placement.object, placement.position, placement.rotation}, view.footprints.size());
      if (is_new) {
        view.footprints.push_back(footprint_of(plan, placement, role));
        for (const auto legs : moves) {
          if (legs.front().body == i) add_way(legs, view.footprints.back());
        }
      }
      view.footprints[at->second].starts.push_back(episode.index);
      view.cells.push_back({placement.position[0], placement.position[1]});
    }
  }
  std::sort(view.cells.begin(), view.cells.end());
  view.cells.erase(std::unique(view.cells.begin(), view.cells.end()), view.cells.end());
}

Pinhole pinhole_of(const plan::CameraRecord& camera, const Pose& mount) {
  const auto& aim = camera.aim_values;
  Mat3 axes;
  if (camera.aim == static_cast<std::uint32_t>(plan::CameraAim::kLook)) {
    const Vec3 forward = Vec3(aim[0], aim[1], aim[2]).normalized();
    const Vec3 left = Vec3::UnitZ().cross(forward).normalized();
    axes << forward, left, forward.cross(left);
  } else {
    axes = to_quat(aim).normalized().toRotationMatrix();
  }
  return Pinhole{mount.apply(to_vec(camera.position)),
                 mount.rotation.toRotationMatrix() * axes,
                 static_cast<double>(camera.width),
                 static_cast<double>(camera.height),
                 camera.fx,
                 camera.fy,
                 camera.cx,
                 camera.cy};
}

// Whether nothing that moves carries a link.
bool stands_still(const robot::RobotModel& model, int link) {
  while (true) {
    const int above = model.links[static_cast<std::size_t>(link)].parent_joint;
    if (above < 0) return true;
    const robot::Joint& joint = model.joints[static_cast<std::size_t>(above)];
    if (joint.kind != robot::JointKind::kFixed) return false;
    link = joint.parent_link;
  }
}

bool is_shaken(const plan::Plan& plan, const plan::TaskRecord& task) {
  return std::ranges::any_of(plan.episodes(task), [](const plan::EpisodeRecord& episode) {
    return episode.shaken.count > 0;
  });
}

struct Mounted {
  Pinhole eye;
  bool still = false;
};

// The cameras as they stand when the robot is in its initial position.
Result<std::vector<Mounted>> cameras_of(const plan::Plan& plan, const plan::TaskRecord& task,
                                        const AssetRoot& asset_root) {
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  const plan::RobotRecord& record = plan.robots()[scene.robot];
  PROBE_ASSIGN(const robot::RobotModel model, checked_urdf(plan, record.urdf, asset_root));
  std::vector<std::string> joints;
  for (const plan::DriveRecord& drive : plan.drives(record))
    joints.emplace_back(plan.text(drive.joint));
  PROBE_ASSIGN(const robot::Tree tree, robot::Tree::create(model, joints));
  std::vector<Pose> links(tree.link_count());
  tree.link_poses(plan.joints(scene), links);
  const Pose base{to_vec(scene.base_position), to_quat(scene.base_rotation)};
  std::vector<Mounted> cameras;
  for (const plan::ViewRecord& view : plan.views(task)) {
    const plan::CameraRecord& camera = plan.cameras()[view.camera];
    const std::string mount(plan.text(camera.mount_link));
    const int link = model.find_link(mount);
    if (link < 0) {
      return Failure{
          Fault::kUrdf,
          "no link `" + mount + "` for camera `" + std::string(plan.text(camera.name)) + "`",
          model.path};
    }
    cameras.push_back({pinhole_of(camera, base * links[static_cast<std::size_t>(link)]),
                       stands_still(model, link)});
  }
  return cameras;
}

}  // namespace

std::vector<Point> box_outline(const std::array<Vec3, 3>& axes) {
  // The shadow of a box is the sum of the shadows of its three edges: walk along them by direction,
  // up one side and down the other.
  std::vector<Point> edges;
  Point low;
  for (const Vec3& axis : axes) {
    const Vec3 edge = 2 * axis;
    if (std::abs(edge.x()) + std::abs(edge.y()) < 1e-9) continue;
    const bool up = edge.y() > 0 || (edge.y() == 0 && edge.x() > 0);
    edges.push_back(up ? Point{edge.x(), edge.y()} : Point{-edge.x(), -edge.y()});
    low.x -= edges.back().x / 2;
    low.y -= edges.back().y / 2;
  }
  std::sort(edges.begin(), edges.end(),
            [](const Point& a, const Point& b) { return a.x * b.y - a.y * b.x > 0; });
  std::vector<Point> outline;
  Point at = low;
  for (const double sign : {1.0, -1.0}) {
    for (const Point& edge : edges) {
      outline.push_back(at);
      at = {at.x + sign * edge.x, at.y + sign * edge.y};
    }
  }
  return outline;
}

Result<TopView> top_view(const plan::Plan& plan, std::uint32_t index,
                         const AssetRoot& asset_root) {
  const plan::TaskRecord& task = plan.tasks()[index];
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  const plan::RobotRecord& robot = plan.robots()[scene.robot];
  TopView view;
  view.task = plan.text(task.name);
  view.prompt = plan::whole_instruction(plan.tables(), index);
  view.starts = task.episodes.count;
  view.area = scene.area;
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), task);
  const auto bodies = plan.bodies(task);
  const auto names_of = [&](std::uint32_t first, std::uint32_t count) {
    std::vector<std::string> names;
    for (const plan::BodyRecord& body : bodies.subspan(first, count))
      names.emplace_back(plan.text(body.name));
    return names;
  };
  if (roles.has_source()) view.sources = names_of(roles.source, 1);
  if (roles.has_target()) view.targets = names_of(roles.target, 1);
  for (const plan::RoleRecord& role : roles.others)
    view.others.push_back({std::string(plan.text(role.name)), names_of(role.first, role.count)});
  for (const plan::RoleRecord& role : roles.things) {
    const std::string name(plan.text(role.name));
    const std::string thing(plan::thing_in(plan.tables(), task, role));
    if (plan::is_part_distractor(role)) continue;
    if (role.kind == static_cast<std::uint32_t>(plan::RoleKind::kPartOfSet) &&
        !view.others.empty() && view.others.back().role == name) {
      view.others.back().objects.push_back(thing);
    } else if (name == "source") {
      view.sources = {thing};
    } else if (name == "target") {
      view.targets = {thing};
    } else {
      view.others.push_back({name, {thing}});
    }
  }
  view.distractors = names_of(roles.distractors.first, roles.distractors.count);
  for (const std::string_view part : plan::part_distractors_of(plan.tables(), task))
    view.distractors.emplace_back(part);
  add_starts(plan, task, view);
  view.robot = plan.text(robot.name);
  view.base = {scene.base_position[0], scene.base_position[1]};
  view.base_yaw_deg = yaw_deg(to_quat(scene.base_rotation));
  view.reach_min = robot.reach_min;
  view.reach_max = robot.reach_max;
  PROBE_ASSIGN(const std::vector<Mounted> cameras, cameras_of(plan, task, asset_root));
  const auto names = plan.views(task);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    TopCamera& camera = view.cameras.emplace_back();
    camera.name = plan.text(plan.cameras()[names[i].camera].name);
    if (is_shaken(plan, task)) camera.name += ", as written";
    const Pinhole& pinhole = cameras[i].eye;
    camera.eye = {pinhole.eye.x(), pinhole.eye.y()};
    Eigen::Vector2d right = -pinhole.axes.col(1).head<2>();
    const plan::SensorRecord* sensor = plan.sensor(plan.cameras()[names[i].camera]);
    if (sensor != nullptr && sensor->mirrored != 0) right = -right;
    if (cameras[i].still && right.norm() > 1e-6)
      camera.right = {right.x() / right.norm(), right.y() / right.norm()};
    for (const Vec3& corner : frame_on_plane(pinhole, scene.surface_z, kFar))
      camera.image.push_back({corner.x(), corner.y()});
  }
  PROBE_TRY(add_fixtures(plan, task, asset_root, &view));
  return view;
}

}  // namespace probe::inspect
