// The table scene of the benchmark, built by hand on the real world: drives, friction, drop and
// settle, the suite's success test. What the runtime reads from a plan is written out here.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "runtime/policy/policy.h"
#include "runtime/robot/control.h"
#include "runtime/robot/rotation.h"
#include "runtime/scene/hull.h"
#include "runtime/world/world.h"
#include "tests/runtime/expert/expert_robot.h"

namespace probe::expert::test {

template <typename T>
T need(Result<T> result) {
  REQUIRE_MESSAGE(result.ok(), (result.ok() ? std::string() : to_text(result.failure())));
  return std::move(result).value();
}

inline const std::string kAssets = VLAPROBE_SOURCE_DIR "/assets/";
using Shape = std::shared_ptr<const scene::CollisionShape>;

struct Thing {
  std::string name;
  double density = 0;
  Vec3 half;  // of the suite's box
  Shape shape;
};

inline Thing load_thing(const std::string& name, double density, const Vec3& half) {
  auto shape =
      need(scene::load_collision_obj(kAssets + "objects/" + name + "/collision.obj", Vec3::Ones()));
  return {name, density, half, std::make_shared<const scene::CollisionShape>(std::move(shape))};
}

struct Robot {
  robot::RobotModel model;
  std::vector<world::ArticulationSpec::Link> links;  // fingers first
};

inline Robot load_robot() {
  const std::string folder = kAssets + "robots/widowx/";
  Robot out{need(robot::load_urdf(folder + "wx250s.urdf")), {}};
  for (const char* name : {"left_finger_link", "right_finger_link", "gripper_bar_link",
                           "gripper_prop_link", "gripper_link", "wrist_link", "lower_forearm_link",
                           "upper_forearm_link", "upper_arm_link", "shoulder_link"}) {
    const robot::Link& link = out.model.links[std::size_t(out.model.find_link(name))];
    auto shape = need(scene::load_collision_obj(folder + link.collisions.at(0).path, Vec3::Ones(),
                                                {.single_hull = true}));
    const bool finger = out.links.size() < 2;
    out.links.push_back({name, std::make_shared<const scene::CollisionShape>(std::move(shape)),
                         finger ? 2.0 : 1.0, finger ? 0.01 : 0.0});
  }
  return out;
}

inline const std::vector<world::JointSpec> kDrives = {
    {"waist", 1169.789, 330.0, 200},         {"shoulder", 730.0, 180.0, 200},
    {"elbow", 808.460, 152.120, 100},        {"forearm_roll", 1229.130, 309.622, 100},
    {"wrist_angle", 1272.276, 201.050, 100}, {"wrist_rotate", 1056.333, 269.515, 100},
    {"left_finger", 1000, 200, 60},          {"right_finger", 1000, 200, 60}};
inline const std::vector<double> kStartJoints = {-0.01840777, 0.0398835,  0.22242722, -0.00460194,
                                                 1.36524296,  0.00153398, 0.037,      0.037};
inline constexpr double kTable = 0.87;
inline constexpr int kHorizon = 60;

// Source is thing 0, target thing 1.
class WorldTable {
 public:
  WorldTable(const Robot& robot, const std::vector<Thing>& things, const std::vector<Pose>& placed)
      : robot_(robot),
        things_(things),
        described_(widowx(robot.model)),
        controller_(make_controller(robot.model)) {
    std::vector<Pose> settled = settle(placed);
    world_ = need(world::World::create(spec(settled, true)));
    controller_.reset(world_->joints());
    view_.base = base();
    view_.surface_z = kTable;
    for (std::size_t i = 0; i < things.size(); ++i) {
      policy::PrivilegedObject object;
      object.name = things[i].name;
      object.finger_contact.assign(2, false);
      for (const auto& part : things[i].shape->parts) {
        object.parts.emplace_back();
        for (const Vec3& v : part.vertices) {
          object.parts.back().push_back(v + things[i].shape->center_of_mass);
        }
      }
      view_.objects.push_back(std::move(object));
    }
    measure();
  }

  policy::EpisodeStart start() const {
    policy::EpisodeStart out;
    out.horizon = kHorizon;
    out.robot = &described_;
    return out;
  }

  policy::Observation observe(int step) const {
    const auto q = world_->joints();
    policy::Observation out;
    out.proprioception = {controller_.tcp_pose(q), controller_.openness(q), {q.begin(), q.end()}};
    out.privileged = &view_;
    out.step = step;
    out.horizon = kHorizon;
    return out;
  }

  void apply(const policy::Action& action) {
    const auto targets = need(controller_.targets(action.tool(), world_->joints()));
    reached_ = controller_.reached();
    world_->set_targets(targets);
    const Status stepped = world_->step(100);
    REQUIRE_MESSAGE(stepped.ok(), (stepped.ok() ? std::string() : to_text(stepped.failure())));
    measure();
  }

