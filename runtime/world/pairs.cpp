#include "runtime/world/pairs.h"

#include <algorithm>
#include <cmath>

#include "runtime/world/manifold.h"
#include "runtime/world/round_contact.h"

namespace probe::world {
namespace {

using std::size_t;

void tangents(Contact* c) {
  const Vec3 axis = std::fabs(c->n.x()) < 0.57 ? Vec3::UnitX() : Vec3::UnitY();
  c->t1 = c->n.cross(axis);
  c->t1 /= c->t1.norm();
  c->t2 = c->n.cross(c->t1);
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

// What one substep's search needs; one pair of parts or one collider on the plane at a time.
struct Search {
  const Parameters& parameters;
  const Plane& plane;
  std::uint64_t substep;
  const std::vector<Articulation>& articulations;
  const std::vector<Collider>& colliders;
  PairTable* table;
  Candidates* scratch;
  Problem* problem;

  bool moves(const Collider& c) const { return may_move(c, articulations, *problem->bodies); }
  bool is_led(const Collider& c) const {
    return c.body >= 0 && (*problem->bodies)[static_cast<size_t>(c.body)].led;
  }
  // Whether contacts can change how it moves.
  bool gives_way(const Collider& c) const { return moves(c) && !is_led(c); }

  // Index of the record of parts whose boxes meet.
  std::uint32_t near_record(ColliderPair* pair, std::uint32_t key) {
    const std::uint32_t index = table->find_or_add(pair, key);
    table->record(index).near = substep;
    return index;
  }

  void on_plane(ColliderPair* pair, const Collider& a, double margin) {
    if (a.box.center.z() - a.box.half.z() > plane.height + margin) return;
    const std::uint32_t index = near_record(pair, 0);
    PairRecord& record = table->record(index);
    const RelativePose pose{a.axes, a.position};
    if (a.rounded ||
        !can_reuse(record, substep, pose, a.shape->bounding_radius, parameters.reuse)) {
      collide_plane(a, plane.height, margin, scratch);
      reduce(scratch, true);
      renew(&record, substep, pose, *scratch, true, parameters.match);
    }
    emit(*pair, index, margin);
  }

  void parts(ColliderPair* pair, const Collider& a, const Collider& b, const RelativePose& pose,
             double margin, size_t i, size_t k) {
    if (!overlaps(a.part_boxes[i], b.part_boxes[k], margin)) return;
    const std::uint32_t index =
        near_record(pair, static_cast<std::uint32_t>(i * b.shape->parts.size() + k));
    PairRecord& record = table->record(index);
    const double radius = std::min(a.shape->bounding_radius, b.shape->bounding_radius);
    const scene::ConvexPart& part_a = a.shape->parts[i];
    const scene::ConvexPart& part_b = b.shape->parts[k];
    const bool rolls = part_a.round > 0 || part_b.round > 0;
    if (rolls || !can_reuse(record, substep, pose, radius, parameters.reuse)) {
      collide_parts(part_a, part_b, pose, margin, &record.cached, scratch);
      if (scratch->count == 0) {
        record.valid = false;
        return;
      }
      reduce(scratch, false);
      renew(&record, substep, pose, *scratch, false, parameters.match);
    }
    emit(*pair, index, margin);
  }

  void pair_of(ColliderPair* pair, const Collider& a, const Collider& b, double margin) {
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

  // Makes contacts of the record's points that are nearer than the margin; the others lose their
  // impulses.
  void emit(const ColliderPair& pair, std::uint32_t index, double margin) {
    PairRecord& record = table->record(index);
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
      c.pair = static_cast<std::uint32_t>(&pair - table->pairs.data());
      c.point = static_cast<std::int8_t>(k);
      c.collider_a = pair.a;
      c.collider_b = pair.b;
      c.n = n;
      c.p = 0.5 * (on_a + on_b);
      c.gap = gap;
      tangents(&c);
      take_sides(a, b, &c);
      ContactRows& rows = problem->rows.emplace_back();
      take_bodies(a, b, &rows);
      rows.friction = pair.friction;
      rows.patch = b == nullptr ? a.patch : std::max(a.patch, b->patch);
      rows.torsion = rows.patch > 0;
      rows.give = (a.give + (b == nullptr ? 0 : b->give)) / (parameters.dt * parameters.dt);
      rows.rows[kNormal].impulse = point.normal_impulse;
      rows.rows[kTangent1].impulse = c.t1.dot(point.friction_impulse);
      rows.rows[kTangent2].impulse = c.t2.dot(point.friction_impulse);
      rows.rows[kTwist].impulse = point.torsion_impulse;
    }
  }

  // What carries both links of a tree moves neither against the other.
  void take_sides(const Collider& a, const Collider* b, Contact* c) const {
    const std::uint32_t path_a = a.body < 0 && moves(a) ? a.path : 0;
    const std::uint32_t path_b = b != nullptr && b->body < 0 && moves(*b) ? b->path : 0;
    const bool same = b != nullptr && a.articulation == b->articulation;
    c->path_a = same ? path_a & ~path_b : path_a;
    c->path_b = same ? path_b & ~path_a : path_b;
  }

  void take_bodies(const Collider& a, const Collider* b, ContactRows* rows) const {
    const std::vector<Body>& bodies = *problem->bodies;
    const auto inverse_mass = [&](const Collider& c) {
      const Body& body = bodies[static_cast<size_t>(c.body)];
      return is_led(c) ? 0.0 : 1.0 / (body.mass + body.drag);
    };
    if (a.body >= 0 && moves(a)) {
      rows->body_a = a.body;
      rows->inverse_mass_a = inverse_mass(a);
    }
    if (b != nullptr && b->body >= 0 && moves(*b)) {
      rows->body_b = b->body;
      rows->inverse_mass_b = inverse_mass(*b);
    }
  }
};

}  // namespace

void make_pairs(const std::vector<Collider>& colliders, std::size_t links, std::size_t bodies,
                const std::vector<LinkPair>& link_pairs, const Plane& plane, PairTable* table) {
  const auto add = [&](size_t a, int b) {
    ColliderPair pair;
    pair.a = static_cast<int>(a);
    pair.b = b;
    const size_t parts_a = colliders[a].shape->parts.size();
    const size_t parts_b = b < 0 ? 1 : colliders[static_cast<size_t>(b)].shape->parts.size();
    pair.keys = static_cast<std::uint32_t>(b < 0 ? 1 : parts_a * parts_b);
    const double other = b < 0 ? plane.friction : colliders[static_cast<size_t>(b)].friction;
    pair.friction = 0.5 * (colliders[a].friction + other);
    table->pairs.push_back(std::move(pair));
  };
  // A base stands on the surface; only links that move may hit it.
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

void find_contacts(const Parameters& parameters, const Plane& plane, std::uint64_t substep,
                   const std::vector<Articulation>& articulations,
                   const std::vector<Collider>& colliders, PairTable* table, Candidates* scratch,
                   Problem* problem) {
  problem->contacts.clear();
  problem->rows.clear();
  Search search{parameters, plane, substep, articulations, colliders, table, scratch, problem};
  for (ColliderPair& pair : table->pairs) {
    const Collider& a = colliders[static_cast<size_t>(pair.a)];
    const Collider* b = pair.b < 0 ? nullptr : &colliders[static_cast<size_t>(pair.b)];
    if (!search.gives_way(a) && (b == nullptr || !search.gives_way(*b))) continue;
    const double margin = pair_margin(parameters, a, b);
    if (b == nullptr) {
      search.on_plane(&pair, a, margin);
    } else {
      search.pair_of(&pair, a, *b, margin);
    }
    if (!pair.near.empty()) table->forget_apart(&pair, substep);
  }
}

void store_impulses(const Problem& problem, PairTable* table) {
  for (size_t index = 0; index < problem.contacts.size(); ++index) {
    const Contact& c = problem.contacts[index];
    const ContactRows& rows = problem.rows[index];
    PairRecord& record = table->record(c.record);
    ManifoldPoint& point = record.points[static_cast<size_t>(c.point)];
    point.normal_impulse = rows.rows[kNormal].impulse;
    point.torsion_impulse = rows.torsion ? rows.rows[kTwist].impulse : 0.0;
    point.friction_impulse =
        rows.rows[kTangent1].impulse * c.t1 + rows.rows[kTangent2].impulse * c.t2;
    const Vec3 impulse = rows.rows[kNormal].impulse * c.n + point.friction_impulse;
    record.impulse += impulse;
    table->pairs[c.pair].sum += impulse;
  }
}

void begin_sums(std::uint64_t substep, PairTable* table) {
  table->step_begin = substep;
  for (ColliderPair& pair : table->pairs) pair.sum = Vec3::Zero();
}

void add_frozen(const PairRecord& record, std::uint64_t substep, const PairTable& table,
                ColliderPair* pair) {
  const std::uint64_t from = std::max(record.frozen_from, table.step_begin);
  if (substep > from) pair->sum += static_cast<double>(substep - from) * record.impulse;
}

void drop_records(int collider, PairTable* table) {
  for (ColliderPair& pair : table->pairs) {
    if (pair.a == collider || pair.b == collider) table->clear(&pair);
  }
}

}  // namespace probe::world
