#include "runtime/world/rows.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "runtime/world/lanes.h"

namespace probe::world {
namespace {

constexpr double kRegular = 1e-9;
constexpr int kHeldRounds = 4;          // of sweeps between renewals of friction's bounds
constexpr double kRevoluteLever = 0.2;  // m, makes rad/s of a limit comparable to m/s

// The bodies of a contact; absent ones are never touched.
struct Sides {
  Body* a;
  Body* b;
};

Sides sides(const Contact& c, std::vector<Body>* bodies) {
  return {c.body_a < 0 ? nullptr : &(*bodies)[static_cast<std::size_t>(c.body_a)],
          c.body_b < 0 ? nullptr : &(*bodies)[static_cast<std::size_t>(c.body_b)]};
}

template <typename Lanes>
inline double row_speed(const Row& row, const Sides& s, const double* u, Lanes lanes) {
  double v = row.j != nullptr ? dot_joints(row.j, u, lanes) : 0.0;
  if (s.a != nullptr) v += row.d.dot(s.a->velocity) + row.arm_a.dot(s.a->spin);
  if (s.b != nullptr) v -= row.d.dot(s.b->velocity) + row.arm_b.dot(s.b->spin);
  return v;
}

template <typename Lanes>
inline void push(const Row& row, const Contact& c, const Sides& s, double impulse, double* u,
                 Lanes lanes) {
  if (row.wj != nullptr) add_scaled(u, row.wj, impulse, lanes);
  if (s.a != nullptr) {
    s.a->velocity += (impulse * c.inverse_mass_a) * row.d;
    s.a->spin += impulse * row.ka;
  }
  if (s.b != nullptr) {
    s.b->velocity -= (impulse * c.inverse_mass_b) * row.d;
    s.b->spin -= impulse * row.kb;
  }
}

// Bodies' part of a row along d at the contact point.
void build_linear(Row* row, const Contact& c, const Sides& s, const Vec3& d) {
  row->d = d;
  row->body_k = kRegular;
  if (s.a != nullptr) {
    row->arm_a = (c.p - s.a->position).cross(d);
    row->ka = s.a->response * row->arm_a;
    row->body_k += c.inverse_mass_a + row->arm_a.dot(row->ka);
  }
  if (s.b != nullptr) {
    row->arm_b = (c.p - s.b->position).cross(d);
    row->kb = s.b->response * row->arm_b;
    row->body_k += c.inverse_mass_b + row->arm_b.dot(row->kb);
  }
}

// Torsion: angular only, so the linear direction is zero.
void build_twist(Row* row, const Contact& c, const Sides& s) {
  row->d = Vec3::Zero();
  row->body_k = kRegular;
  if (s.a != nullptr) {
    row->arm_a = c.n;
    row->ka = s.a->response * c.n;
    row->body_k += c.n.dot(row->ka);
  }
  if (s.b != nullptr) {
    row->arm_b = c.n;
    row->kb = s.b->response * c.n;
    row->body_k += c.n.dot(row->kb);
  }
}

// Adds the columns of the moving links in `path`, times sign.
void add_columns(const ArmDynamics& arm, std::uint32_t path, double sign, Contact* c) {
  const Vec3 r = c->p - arm.reference();
  for (; path != 0; path &= path - 1) {
    const MovingLink& link = arm.link(std::countr_zero(path));
    const std::size_t i = static_cast<std::size_t>(link.coordinate);
    const Vec3 at_point = sign * (link.v + link.w.cross(r));
    c->normal.j[i] += c->n.dot(at_point);
    c->tangent1.j[i] += c->t1.dot(at_point);
    c->tangent2.j[i] += c->t2.dot(at_point);
    if (c->torsion) c->twist.j[i] += sign * c->n.dot(link.w);
  }
}

template <typename Lanes>
void couple(const ArmResponse& arm, Lanes lanes, int joints, Row* row) {
  row->k = row->body_k;
  if (row->j != nullptr) {
    double wj[kMaxJoints];
    for (int i = 0; i < lanes; ++i) wj[i] = 0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(joints); ++j) {
      if (row->j[j] != 0) add_scaled(wj, arm.response[j].data(), row->j[j], lanes);
    }
    for (int i = 0; i < lanes; ++i) row->wj[i] = wj[i];
    row->k += dot_joints(row->j, row->wj, lanes);
  }
  row->inverse_k = 1.0 / row->k;
}

struct Sweeps {
  int count = 0;
  double change = 0;  // m/s, of the last
};

template <typename Lanes>
double sweep_limits(const ArmResponse& arm, Lanes lanes, Problem* problem) {
  double change = 0;
  for (LimitRow& row : problem->limits) {
    const std::size_t j = static_cast<std::size_t>(row.joint);
    const double v = row.sign * problem->u[j];
    const double next = std::max(0.0, row.impulse - (v + row.bias) / row.k);
    const double delta = next - row.impulse;
    row.impulse = next;
    if (delta == 0) continue;
    add_scaled(problem->u.data(), arm.response[j].data(), row.sign * delta, lanes);
    change = std::max(change, std::fabs(delta) * row.k * row.lever);
  }
  return change;
}

// Friction's bound follows the normal impulse of the moment, or is held at Contact::grip.
enum class Friction { kFollows, kHeld };

template <Friction kFriction, typename Lanes>
inline double sweep_contact(Contact* contact, const Sides& s, double* u, Lanes lanes) {
  Contact& c = *contact;
  const double v = row_speed(c.normal, s, u, lanes);
  const double next = std::max(0.0, c.normal.impulse - (v + c.normal.bias) * c.normal.inverse_k);
  const double delta = next - c.normal.impulse;
  double change = std::fabs(delta) * c.normal.k;
  if (delta != 0) {
    c.normal.impulse = next;
    push(c.normal, c, s, delta, u, lanes);
  }

  const double bound = kFriction == Friction::kHeld ? c.grip : c.friction * c.normal.impulse;
  if (bound > 0 || c.tangent1.impulse != 0 || c.tangent2.impulse != 0) {
    const double v1 = row_speed(c.tangent1, s, u, lanes);
    const double v2 = row_speed(c.tangent2, s, u, lanes);
    double a1 = c.tangent1.impulse - v1 * c.tangent1.inverse_k;
    double a2 = c.tangent2.impulse - v2 * c.tangent2.inverse_k;
    const double length2 = a1 * a1 + a2 * a2;
    if (length2 > bound * bound) {
      const double scale = bound / std::sqrt(length2);
      a1 *= scale;
      a2 *= scale;
    }
    const double d1 = a1 - c.tangent1.impulse, d2 = a2 - c.tangent2.impulse;
    c.tangent1.impulse = a1;
    c.tangent2.impulse = a2;
    push(c.tangent1, c, s, d1, u, lanes);
    push(c.tangent2, c, s, d2, u, lanes);
    change = std::max(change, std::max(std::fabs(d1) * c.tangent1.k, std::fabs(d2) * c.tangent2.k));
  }

  if (c.torsion && (bound > 0 || c.twist.impulse != 0)) {
    const double limit = bound * c.patch;
    const double w = row_speed(c.twist, s, u, lanes);
    const double twist = std::clamp(c.twist.impulse - w * c.twist.inverse_k, -limit, limit);
    const double d = twist - c.twist.impulse;
    c.twist.impulse = twist;
    push(c.twist, c, s, d, u, lanes);
    change = std::max(change, std::fabs(d) * c.twist.k * c.patch);
  }
  return change;
}

// Ends after a sweep that changes less than the tolerance, after `enough` sweeps unless the last
// changed more than jam_change, and after `most` in any case.
template <Friction kFriction, typename Lanes>
Sweeps sweep(const Parameters& parameters, int enough, int most, const ArmResponse& arm,
             Lanes lanes, Problem* problem) {
  for (int count = 1;; ++count) {
    double change = sweep_limits(arm, lanes, problem);
    for (Contact& c : problem->contacts) {
      change = std::max(change, sweep_contact<kFriction>(&c, sides(c, problem->bodies),
                                                         problem->u.data(), lanes));
    }
    const bool stop = count >= enough && change < parameters.jam_change;
    if (change < parameters.tolerance || stop || count >= most) return {count, change};
  }
}

}  // namespace

