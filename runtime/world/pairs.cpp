#include "runtime/world/pairs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/world/manifold.h"
#include "runtime/world/round_contact.h"

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

void tangents(Contact* c) {
  const Vec3 axis = std::fabs(c->n.x()) < 0.57 ? Vec3::UnitX() : Vec3::UnitY();
  c->t1 = c->n.cross(axis);
  c->t1 /= c->t1.norm();
  c->t2 = c->n.cross(c->t1);
}

bool is_awake(const Collider& c, const std::vector<Body>& bodies) {
  return c.body >= 0 && !bodies[static_cast<size_t>(c.body)].asleep;
}

bool may_move(const Collider& c, const std::vector<Body>& bodies) {
  return c.path != 0 || is_awake(c, bodies);
}

void collide_parts(const scene::ConvexPart& a, const scene::ConvexPart& b, const RelativePose& pose,
                   double margin, FaceRef* cached, Candidates* out) {
  FaceRef none;
  if (a.round > 0 || b.round > 0) {
    collide_rounded(a, b, pose, margin, out);
  } else {
    collide_hulls(a, b, pose, margin, cached != nullptr ? cached : &none, out);
  }
}

// Emits the record's points that are nearer than the margin; the others lose their impulses.
void emit(const ColliderPair& pair, std::uint32_t index, double margin, const Plane& plane,
          std::uint64_t substep, const std::vector<Collider>& colliders, PairTable* table,
          Problem* problem) {
  const std::uint32_t pair_index = static_cast<std::uint32_t>(&pair - table->pairs.data());
  PairRecord& record = table->records[index];
  const Collider& a = colliders[static_cast<size_t>(pair.a)];
  const Collider* b = pair.b < 0 ? nullptr : &colliders[static_cast<size_t>(pair.b)];
  record.impulse = Vec3::Zero();
  for (int k = 0; k < record.count; ++k) {
    ManifoldPoint& point = record.points[static_cast<size_t>(k)];
    const Vec3 on_a = a.axes * point.anchor_a + a.position;
    const Vec3 n = b == nullptr ? Vec3::UnitZ() : Vec3(a.axes * point.normal_a);
    const Vec3 on_b = b == nullptr ? Vec3(on_a.x(), on_a.y(), plane.height)
                                   : Vec3(b->axes * point.anchor_b + b->position);
    const double gap = n.dot(on_a - on_b);
    if (gap > margin) {
      point.normal_impulse = point.torsion_impulse = 0;
      point.friction_impulse = Vec3::Zero();
      continue;
    }
    record.last = substep;
    Contact& c = problem->contacts.emplace_back();
    c.record = index;
    c.pair = pair_index;
    c.point = static_cast<std::int8_t>(k);
    c.links = a.path != 0 || (b != nullptr && b->path != 0);
    c.collider_a = pair.a;
    c.collider_b = pair.b;
    const std::vector<Body>& bodies = *problem->bodies;
    if (is_awake(a, bodies)) {
      c.body_a = a.body;
      c.inverse_mass_a = 1.0 / bodies[static_cast<size_t>(a.body)].mass;
    }
    if (b != nullptr && is_awake(*b, bodies)) {
      c.body_b = b->body;
      c.inverse_mass_b = 1.0 / bodies[static_cast<size_t>(b->body)].mass;
    }
    c.n = n;
    c.p = 0.5 * (on_a + on_b);
    c.gap = gap;
    c.friction = pair.friction;
    c.patch = b == nullptr ? a.patch : std::max(a.patch, b->patch);
    c.torsion = c.patch > 0;
    tangents(&c);
    c.normal.impulse = point.normal_impulse;
    c.tangent1.impulse = c.t1.dot(point.friction_impulse);
    c.tangent2.impulse = c.t2.dot(point.friction_impulse);
    c.twist.impulse = point.torsion_impulse;
  }
}

}  // namespace

