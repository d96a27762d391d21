#include "runtime/world/rows.h"

#include <algorithm>
#include <cmath>

#include "runtime/world/lanes.h"

namespace probe::world {
namespace {

constexpr double kRegular = 1e-9;
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

inline double row_speed(const Row& row, bool links, const Sides& s, const JointArray& u) {
  double v = links ? dot_joints(row.j, u) : 0.0;
  if (s.a != nullptr) v += row.d.dot(s.a->velocity) + row.arm_a.dot(s.a->spin);
  if (s.b != nullptr) v -= row.d.dot(s.b->velocity) + row.arm_b.dot(s.b->spin);
  return v;
}

inline void push(const Row& row, const Contact& c, const Sides& s, double impulse, JointArray* u) {
  if (c.links) add_scaled(u, row.wj, impulse);
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

void build_columns(const ArmDynamics& arm, std::uint32_t path, Contact* c) {
  c->normal.j = c->tangent1.j = c->tangent2.j = c->twist.j = JointArray{};
  for (int j = 0; j < arm.count(); ++j) {
    if ((path >> j & 1U) == 0) continue;
    const std::size_t i = static_cast<std::size_t>(j);
    const MovingLink& link = arm.link(j);
    const Vec3 at_point = link.h + link.w.cross(c->p - link.origin);
    c->normal.j[i] = c->n.dot(at_point);
    c->tangent1.j[i] = c->t1.dot(at_point);
    c->tangent2.j[i] = c->t2.dot(at_point);
    if (c->torsion) c->twist.j[i] = c->n.dot(link.w);
  }
}

void couple(const ArmResponse& arm, bool links, Row* row) {
  row->k = row->body_k;
  if (links) {
    row->wj = JointArray{};
    for (std::size_t j = 0; j < kMaxJoints; ++j) {
      if (row->j[j] != 0) add_scaled(&row->wj, arm.response[j], row->j[j]);
    }
    row->k += dot_joints(row->j, row->wj);
  }
  row->inverse_k = 1.0 / row->k;
}

double sweep_limits(const ArmResponse& arm, Problem* problem) {
  double change = 0;
  for (LimitRow& row : problem->limits) {
    const std::size_t j = static_cast<std::size_t>(row.joint);
    const double v = row.sign * problem->u[j];
    const double next = std::max(0.0, row.impulse - (v + row.bias) / row.k);
    const double delta = next - row.impulse;
    row.impulse = next;
    if (delta == 0) continue;
    add_scaled(&problem->u, arm.response[j], row.sign * delta);
    change = std::max(change, std::fabs(delta) * row.k * row.lever);
  }
  return change;
}

double sweep_contact(Contact* contact, const Sides& s, JointArray* u) {
  Contact& c = *contact;
  const double v = row_speed(c.normal, c.links, s, *u);
  const double next = std::max(0.0, c.normal.impulse - (v + c.normal.bias) * c.normal.inverse_k);
  const double delta = next - c.normal.impulse;
  double change = std::fabs(delta) * c.normal.k;
  if (delta != 0) {
    c.normal.impulse = next;
    push(c.normal, c, s, delta, u);
  }

  const double bound = c.friction * c.normal.impulse;
  if (bound > 0 || c.tangent1.impulse != 0 || c.tangent2.impulse != 0) {
    const double v1 = row_speed(c.tangent1, c.links, s, *u);
    const double v2 = row_speed(c.tangent2, c.links, s, *u);
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
    push(c.tangent1, c, s, d1, u);
    push(c.tangent2, c, s, d2, u);
    change = std::max(change, std::max(std::fabs(d1) * c.tangent1.k, std::fabs(d2) * c.tangent2.k));
  }

  if (c.torsion && (bound > 0 || c.twist.impulse != 0)) {
    const double limit = bound * c.patch;
    const double w = row_speed(c.twist, c.links, s, *u);
    const double twist = std::clamp(c.twist.impulse - w * c.twist.inverse_k, -limit, limit);
    const double d = twist - c.twist.impulse;
    c.twist.impulse = twist;
    push(c.twist, c, s, d, u);
    change = std::max(change, std::fabs(d) * c.twist.k * c.patch);
  }
  return change;
}

}  // namespace

void build_rows(const Parameters& parameters, const ArmDynamics* arm,
                const std::vector<Collider>& colliders, Problem* problem) {
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
    if (c.links) build_columns(*arm, colliders[static_cast<std::size_t>(c.collider_a)].path, &c);
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
  for (Contact& c : problem->contacts) {
    couple(arm, c.links, &c.normal);
    couple(arm, c.links, &c.tangent1);
    couple(arm, c.links, &c.tangent2);
    if (c.torsion) couple(arm, c.links, &c.twist);
  }
  for (LimitRow& row : problem->limits) {
    row.k = arm.response[static_cast<std::size_t>(row.joint)][static_cast<std::size_t>(row.joint)];
  }
}

void warm_start(Problem* problem, const ArmResponse& arm) {
  for (Contact& c : problem->contacts) {
    const Sides s = sides(c, problem->bodies);
    if (c.torsion && c.twist.impulse != 0) push(c.twist, c, s, c.twist.impulse, &problem->u);
    if (c.normal.impulse != 0) push(c.normal, c, s, c.normal.impulse, &problem->u);
    if (c.tangent1.impulse != 0) push(c.tangent1, c, s, c.tangent1.impulse, &problem->u);
    if (c.tangent2.impulse != 0) push(c.tangent2, c, s, c.tangent2.impulse, &problem->u);
  }
  for (const LimitRow& row : problem->limits) {
    if (row.impulse == 0) continue;
    add_scaled(&problem->u, arm.response[static_cast<std::size_t>(row.joint)],
               row.sign * row.impulse);
  }
}

int solve(const Parameters& parameters, const ArmResponse& arm, Problem* problem) {
  if (problem->contacts.empty() && problem->limits.empty()) return 0;
  for (int sweep = 1; sweep <= parameters.max_sweeps; ++sweep) {
    double change = sweep_limits(arm, problem);
    for (Contact& c : problem->contacts) {
      change = std::max(change, sweep_contact(&c, sides(c, problem->bodies), &problem->u));
    }
    if (change < parameters.tolerance) return sweep;
  }
  return parameters.max_sweeps;
}

}  // namespace probe::world
