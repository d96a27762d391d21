#include "runtime/world/sleep.h"

namespace probe::world {
namespace {

using std::size_t;

constexpr double kQuietSpeed = 1e-3;  // m/s
constexpr double kQuietSpin = 1e-2;   // rad/s
constexpr int kQuietSubsteps = 200;

bool is_touched(const Parameters& parameters, size_t body, const Sleepers& s) {
  const Collider& self = (*s.colliders)[s.links + body];
  // Fixtures stand still and wake nothing.
  for (size_t i = 0; i < s.links + s.bodies->size(); ++i) {
    const Collider& other = (*s.colliders)[i];
    if (i < s.links) {
      if (other.path == 0) continue;
    } else {
      const Body& mover = (*s.bodies)[i - s.links];
      if (i - s.links == body || mover.asleep || mover.calm != 0) continue;
    }
    if (overlaps(other.box, self.box, pair_margin(parameters, other, &self))) return true;
  }
  return false;
}

// Records among sleeping bodies, the plane and the base are frozen.
void freeze(const Problem& problem, std::uint64_t substep, Sleepers* s) {
  const auto rests = [&](int collider) {
    if (collider < 0) return true;
    const Collider& c = (*s->colliders)[static_cast<size_t>(collider)];
    return c.body < 0 ? c.path == 0 : (*s->bodies)[static_cast<size_t>(c.body)].asleep;
  };
  for (const Contact& c : problem.contacts) {
    PairRecord& record = s->table->records[c.record];
    if (record.frozen || !rests(c.collider_a) || !rests(c.collider_b)) continue;
    record.frozen = true;
    record.frozen_from = substep + 1;
  }
}

}  // namespace

void wake(size_t body, std::uint64_t substep, Sleepers* s) {
  Body& b = (*s->bodies)[body];
  b.calm = 0;
  if (!b.asleep) return;
  b.asleep = false;
  const int collider = static_cast<int>(s->links + body);
  for (ColliderPair& pair : s->table->pairs) {
    if (pair.a != collider && pair.b != collider) continue;
    for (std::uint32_t r = pair.first; r < pair.first + pair.count; ++r) {
      PairRecord& record = s->table->records[r];
      if (!record.frozen) continue;
      add_frozen(record, substep, &pair, *s->table);
      record.frozen = false;
      record.last = substep - 1;
    }
  }
}

void wake_touched(const Parameters& parameters, std::uint64_t substep, Sleepers* s) {
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t b = 0; b < s->bodies->size(); ++b) {
      if (!(*s->bodies)[b].asleep || !is_touched(parameters, b, *s)) continue;
      wake(b, substep, s);
      changed = true;
    }
  }
}

void fall_asleep(const Problem& problem, std::uint64_t substep, Sleepers* s) {
  bool candidate = false;
  for (Body& b : *s->bodies) {
    if (b.asleep) continue;
    const bool quiet = b.velocity.squaredNorm() < kQuietSpeed * kQuietSpeed &&
                       b.spin.squaredNorm() < kQuietSpin * kQuietSpin;
    b.calm = quiet ? b.calm + 1 : 0;
    candidate = candidate || b.calm >= kQuietSubsteps;
  }
  if (!candidate) return;
  bool slept = false;
  for (size_t i = 0; i < s->bodies->size(); ++i) {
    Body& b = (*s->bodies)[i];
    if (b.asleep || b.calm < kQuietSubsteps) continue;
    const int self = static_cast<int>(s->links + i);
    bool may = true;
    for (const Contact& c : problem.contacts) {
      if (c.collider_a != self && c.collider_b != self) continue;
      const int other = c.collider_a == self ? c.collider_b : c.collider_a;
      if (other < 0) continue;
      const Collider& o = (*s->colliders)[static_cast<size_t>(other)];
      if (o.body < 0) {
        may = may && o.path == 0;
      } else {
        const Body& neighbour = (*s->bodies)[static_cast<size_t>(o.body)];
        may = may && (neighbour.asleep || neighbour.calm >= kQuietSubsteps);
      }
      if (!may) break;
    }
    if (!may) continue;
    b.asleep = true;
    b.velocity = b.spin = Vec3::Zero();
    place_body(b, &(*s->colliders)[static_cast<size_t>(self)]);
    slept = true;
  }
  if (slept) freeze(problem, substep, s);
}

}  // namespace probe::world