void make_pairs(const std::vector<Collider>& colliders, std::size_t links, std::size_t bodies,
                const std::vector<LinkPair>& link_pairs, const Plane& plane, PairTable* table) {
  const auto add = [&](size_t a, int b) {
    ColliderPair pair;
    pair.a = static_cast<int>(a);
    pair.b = b;
    pair.first = table->pairs.empty() ? 0 : table->pairs.back().first + table->pairs.back().count;
    const size_t parts_a = colliders[a].shape->parts.size();
    const size_t parts_b = b < 0 ? 1 : colliders[static_cast<size_t>(b)].shape->parts.size();
    pair.count = static_cast<std::uint32_t>(b < 0 ? 1 : parts_a * parts_b);
    const double other = b < 0 ? plane.friction : colliders[static_cast<size_t>(b)].friction;
    pair.friction = 0.5 * (colliders[a].friction + other);
    table->pairs.push_back(pair);
  };
  // The arm's base stands on the surface; only links that move may hit it.
  for (size_t l = 0; l < links; ++l) {
    if (colliders[l].path != 0) add(l, -1);
  }
  const size_t movers = links + bodies;
  for (size_t b = links; b < movers; ++b) {
    add(b, -1);
    for (size_t l = 0; l < links; ++l) add(l, static_cast<int>(b));
  }
  for (size_t a = links; a < movers; ++a) {
    for (size_t b = a + 1; b < movers; ++b) add(a, static_cast<int>(b));
  }
  for (size_t a = 0; a < movers; ++a) {
    if (colliders[a].body < 0 && colliders[a].path == 0) continue;
    for (size_t f = movers; f < colliders.size(); ++f) add(a, static_cast<int>(f));
  }
  for (const LinkPair& pair : link_pairs) add(static_cast<size_t>(pair.a), pair.b);
  if (!table->pairs.empty())
    table->records.resize(table->pairs.back().first + table->pairs.back().count);
}