void build_rows(const Parameters& parameters, const ArmDynamics* arm,
                const std::vector<Collider>& colliders, Problem* problem) {
  const std::size_t width = static_cast<std::size_t>(problem->lanes);
  std::size_t used = 0;
  for (const Contact& c : problem->contacts) used += c.links ? 8 * width : 0;
  problem->columns.assign(used, 0.0);
  used = 0;
  for (Contact& c : problem->contacts) {
    const Sides s = sides(c, problem->bodies);
    build_linear(&c.normal, c, s, c.n);
    build_linear(&c.tangent1, c, s, c.t1);
    build_linear(&c.tangent2, c, s, c.t2);
    if (c.torsion) build_twist(&c.twist, c, s);
    c.normal.bias =
        c.gap > 0
            ? c.gap / parameters.dt
            : -std::min(parameters.push,
                        parameters.beta * std::max(0.0, -c.gap - parameters.slop) / parameters.dt);
    if (!c.links) continue;
    for (Row* row : {&c.normal, &c.tangent1, &c.tangent2, &c.twist}) {
      row->j = &problem->columns[used];
      row->wj = row->j + width;
      used += 2 * width;
    }
    // What carries both links moves neither against the other.
    const std::uint32_t a = colliders[static_cast<std::size_t>(c.collider_a)].path;
    const std::uint32_t b =
        c.collider_b < 0 ? 0 : colliders[static_cast<std::size_t>(c.collider_b)].path;
    add_columns(*arm, a & ~b, 1, &c);
    if (b != 0) add_columns(*arm, b & ~a, -1, &c);
  }
}

