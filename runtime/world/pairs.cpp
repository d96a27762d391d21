#include "runtime/world/pairs.h"

#include <algorithm>
#include <cmath>

#include "runtime/world/manifold.h"

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

// Emits the record's points that are nearer than the margin; the others lose their impulses.
void emit(const ColliderPair& pair, std::uint32_t index, double margin, const Plane& plane,
          std::uint64_t substep, const std::vector<Collider>& colliders, PairTable* table,
          Problem* problem) {
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
    c.point = static_cast<std::int8_t>(k);
    c.links = a.path != 0;
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
    c.patch = a.patch;
    c.torsion = a.patch > 0;
    tangents(&c);
    c.normal.impulse = point.normal_impulse;
    c.tangent1.impulse = c.t1.dot(point.friction_impulse);
    c.tangent2.impulse = c.t2.dot(point.friction_impulse);
    c.twist.impulse = point.torsion_impulse;
  }
}

}  // namespace

void make_pairs(const std::vector<Collider>& colliders, std::size_t links, const Plane& plane,
                PairTable* table) {
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
  for (size_t b = links; b < colliders.size(); ++b) {
    add(b, -1);
    for (size_t l = 0; l < links; ++l) add(l, static_cast<int>(b));
  }
  for (size_t a = links; a < colliders.size(); ++a) {
    for (size_t b = a + 1; b < colliders.size(); ++b) add(a, static_cast<int>(b));
  }
  if (!table->pairs.empty())
    table->records.resize(table->pairs.back().first + table->pairs.back().count);
}

void place_links(const ArmDynamics& arm, const JointArray& u, std::size_t links,
                 std::vector<Collider>* colliders) {
  for (size_t l = 0; l < links; ++l) {
    Collider& c = (*colliders)[l];
    if (c.moving_link < 0) continue;
    const MovingLink& carrier = arm.link(c.moving_link);
    c.axes = carrier.axes * c.in_carrier.rotation.toRotationMatrix();
    c.position = carrier.axes * c.in_carrier.position + carrier.origin;
    Vec3 speed = Vec3::Zero(), spin = Vec3::Zero();
    for (int j = 0; j < arm.count(); ++j) {
      if ((c.path >> j & 1U) == 0) continue;
      const MovingLink& link = arm.link(j);
      const double rate = u[static_cast<size_t>(j)];
      speed += rate * (link.h + link.w.cross(c.position - link.origin));
      spin += rate * link.w;
    }
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

double pair_margin(const Parameters& parameters, const Collider& a, const Collider* b) {
  const double speed = a.reach_speed + (b == nullptr ? 0.0 : b->reach_speed);
  return std::max(parameters.margin, 1.5 * parameters.dt * speed);
}

void find_contacts(const Parameters& parameters, const Plane& plane, std::uint64_t substep,
                   const std::vector<Collider>& colliders, PairTable* table, Problem* problem) {
  problem->contacts.clear();
  const std::vector<Body>& bodies = *problem->bodies;
  for (const ColliderPair& pair : table->pairs) {
    const Collider& a = colliders[static_cast<size_t>(pair.a)];
    const Collider* b = pair.b < 0 ? nullptr : &colliders[static_cast<size_t>(pair.b)];
    if (a.path == 0 && !is_awake(a, bodies) && (b == nullptr || !is_awake(*b, bodies))) continue;
    const double margin = pair_margin(parameters, a, b);
    if (b == nullptr) {
      if (a.box.center.z() - a.box.half.z() > plane.height + margin) continue;
      PairRecord& record = table->records[pair.first];
      const RelativePose pose{a.axes, a.position};
      if (!can_reuse(record, substep, pose, a.shape->bounding_radius, parameters.reuse)) {
        collide_plane(a, plane.height, margin, &table->scratch);
        reduce(&table->scratch, true);
        renew(&record, substep, pose, table->scratch, true, parameters.match);
      }
      emit(pair, pair.first, margin, plane, substep, colliders, table, problem);
      continue;
    }
    if (!overlaps(a.box, b->box, margin)) continue;
    const RelativePose pose{a.axes.transpose() * b->axes,
                            a.axes.transpose() * (b->position - a.position)};
    const double radius = std::min(a.shape->bounding_radius, b->shape->bounding_radius);
    const size_t parts_b = b->shape->parts.size();
    for (size_t i = 0; i < a.shape->parts.size(); ++i) {
      if (!overlaps(a.part_boxes[i], b->box, margin)) continue;
      for (size_t k = 0; k < parts_b; ++k) {
        if (!overlaps(a.part_boxes[i], b->part_boxes[k], margin)) continue;
        const std::uint32_t index = pair.first + static_cast<std::uint32_t>(i * parts_b + k);
        PairRecord& record = table->records[index];
        if (!can_reuse(record, substep, pose, radius, parameters.reuse)) {
          collide_hulls(a.shape->parts[i], b->shape->parts[k], pose, margin, &record.cached,
                        &table->scratch);
          if (table->scratch.count == 0) {
            record.valid = false;
            continue;
          }
          reduce(&table->scratch, false);
          renew(&record, substep, pose, table->scratch, false, parameters.match);
        }
        emit(pair, index, margin, plane, substep, colliders, table, problem);
      }
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
    record.impulse += c.normal.impulse * c.n + point.friction_impulse;
  }
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
