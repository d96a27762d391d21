#include "runtime/world/sleep.h"

#include <cmath>

#include "runtime/world/colliders.h"

namespace probe::world {
namespace {

using std::size_t;

// A hundred times the tolerance of the sweeps, a twentieth of what gravity adds in 2 ms.
constexpr double kQuietSpeed = 1e-3;  // m/s
constexpr double kQuietSpin = 1e-2;   // rad/s
constexpr int kQuietSubsteps = 200;   // 0.4 s at 500 Hz: two control steps

size_t at(int index) { return static_cast<size_t>(index); }

// Whether a collider may wake what it comes near: links of a robot always, what sleeps may only
// once it has been restless. Fixtures and bases stand still and wake nothing.
bool is_restless(const Collider& c, const Sleepers& s) {
  if (c.body >= 0) {
    const Body& body = (*s.bodies)[at(c.body)];
    return !body.asleep && body.calm == 0;
  }
  if (c.path == 0) return false;
  const Articulation& of = (*s.articulations)[at(c.articulation)];
  return of.driven || (!of.asleep && of.calm == 0);
}

// Whether a collider stands still for now: fixtures, bases, and what sleeps.
bool rests(int collider, const Sleepers& s) {
  if (collider < 0) return true;
  return !may_move((*s.colliders)[at(collider)], *s.articulations, *s.bodies);
}

// The same, or it has been quiet long enough to sleep itself.
bool is_calm(int collider, const Sleepers& s) {
  if (rests(collider, s)) return true;
  const Collider& c = (*s.colliders)[at(collider)];
  if (c.body >= 0) return (*s.bodies)[at(c.body)].calm >= kQuietSubsteps;
  const Articulation& of = (*s.articulations)[at(c.articulation)];
  return !of.driven && of.calm >= kQuietSubsteps;
}

bool is_touched(const Parameters& parameters, const Collider& self, const Sleepers& s) {
  for (size_t i = 0; i < s.links + s.bodies->size(); ++i) {
    const Collider& other = (*s.colliders)[i];
    const bool own = self.body >= 0 ? other.body == self.body
                                    : other.body < 0 && other.articulation == self.articulation;
    if (own || !is_restless(other, s)) continue;
    if (overlaps(other.box, self.box, pair_margin(parameters, other, &self))) return true;
  }
  return false;
}

bool is_touched(const Parameters& parameters, const Articulation& articulation, const Sleepers& s) {
  for (size_t l = 0; l < articulation.links; ++l) {
    const Collider& self = (*s.colliders)[articulation.first_link + l];
    if (self.path != 0 && is_touched(parameters, self, s)) return true;
  }
  return false;
}

// Records among what rests are frozen.
void freeze(const Problem& problem, std::uint64_t substep, Sleepers* s) {
  for (const Contact& c : problem.contacts) {
    PairRecord& record = s->table->record(c.record);
    if (record.frozen || !rests(c.collider_a, *s) || !rests(c.collider_b, *s)) continue;
    record.frozen = true;
    record.frozen_from = substep + 1;
  }
}

void thaw(int collider, std::uint64_t substep, Sleepers* s) {
  for (ColliderPair& pair : s->table->pairs) {
    if (pair.a != collider && pair.b != collider) continue;
    for (const ColliderPair::Entry& entry : pair.near) {
      PairRecord& record = s->table->record(entry.record);
      if (!record.frozen) continue;
      add_frozen(record, substep, *s->table, &pair);
      record.frozen = false;
      record.last = substep - 1;
    }
  }
}

bool is_quiet(const Body& b) {
  return b.velocity.squaredNorm() < kQuietSpeed * kQuietSpeed &&
         b.spin.squaredNorm() < kQuietSpin * kQuietSpin;
}

bool is_quiet(const JointRange& range, const Drives& drives, const Joints& joints) {
  for (size_t i = at(range.first); i < at(range.first + range.count); ++i) {
    if (!(std::fabs(joints.u[i]) < (drives.prismatic[i] ? kQuietSpeed : kQuietSpin))) return false;
  }
  return true;
}

// Nothing that touches it keeps it awake. `own` tells its colliders.
template <typename Own>
bool may_sleep(const Problem& problem, const Sleepers& s, Own own) {
  for (const Contact& c : problem.contacts) {
    if (own(c.collider_a) && !own(c.collider_b) && !is_calm(c.collider_b, s)) return false;
    if (own(c.collider_b) && !own(c.collider_a) && !is_calm(c.collider_a, s)) return false;
  }
  return true;
}

}  // namespace

void wake_body(size_t body, std::uint64_t substep, Sleepers* s) {
  Body& b = (*s->bodies)[body];
  b.calm = 0;
  if (!b.asleep) return;
  b.asleep = false;
  thaw(static_cast<int>(s->links + body), substep, s);
}

void wake_articulation(size_t articulation, std::uint64_t substep, Sleepers* s) {
  Articulation& a = (*s->articulations)[articulation];
  a.calm = 0;
  if (!a.asleep) return;
  a.asleep = false;
  for (size_t l = a.first_link; l < a.first_link + a.links; ++l) {
    if ((*s->colliders)[l].path != 0) thaw(static_cast<int>(l), substep, s);
  }
}

void wake_touched(const Parameters& parameters, std::uint64_t substep, Sleepers* s) {
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t b = 0; b < s->bodies->size(); ++b) {
      if (!(*s->bodies)[b].asleep || !is_touched(parameters, (*s->colliders)[s->links + b], *s)) {
        continue;
      }
      wake_body(b, substep, s);
      changed = true;
    }
    for (size_t a = 0; a < s->articulations->size(); ++a) {
      const Articulation& sleeper = (*s->articulations)[a];
      if (!sleeper.asleep || !is_touched(parameters, sleeper, *s)) continue;
      wake_articulation(a, substep, s);
      changed = true;
    }
  }
}