void build_limits(const Parameters& parameters, const Drives& drives, Joints* joints,
                  Problem* problem) {
  problem->limits.clear();
  for (int j = 0; j < drives.count; ++j) {
    const std::size_t i = static_cast<std::size_t>(j);
    for (std::size_t side = 0; side < 2; ++side) {
      const double sign = side == 0 ? 1 : -1;
      const double gap = sign * (joints->q[i] - (side == 0 ? drives.lower[i] : drives.upper[i]));
      double& impulse = joints->limit_impulse[i][side];
      if (!(gap <= 2 * parameters.dt * std::fabs(joints->u[i]) + 0.01)) {
        impulse = 0;
        continue;
      }
      LimitRow row;
      row.joint = j;
      row.sign = sign;
      row.bias = gap > 0 ? gap / parameters.dt : parameters.beta * gap / parameters.dt;
      row.lever = drives.prismatic[i] ? 1 : kRevoluteLever;
      row.impulse = impulse;
      problem->limits.push_back(row);
    }
  }
}

void couple_arm(const ArmResponse& arm, Problem* problem) {
  with_lanes(problem->lanes, [&](auto lanes) {
    for (Contact& c : problem->contacts) {
      couple(arm, lanes, problem->joints, &c.normal);
      couple(arm, lanes, problem->joints, &c.tangent1);
      couple(arm, lanes, problem->joints, &c.tangent2);
      if (c.torsion) couple(arm, lanes, problem->joints, &c.twist);
    }
  });
  for (LimitRow& row : problem->limits) {
    row.k = arm.response[static_cast<std::size_t>(row.joint)][static_cast<std::size_t>(row.joint)];
  }
}

void warm_start(Problem* problem, const ArmResponse& arm) {
  double* u = problem->u.data();
  with_lanes(problem->lanes, [&](auto lanes) {
    for (Contact& c : problem->contacts) {
      const Sides s = sides(c, problem->bodies);
      for (Row* row : {&c.twist, &c.normal, &c.tangent1, &c.tangent2}) {
        row->start = row->impulse;
        if (row->impulse != 0 && (c.torsion || row != &c.twist))
          push(*row, c, s, row->impulse, u, lanes);
      }
    }
  });
  for (LimitRow& row : problem->limits) {
    row.start = row.impulse;
    if (row.impulse == 0) continue;
    add_scaled(u, arm.response[static_cast<std::size_t>(row.joint)].data(), row.sign * row.impulse,
               problem->lanes);
  }
}

void rewind(Problem* problem, const ArmResponse& arm) {
  problem->u = arm.free_speed;
  for (Body& body : *problem->bodies) {
    if (body.asleep) continue;
    body.velocity = body.start_velocity;
    body.spin = body.start_spin;
  }
}

int solve(const Parameters& parameters, const ArmResponse& arm, Problem* problem) {
  if (problem->contacts.empty() && problem->limits.empty()) return 0;
  return with_lanes(problem->lanes, [&](auto lanes) {
    const Sweeps free = sweep<Friction::kFollows>(parameters, parameters.max_sweeps,
                                                  parameters.jam_sweeps, arm, lanes, problem);
    if (!(free.change > parameters.runaway)) return free.count;

    // Normal impulses and friction drive each other up. Again from the start with friction's bounds
    // held, which makes the problem convex; bounds renewed a few times cannot run far.
    int count = free.count;
    for (LimitRow& row : problem->limits) row.impulse = row.start;
    for (Contact& c : problem->contacts) {
      for (Row* row : {&c.twist, &c.normal, &c.tangent1, &c.tangent2}) row->impulse = row->start;
    }
    rewind(problem, arm);
    warm_start(problem, arm);
    for (int round = 0; round < kHeldRounds; ++round) {
      for (Contact& c : problem->contacts) c.grip = c.friction * c.normal.impulse;
      count += sweep<Friction::kHeld>(parameters, parameters.max_sweeps, parameters.max_sweeps, arm,
                                      lanes, problem)
                   .count;
    }
    return count;
  });
}

}  // namespace probe::world
