#include "runtime/world/controlled.h"

#include <fmt/format.h>

#include "runtime/base/check.h"
#include "runtime/world/joint_tree.h"

namespace probe::world {

namespace {

constexpr double kEngineImpedance = 0.9;           // solimp's first
constexpr double kEngineFade = 2 / (0.95 * 0.02);  // 1/s

}  // namespace

using std::size_t;

Result<ControlLoop> ControlLoop::create(const World& world, const robot::Controller& controller) {
  const auto& all = world.spec().articulations;
  const auto refuse = [](std::string message) {
    return Failure{Fault::kWorld, std::move(message), ""};
  };
  if (all.empty() || !all.front().driven || all.front().joints.size() != controller.joint_count()) {
    return refuse(fmt::format("a controller of {} joints, which the world's robot has not",
                              controller.joint_count()));
  }
  const bool by_efforts = controller.kind().reads == robot::Reads::kDynamics;
  if (all.front().by_efforts != by_efforts) {
    return refuse(fmt::format("`{}` gives joints {}, the world's robot takes {}",
                              controller.kind().word, by_efforts ? "efforts" : "targets",
                              by_efforts ? "targets" : "efforts"));
  }
  ControlLoop loop;
  if (by_efforts) {
    PROBE_ASSIGN(loop.tool_, world.find_tool(controller.tcp_link(), controller.arm_joint_count()));
  }
  loop.efforts_.resize(controller.joint_count());
  return loop;
}

Status ControlLoop::step(std::span<const double> action, int substeps,
                         robot::Controller* controller, World* world) {
  PROBE_TRY(controller->begin(action, world->joints().first(efforts_.size()),
                              world->joint_speeds().first(efforts_.size()), substeps));
  if (controller->kind().reads == robot::Reads::kPositions) {
    world->set_targets(controller->targets());
    return world->step(substeps);
  }
  if (controller->kind().reads == robot::Reads::kStates) {
    return world->step(substeps, [&] {
      controller->next();
      world->set_targets(controller->targets(), controller->target_speeds());
    });
  }
  return world->step(substeps, [&] {
    const std::span<const double> believed = controller->believed();
    if (believed.empty()) {
      world->read_dynamics(tool_, &now_);
    } else {
      world->read_dynamics_at(tool_, believed, &now_);
    }
    controller->efforts(now_, efforts_);
    world->set_efforts(tool_.articulation, efforts_);
  });
}

Result<std::vector<JointSpec>> effort_joints(const robot::RobotModel& model,
                                             std::span<const std::string> joints,
                                             std::span<const double> armature) {
  PROBE_CHECK(armature.empty() || armature.size() == joints.size(), "an armature a joint");
  std::vector<JointSpec> made;
  for (size_t i = 0; i < joints.size(); ++i) {
    const int j = model.find_joint(joints[i]);
    if (j < 0) {
      return Failure{Fault::kWorld, "no joint `" + joints[i] + "` in `" + model.name + "`", ""};
    }
    JointSpec& spec = made.emplace_back();
    spec.joint = joints[i];
    spec.damping = model.joints[static_cast<size_t>(j)].damping;
    spec.friction = model.joints[static_cast<size_t>(j)].friction;
    if (!armature.empty()) spec.armature = armature[i];
  }
  PROBE_TRY(give_way_as_engine(model, made));
  return made;
}

Status give_way_as_engine(const robot::RobotModel& model, std::span<JointSpec> joints) {
  std::vector<int> order;
  for (const JointSpec& joint : joints) {
    const int j = model.find_joint(joint.joint);
    if (j < 0) {
      return Failure{Fault::kWorld, "no joint `" + joint.joint + "` in `" + model.name + "`", ""};
    }
    order.push_back(j);
  }
  PROBE_ASSIGN(const auto tree, JointTree::create(model, Pose{}, order));
  tree->update(JointArray{});
  const Eigen::Index n = static_cast<Eigen::Index>(joints.size());
  Eigen::MatrixXd mass(n, n);
  for (size_t i = 0; i < joints.size(); ++i) {
    for (size_t k = 0; k < joints.size(); ++k) {
      mass(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          tree->mass()[i][k] + (i == k ? joints[i].armature : 0);
    }
  }
  const Eigen::MatrixXd mobility = mass.inverse();
  for (size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].friction == 0) continue;
    const Eigen::Index at = static_cast<Eigen::Index>(i);
    joints[i].friction_fade = kEngineFade;
    joints[i].friction_give = (1 - kEngineImpedance) / kEngineImpedance * mobility(at, at);
  }
  return {};
}

}  // namespace probe::world