  bool intention() const { return intention_; }
  bool grasp() const { return grasp_; }
  bool reached() const { return reached_; }
  const policy::Privileged& view() const { return view_; }
  world::World& world() { return *world_; }

  // The suite's `on`, after the last step.
  bool success() const {
    const Vec3 apart = view_.objects[0].pose.position - view_.objects[1].pose.position;
    const Vec3 &source = things_[0].half, &target = things_[1].half;
    if (apart.head<2>().norm() > target.head<2>().norm() + 0.003) return false;
    if (apart.z() <= 0 || apart.z() - target.z() - source.z() > 0.02) return false;
    for (const world::ContactImpulse& c : world_->contacts()) {
      if (c.on_a.norm() <= 1e-6) continue;
      const world::Party source_party{world::PartyKind::kBody, 0};
      if (c.a != source_party && c.b != source_party) continue;
      const world::Party& other = c.a == source_party ? c.b : c.a;
      if (other.kind == world::PartyKind::kSurface) return false;
      if (other.kind == world::PartyKind::kBody && other.index != 1) return false;
    }
    return true;
  }

 private:
  static Pose base() { return {Vec3(0.147, 0.028, 0.870), Quat(0, 0, 0, 1)}; }

  static robot::EeDeltaPoseController make_controller(const robot::RobotModel& model) {
    return need(robot::EeDeltaPoseController::create(model, widowx(model).control));
  }

  world::WorldSpec spec(const std::vector<Pose>& poses, bool with_links) const {
    world::WorldSpec out;
    out.articulations.emplace_back();
    out.articulations[0].model = &robot_.model;
    out.articulations[0].base = base();
    out.articulations[0].joints = kDrives;
    out.articulations[0].positions = kStartJoints;
    if (with_links) out.articulations[0].links = robot_.links;
    for (std::size_t i = 0; i < things_.size(); ++i) {
      out.bodies.push_back({things_[i].name, things_[i].shape, things_[i].density, 0.5, poses[i]});
    }
    out.surface_z = kTable;
    return out;
  }

  // The robot is out of the way: it has no shapes while things fall.
  std::vector<Pose> settle(const std::vector<Pose>& placed) const {
    auto world = need(world::World::create(spec(placed, false)));
    world->lock_tilt(true);
    REQUIRE(world->step(250).ok());
    world->lock_tilt(false);
    world->stop_bodies();
    REQUIRE(world->step(250).ok());
    double speed = 0, spin = 0;
    for (std::size_t i = 0; i < things_.size(); ++i) {
      speed += world->body(i).velocity.norm();
      spin += world->body(i).spin.norm();
    }
    if (speed > 1e-3 || spin > 1e-2) REQUIRE(world->step(750).ok());
    std::vector<Pose> out;
    for (std::size_t i = 0; i < things_.size(); ++i) out.push_back(world->body(i).pose);
    return out;
  }

  void measure() {
    for (std::size_t i = 0; i < things_.size(); ++i) {
      view_.objects[i].pose = world_->body(i).pose;
      view_.objects[i].finger_contact.assign(2, false);
    }
    bool pressed[2] = {false, false};
    for (const world::ContactImpulse& c : world_->contacts()) {
      const bool link_is_a = c.a.kind == world::PartyKind::kLink;
      const world::Party& link = link_is_a ? c.a : c.b;
      const world::Party& body = link_is_a ? c.b : c.a;
      if (link.kind != world::PartyKind::kLink || link.index > 1) continue;
      if (body.kind != world::PartyKind::kBody || c.on_a.norm() < 1e-6) continue;
      view_.objects[body.index].finger_contact[link.index] = true;
      if (body.index != 0) continue;
      // The left finger closes along -y of its frame and is pressed along +y, the right one the
      // other way.
      const Vec3 outward =
          world_->link_pose(link.index).rotation * Vec3(0, link.index == 0 ? 1 : -1, 0);
      const Vec3 on_link = link_is_a ? c.on_a : Vec3(-c.on_a);
      pressed[link.index] = on_link.dot(outward) > 0.5 * on_link.norm();
    }
    const Vec3 tcp = world_->frame_pose("ee_gripper_link").position;
    intention_ = intention_ || view_.objects[0].finger_contact[0] ||
                 view_.objects[0].finger_contact[1] ||
                 (tcp - view_.objects[0].pose.position).norm() < 0.05;
    grasp_ = grasp_ || (pressed[0] && pressed[1]);
  }

  const Robot& robot_;
  const std::vector<Thing>& things_;
  robot::Robot described_;
  robot::EeDeltaPoseController controller_;
  std::unique_ptr<world::World> world_;
  policy::Privileged view_;
  bool intention_ = false, grasp_ = false, reached_ = true;
};

}  // namespace probe::expert::test