void place_links(const ArmDynamics& arm, const JointArray& u, std::size_t links,
                 std::vector<Collider>* colliders) {
  // Of each moving link: angular velocity, and the velocity of its point at the arm's reference.
  std::array<Vec3, kMaxJoints> spins, speeds;
  for (const int k : arm.outward()) {
    const MovingLink& link = arm.link(k);
    const int parent = arm.parent(k);
    const double rate = u[static_cast<size_t>(link.coordinate)];
    Vec3& spin = spins[static_cast<size_t>(k)];
    Vec3& speed = speeds[static_cast<size_t>(k)];
    spin = rate * link.w;
    speed = rate * link.v;
    if (parent < 0) continue;
    spin += spins[static_cast<size_t>(parent)];
    speed += speeds[static_cast<size_t>(parent)];
  }
  for (size_t l = 0; l < links; ++l) {
    Collider& c = (*colliders)[l];
    if (c.moving_link < 0) continue;
    const MovingLink& carrier = arm.link(c.moving_link);
    const Vec3& spin = spins[static_cast<size_t>(c.moving_link)];
    c.axes = carrier.axes * c.carrier_axes;
    c.position = carrier.axes * c.carrier_offset + carrier.origin;
    const Vec3 speed =
        speeds[static_cast<size_t>(c.moving_link)] + spin.cross(c.position - arm.reference());
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

bool is_touching(const Collider& a, const Collider& b, Candidates* scratch) {
  const RelativePose pose{a.axes.transpose() * b.axes,
                          a.axes.transpose() * (b.position - a.position)};
  for (size_t i = 0; i < a.shape->parts.size(); ++i) {
    for (size_t k = 0; k < b.shape->parts.size(); ++k) {
      if (!overlaps(a.part_boxes[i], b.part_boxes[k], 0)) continue;
      collide_parts(a.shape->parts[i], b.shape->parts[k], pose, 0, nullptr, scratch);
      if (scratch->count > 0) return true;
    }
  }
  return false;
}

double pair_margin(const Parameters& parameters, const Collider& a, const Collider* b) {
  const double speed = a.reach_speed + (b == nullptr ? 0.0 : b->reach_speed);
  return std::max(parameters.margin, 1.5 * parameters.dt * speed);
}

namespace {

// What one substep's search needs; one pair of parts or one collider on the plane at a time.
struct Search {
  const Parameters& parameters;
  const Plane& plane;
  std::uint64_t substep;
  const std::vector<Collider>& colliders;
  PairTable* table;
  Problem* problem;

  void on_plane(const ColliderPair& pair, const Collider& a, double margin) {
    if (a.box.center.z() - a.box.half.z() > plane.height + margin) return;
    PairRecord& record = table->records[pair.first];
    const RelativePose pose{a.axes, a.position};
    if (a.rounded ||
        !can_reuse(record, substep, pose, a.shape->bounding_radius, parameters.reuse)) {
      collide_plane(a, plane.height, margin, &table->scratch);
      reduce(&table->scratch, true);
      renew(&record, substep, pose, table->scratch, true, parameters.match);
    }
    emit(pair, pair.first, margin, plane, substep, colliders, table, problem);
  }

  void parts(const ColliderPair& pair, const Collider& a, const Collider& b,
             const RelativePose& pose, double margin, size_t i, size_t k) {
    if (!overlaps(a.part_boxes[i], b.part_boxes[k], margin)) return;
    const std::uint32_t index =
        pair.first + static_cast<std::uint32_t>(i * b.shape->parts.size() + k);
    PairRecord& record = table->records[index];
    const double radius = std::min(a.shape->bounding_radius, b.shape->bounding_radius);
    const scene::ConvexPart& part_a = a.shape->parts[i];
    const scene::ConvexPart& part_b = b.shape->parts[k];
    const bool rolls = part_a.round > 0 || part_b.round > 0;
    if (rolls || !can_reuse(record, substep, pose, radius, parameters.reuse)) {
      collide_parts(part_a, part_b, pose, margin, &record.cached, &table->scratch);
      if (table->scratch.count == 0) {
        record.valid = false;
        return;
      }
      reduce(&table->scratch, false);
      renew(&record, substep, pose, table->scratch, false, parameters.match);
    }
    emit(pair, index, margin, plane, substep, colliders, table, problem);
  }

  void pair_of(const ColliderPair& pair, const Collider& a, const Collider& b, double margin) {
    if (!overlaps(a.box, b.box, margin)) return;
    const RelativePose pose{a.axes.transpose() * b.axes,
                            a.axes.transpose() * (b.position - a.position)};
    for (size_t i = 0; i < a.shape->parts.size(); ++i) {
      const Box& box = a.part_boxes[i];
      if (!overlaps(box, b.box, margin)) continue;
      if (b.sorted_parts.empty()) {
        for (size_t k = 0; k < b.shape->parts.size(); ++k) parts(pair, a, b, pose, margin, i, k);
        continue;
      }
      // Boxes sorted along x: from the first that may still reach this one to the last that begins
      // before its end.
      const double from = box.center.x() - box.half.x() - margin - b.longest_part;
      const double to = box.center.x() + box.half.x() + margin;
      const auto low = [&](std::uint32_t k) {
        return b.part_boxes[k].center.x() - b.part_boxes[k].half.x();
      };
      auto k = std::partition_point(b.sorted_parts.begin(), b.sorted_parts.end(),
                                    [&](std::uint32_t part) { return low(part) < from; });
      for (; k != b.sorted_parts.end() && low(*k) <= to; ++k) {
        parts(pair, a, b, pose, margin, i, *k);
      }
    }
  }
};

}  // namespace

void find_contacts(const Parameters& parameters, const Plane& plane, std::uint64_t substep,
                   const std::vector<Collider>& colliders, PairTable* table, Problem* problem) {
  problem->contacts.clear();
  const std::vector<Body>& bodies = *problem->bodies;
  Search search{parameters, plane, substep, colliders, table, problem};
  for (const ColliderPair& pair : table->pairs) {
    const Collider& a = colliders[static_cast<size_t>(pair.a)];
    const Collider* b = pair.b < 0 ? nullptr : &colliders[static_cast<size_t>(pair.b)];
    if (!may_move(a, bodies) && (b == nullptr || !may_move(*b, bodies))) continue;
    const double margin = pair_margin(parameters, a, b);
    if (b == nullptr) {
      search.on_plane(pair, a, margin);
    } else {
      search.pair_of(pair, a, *b, margin);
    }
  }
}

void store_impulses(const Problem& problem, PairTable* table) {
  for (const Contact& c : problem.contacts) {
    PairRecord& record = table->records[c.record];
    ManifoldPoint& point = record.points[static_cast<size_t>(c.point)];
    point.normal_impulse = c.normal.impulse;
    point.torsion_impulse = c.torsion ? c.twist.impulse : 0.0;
    point.friction_impulse = c.tangent1.impulse * c.t1 + c.tangent2.impulse * c.t2;
    const Vec3 impulse = c.normal.impulse * c.n + point.friction_impulse;
    record.impulse += impulse;
    table->pairs[c.pair].sum += impulse;
  }
}

void begin_sums(std::uint64_t substep, PairTable* table) {
  table->step_begin = substep;
  for (ColliderPair& pair : table->pairs) pair.sum = Vec3::Zero();
}

void add_frozen(const PairRecord& record, std::uint64_t substep, ColliderPair* pair,
                const PairTable& table) {
  const std::uint64_t from = std::max(record.frozen_from, table.step_begin);
  if (substep > from) pair->sum += static_cast<double>(substep - from) * record.impulse;
}

void drop_records(int collider, PairTable* table) {
  for (const ColliderPair& pair : table->pairs) {
    if (pair.a != collider && pair.b != collider) continue;
    for (std::uint32_t r = pair.first; r < pair.first + pair.count; ++r) {
      table->records[r].valid = false;
      table->records[r].frozen = false;
    }
  }
}

}  // namespace probe::world
