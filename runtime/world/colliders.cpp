#include "runtime/world/colliders.h"

#include <algorithm>
#include <array>
#include <limits>

namespace probe::world {
namespace {

using std::size_t;

Box placed(const Box& local, const Mat3& axes, const Vec3& position) {
  return {axes * local.center + position, axes.cwiseAbs() * local.half};
}

void place_boxes(Collider* c) {
  c->box = placed(c->local, c->axes, c->position);
  for (size_t p = 0; p < c->shape->parts.size(); ++p) {
    const scene::ConvexPart& part = c->shape->parts[p];
    c->part_boxes[p] = placed({part.center, part.half}, c->axes, c->position);
  }
}

Box whole_box(const scene::CollisionShape& shape) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const scene::ConvexPart& part : shape.parts) {
    low = low.cwiseMin(part.center - part.half);
    high = high.cwiseMax(part.center + part.half);
  }
  return {0.5 * (low + high), 0.5 * (high - low)};
}

}  // namespace

Collider make_collider(std::shared_ptr<const scene::CollisionShape> shape, double friction,
                       double patch, double give) {
  Collider c;
  c.local = whole_box(*shape);
  c.part_boxes.resize(shape->parts.size());
  for (const scene::ConvexPart& part : shape->parts) c.rounded = c.rounded || part.round > 0;
  c.shape = std::move(shape);
  c.friction = friction;
  c.patch = patch;
  c.give = give;
  return c;
}

void place_links(const Articulation& articulation, const JointArray& u,
                 std::vector<Collider>* colliders) {
  const JointTree& tree = *articulation.tree;
  // Of each moving link: angular velocity, and the velocity of its point at the tree's reference.
  std::array<Vec3, kMaxJoints> spins, speeds;
  for (const int k : tree.outward()) {
    const MovingLink& link = tree.link(k);
    const int parent = tree.parent(k);
    const double rate = u[static_cast<size_t>(link.coordinate)];
    Vec3& spin = spins[static_cast<size_t>(k)];
    Vec3& speed = speeds[static_cast<size_t>(k)];
    spin = rate * link.w;
    speed = rate * link.v;
    if (parent < 0) continue;
    spin += spins[static_cast<size_t>(parent)];
    speed += speeds[static_cast<size_t>(parent)];
  }
  const size_t end = articulation.first_link + articulation.links;
  for (size_t l = articulation.first_link; l < end; ++l) {
    Collider& c = (*colliders)[l];
    if (c.moving_link < 0) continue;
    const MovingLink& carrier = tree.link(c.moving_link);
    const Vec3& spin = spins[static_cast<size_t>(c.moving_link)];
    c.axes = carrier.axes * c.carrier_axes;
    c.position = carrier.axes * c.carrier_offset + carrier.origin;
    const Vec3 speed =
        speeds[static_cast<size_t>(c.moving_link)] + spin.cross(c.position - tree.reference());
    c.reach_speed = speed.norm() + c.shape->bounding_radius * spin.norm();
    place_boxes(&c);
  }
}

void place_body(const Body& body, Collider* collider) {
  collider->axes = body.axes;
  collider->position = body.position;
  collider->reach_speed =
      body.velocity.norm() + collider->shape->bounding_radius * body.spin.norm();
  place_boxes(collider);
}

void place_still(const Pose& pose, Collider* collider) {
  collider->axes = pose.rotation.toRotationMatrix();
  collider->position = pose.position;
  place_boxes(collider);
  std::vector<std::uint32_t>& sorted = collider->sorted_parts;
  const auto low = [&](std::uint32_t part) {
    return collider->part_boxes[part].center.x() - collider->part_boxes[part].half.x();
  };
  sorted.resize(collider->part_boxes.size());
  for (std::uint32_t i = 0; i < sorted.size(); ++i) {
    sorted[i] = i;
    collider->longest_part = std::max(collider->longest_part, 2 * collider->part_boxes[i].half.x());
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](std::uint32_t i, std::uint32_t k) { return low(i) < low(k); });
}

}  // namespace probe::world
