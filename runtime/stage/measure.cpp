#include "runtime/stage/measure.h"

#include <algorithm>
#include <cmath>

#include "runtime/stage/robot_of.h"

namespace probe::stage {
namespace {

// Half extents along the body's own axes, reordered so that z is the one nearest the vertical; x
// and y keep their order.
Vec3 upright_half(const Vec3& half, const Quat& rotation) {
  const Mat3 axes = rotation.toRotationMatrix();
  int up = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(axes(2, axis)) > std::abs(axes(2, up))) up = axis;
  }
  if (up == 0) return {half.y(), half.z(), half.x()};
  if (up == 1) return {half.x(), half.z(), half.y()};
  return half;
}

}  // namespace

Instruments::Instruments(const plan::Plan& plan, const plan::TaskRecord& task,
                         const TaskBodies& bodies, robot::Tree tree, int tcp_link)
    : plan_(plan),
      task_(task),
      scene_(plan.scenes()[task.scene]),
      robot_(plan.robots()[scene_.robot]),
      bodies_(bodies),
      tree_(std::move(tree)),
      tcp_(tcp_link),
      base_(base_pose(scene_)),
      links_(tree_.link_count()),
      jacobian_(6, static_cast<Eigen::Index>(tree_.joint_count())) {}

void Instruments::read(const world::World& world, int steps, int substeps, double openness,
                       vm::StepSample* sample) {
  sample->step = steps;
  sample->time = steps * substeps / scene_.physics_hz;
  sample->grip = 1 - openness;
  sample->bodies.assign(bodies_.count, {});
  for (std::size_t i = 0; i < bodies_.objects; ++i) {
    const world::BodyState state = world.body(i);
    sample->bodies[i] = {state.center, state.pose.position, state.velocity, state.spin,
                         state.pose.rotation};
  }
  vm::BodySample& surface = sample->bodies[bodies_.surface];
  surface.position = surface.origin = {0, 0, scene_.surface_z};
  if (bodies_.fixture != TaskBodies::kNone) {
    vm::BodySample& fixture = sample->bodies[bodies_.fixture];
    fixture.position = fixture.origin = to_vec(scene_.fixture_position);
  }
  read_links(world, sample);
  read_contacts(world, sample);
  sample->joints.clear();
  for (std::size_t i = 0; i < world.joints().size(); ++i) {
    sample->joints.push_back({world.joints()[i], world.joint_speeds()[i]});
  }
}

// Poses by quaternions along the tree, as pictures have them; the world's own agree to 1e-12 m.
void Instruments::read_links(const world::World& world, vm::StepSample* sample) {
  const auto q = world.joints().first(tree_.joint_count());
  const auto u = world.joint_speeds().first(tree_.joint_count());
  tree_.link_poses(q, links_);
  const Eigen::Map<const Eigen::VectorXd> speeds(u.data(), static_cast<Eigen::Index>(u.size()));
  sample->tcp = base_.apply(links_[static_cast<std::size_t>(tcp_)].position);
  for (std::size_t k = 0; k < bodies_.links.size(); ++k) {
    const int link = bodies_.links[k];
    const Pose pose = base_ * links_[static_cast<std::size_t>(link)];
    tree_.jacobian(links_, link, jacobian_);
    const Eigen::Matrix<double, 6, 1> twist = jacobian_ * speeds;
    sample->bodies[bodies_.first_link + k] = {
        pose.position, pose.position, base_.rotation * Vec3(twist.head<3>()),
        base_.rotation * Vec3(twist.tail<3>()), pose.rotation};
  }
}

void Instruments::read_contacts(const world::World& world, vm::StepSample* sample) const {
  sample->contacts.clear();
  for (const world::ContactImpulse& contact : world.contacts()) {
    const std::uint16_t a = bodies_.local(contact.a), b = bodies_.local(contact.b);
    // The world says what b exerts on a; a sample, what the lower index exerts on the higher.
    sample->contacts.push_back(
        {std::min(a, b), std::max(a, b), a < b ? Vec3(-contact.on_a) : contact.on_a});
  }
  std::sort(sample->contacts.begin(), sample->contacts.end(),
            [](const vm::ContactSample& x, const vm::ContactSample& y) {
              return x.a != y.a ? x.a < y.a : x.b < y.b;
            });
}

std::vector<vm::BodyStart> Instruments::starts(const vm::StepSample& settled) const {
  const auto bodies = plan_.bodies(task_);
  std::vector<vm::BodyStart> starts(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    starts[i].position = settled.bodies[i].position;
    if (i >= bodies_.objects) continue;
    const plan::ObjectRecord& object = plan_.objects()[bodies[i].index];
    const Vec3 half = (to_vec(object.box_max) - to_vec(object.box_min)) / 2;
    starts[i].half = upright_half(half, settled.bodies[i].rotation);
  }
  for (std::size_t k = 0; k < robot_.fingers.size(); ++k) {
    if (plan_.text(robot_.fingers[k].link).empty()) continue;
    starts[bodies_.first_link + k].opening = to_vec(robot_.fingers[k].opens).normalized();
  }
  return starts;
}

}  // namespace probe::stage