void fall_asleep(const Problem& problem, const Drives& drives, std::uint64_t substep,
                 Joints* joints, Sleepers* s) {
  bool candidate = false;
  for (Body& b : *s->bodies) {
    if (b.asleep || b.led) continue;
    b.calm = is_quiet(b) ? b.calm + 1 : 0;
    candidate = candidate || b.calm >= kQuietSubsteps;
  }
  for (Articulation& a : *s->articulations) {
    if (a.driven || a.asleep) continue;
    a.calm = is_quiet(a.range, drives, *joints) ? a.calm + 1 : 0;
    candidate = candidate || a.calm >= kQuietSubsteps;
  }
  if (!candidate) return;
  bool slept = false;
  for (size_t i = 0; i < s->bodies->size(); ++i) {
    Body& b = (*s->bodies)[i];
    if (b.asleep || b.calm < kQuietSubsteps) continue;
    const int self = static_cast<int>(s->links + i);
    if (!may_sleep(problem, *s, [&](int collider) { return collider == self; })) continue;
    b.asleep = true;
    b.velocity = b.spin = Vec3::Zero();
    place_body(b, &(*s->colliders)[at(self)]);
    slept = true;
  }
  for (size_t i = 0; i < s->articulations->size(); ++i) {
    Articulation& a = (*s->articulations)[i];
    if (a.driven || a.asleep || a.calm < kQuietSubsteps) continue;
    const auto own = [&](int collider) {
      return collider >= 0 && (*s->colliders)[at(collider)].articulation == static_cast<int>(i);
    };
    if (!may_sleep(problem, *s, own)) continue;
    a.asleep = true;
    for (int j = a.range.first; j < a.range.first + a.range.count; ++j) joints->u[at(j)] = 0;
    a.tree->update(joints->q);
    place_links(a, joints->u, s->colliders);
    slept = true;
  }
  if (slept) freeze(problem, substep, s);
}

}  // namespace probe::world
