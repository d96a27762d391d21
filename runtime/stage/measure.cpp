#include "runtime/stage/measure.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/upright.h"
#include "runtime/plan/moves.h"
#include "runtime/stage/robot_of.h"

namespace probe::stage {
Instruments::Instruments(const plan::Plan& plan, const plan::TaskRecord& task,
                         const TaskBodies& bodies, std::vector<PlacedTree> trees, int tcp_link)
    : plan_(plan),
      task_(task),
      scene_(plan.scenes()[task.scene]),
      robot_(plan.robots()[scene_.robot]),
      bodies_(bodies),
      trees_(std::move(trees)),
      tcp_(tcp_link) {
  for (const PlacedTree& placed : trees_) {
    jacobians_.emplace_back(6, static_cast<Eigen::Index>(placed.tree.joint_count()));
  }
}

void Instruments::read(const world::World& world, int steps, int substeps, double openness,
                       vm::StepSample* sample) {
  sample->step = steps;
  sample->time = static_cast<double>(steps) * substeps / scene_.physics_hz;
  sample->grip = 1 - openness;
  sample->bodies.assign(bodies_.count(), {});
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
  sample->own.clear();
  for (const auto legs : plan::moves_of(plan_.tables(), task_)) {
    const auto body = static_cast<std::uint16_t>(legs.front().body);
    sample->own.push_back({body, world.led_to(body).value_or(sample->bodies[body].position)});
  }
  sample->joints.clear();
  for (std::size_t i = 0; i < world.joints().size(); ++i) {
    sample->joints.push_back({world.joints()[i], world.joint_speeds()[i]});
  }
}

// Poses by quaternions along the tree, as pictures have them; the world's own agree to 1e-12 m.
void Instruments::read_links(const world::World& world, vm::StepSample* sample) {
  for (PlacedTree& placed : trees_) placed.place(world.joints());
  sample->tcp = trees_.front().link(tcp_).position;
  for (std::size_t k = 0; k < bodies_.links.size(); ++k) {
    const auto [of, link] = bodies_.links[k];
    const PlacedTree& placed = trees_[of];
    const auto u = placed.own(world.joint_speeds());
    const Eigen::Map<const Eigen::VectorXd> speeds(u.data(), static_cast<Eigen::Index>(u.size()));
    placed.tree.jacobian(placed.links, link, jacobians_[of]);
    const Eigen::Matrix<double, 6, 1> twist = jacobians_[of] * speeds;
    const Pose pose = placed.link(link);
    sample->bodies[bodies_.first_link + k] = {
        pose.position, pose.position, placed.base.rotation * Vec3(twist.head<3>()),
        placed.base.rotation * Vec3(twist.tail<3>()), pose.rotation};
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
  std::vector<vm::BodyStart> starts(bodies_.count());
  for (std::size_t i = 0; i < starts.size(); ++i) {
    starts[i].position = settled.bodies[i].position;
    if (i >= bodies_.objects) continue;
    const plan::ObjectRecord& object = plan_.objects()[bodies[i].index];
    const Vec3 half = (to_vec(object.box_max) - to_vec(object.box_min)) / 2;
    starts[i].half = upright_half(half, settled.bodies[i].rotation.toRotationMatrix());
  }
  const std::vector<plan::FingerRecord> fingers = plan_.fingers(robot_);
  for (std::size_t k = 0; k < fingers.size(); ++k)
    starts[bodies_.first_link + k].opening = to_vec(fingers[k].opens).normalized();
  return starts;
}

}  // namespace probe::stage
