#include "runtime/world/rows.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "runtime/world/lanes.h"

namespace probe::world {
namespace {

using std::size_t;

// Added to each effective mass (1/kg): a row that nothing can move divides by it and gets no
// impulse of note.
constexpr double kRegular = 1e-9;
// m, makes rad/s of a joint comparable to m/s of a contact: only when the sweeps end depends on it.
constexpr double kRevoluteLever = 0.2;

struct BodyPair {
  const Body* a;
  const Body* b;
};

BodyPair body_pair(const ContactRows& c, const std::vector<Body>& bodies) {
  return {c.body_a < 0 ? nullptr : &bodies[static_cast<size_t>(c.body_a)],
          c.body_b < 0 ? nullptr : &bodies[static_cast<size_t>(c.body_b)]};
}

// A row along d at the contact point p, r = p - centre of the body:
//   speed = J u + d . v_A + (r_A x d) . omega_A - d . v_B - (r_B x d) . omega_B
//   k     = J W J^T + sum over bodies of ( 1/m + (r x d) . K (r x d) )
// Here the bodies' part; returns their k.
double build_linear(const Contact& c, const ContactRows& rows, const BodyPair& s, const Vec3& d,
                    Row* row) {
  double k = kRegular;
  row->d = d;
  if (s.a != nullptr) {
    row->arm_a = (c.p - s.a->position).cross(d);
    row->ka = s.a->response * row->arm_a;
    k += rows.inverse_mass_a + row->arm_a.dot(row->ka);
  }
  if (s.b != nullptr) {
    row->arm_b = (c.p - s.b->position).cross(d);
    row->kb = s.b->response * row->arm_b;
    k += rows.inverse_mass_b + row->arm_b.dot(row->kb);
  }
  return k;
}

// Torsion about the normal is angular only, so its linear direction is zero and its arms are n.
double build_twist(const Contact& c, const BodyPair& s, Row* row) {
  double k = kRegular;
  row->d = Vec3::Zero();
  if (s.a != nullptr) {
    row->arm_a = c.n;
    row->ka = s.a->response * c.n;
    k += c.n.dot(row->ka);
  }
  if (s.b != nullptr) {
    row->arm_b = c.n;
    row->kb = s.b->response * c.n;
    k += c.n.dot(row->kb);
  }
  return k;
}

// Adds the columns of the moving links in `path`, times sign: J_j = d . (v_j + w_j x (p -
// reference)), torsion J_j = n . w_j.
void add_columns(const JointTree& tree, std::uint32_t path, double sign, size_t lanes,
                 const Contact& c, ContactRows* rows) {
  const Vec3 r = c.p - tree.reference();
  double* const columns = rows->columns;
  for (; path != 0; path &= path - 1) {
    const MovingLink& link = tree.link(std::countr_zero(path));
    const size_t i = static_cast<size_t>(link.coordinate);
    const Vec3 at_point = sign * (link.v + link.w.cross(r));
    columns[2 * kNormal * lanes + i] += c.n.dot(at_point);
    columns[2 * kTangent1 * lanes + i] += c.t1.dot(at_point);
    columns[2 * kTangent2 * lanes + i] += c.t2.dot(at_point);
    if (rows->torsion) columns[2 * kTwist * lanes + i] += sign * c.n.dot(link.w);
  }
}

// W J^T and k of one row, `column` is J and W J^T after it.
template <typename Lanes>
void couple(const JointResponse& response, Lanes lanes, int joints, double body_k, double* column,
            Row* row) {
  row->k = body_k;
  if (column != nullptr) {
    double wj[kMaxJoints];
    for (int i = 0; i < lanes; ++i) wj[i] = 0;
    for (size_t j = 0; j < static_cast<size_t>(joints); ++j) {
      if (column[j] != 0) add_scaled(wj, response.matrix[j].data(), column[j], lanes);
    }
    double* const out = column + lanes;
    for (int i = 0; i < lanes; ++i) out[i] = wj[i];
    row->k += dot_joints(column, out, lanes);
  }
  row->inverse_k = 1.0 / row->k;
}

double lever_of(const Drives& drives, size_t joint) {
  return drives.prismatic[joint] ? 1 : kRevoluteLever;
}

}  // namespace

void build_rows(const Parameters& parameters, const std::vector<Articulation>& articulations,
                const std::vector<Collider>& colliders, Problem* problem) {
  const size_t width = static_cast<size_t>(problem->lanes);
  size_t used = 0;
  for (const Contact& c : problem->contacts) {
    used += (c.path_a | c.path_b) != 0 ? 2 * kRows * width : 0;
  }
  problem->columns.assign(used, 0.0);
  used = 0;
  for (size_t index = 0; index < problem->contacts.size(); ++index) {
    Contact& c = problem->contacts[index];
    ContactRows& rows = problem->rows[index];
    const BodyPair s = body_pair(rows, *problem->bodies);
    c.body_k[kNormal] = build_linear(c, rows, s, c.n, &rows.rows[kNormal]);
    c.body_k[kTangent1] = build_linear(c, rows, s, c.t1, &rows.rows[kTangent1]);
    c.body_k[kTangent2] = build_linear(c, rows, s, c.t2, &rows.rows[kTangent2]);
    if (rows.torsion) c.body_k[kTwist] = build_twist(c, s, &rows.rows[kTwist]);
    // Speculative while apart: only the speed that would cross the gap goes. In overlap a share of
    // it is pushed out, but for the slop and not faster than the cap. Into what is soft things sink
    // as far as the force says: gap + give force = 0 afterwards.
    rows.bias =
        c.gap > 0 || rows.give > 0
            ? c.gap / parameters.dt
            : -std::min(parameters.push,
                        parameters.beta * std::max(0.0, -c.gap - parameters.slop) / parameters.dt);
    rows.columns = nullptr;
    if ((c.path_a | c.path_b) == 0) continue;
    rows.columns = &problem->columns[used];
    used += 2 * kRows * width;
    const auto tree = [&](int collider) -> const JointTree& {
      const int of = colliders[static_cast<size_t>(collider)].articulation;
      return *articulations[static_cast<size_t>(of)].tree;
    };
    if (c.path_a != 0) add_columns(tree(c.collider_a), c.path_a, 1, width, c, &rows);
    if (c.path_b != 0) add_columns(tree(c.collider_b), c.path_b, -1, width, c, &rows);
  }
}

void build_joint_rows(const Parameters& parameters, const Drives& drives,
                      const std::vector<Articulation>& articulations, Joints* joints,
                      Problem* problem) {
  problem->limits.clear();
  problem->joint_frictions.clear();
  for (const Articulation& articulation : articulations) {
    if (articulation.asleep) continue;
    for (int j = articulation.range.first; j < articulation.range.first + articulation.range.count;
         ++j) {
      const size_t i = static_cast<size_t>(j);
      for (size_t side = 0; side < 2; ++side) {
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
        row.lever = lever_of(drives, i);
        row.impulse = impulse;
        problem->limits.push_back(row);
      }
      if (drives.friction[i] == 0) continue;
      JointFrictionRow row;
      row.joint = j;
      row.bound = drives.friction[i] * parameters.dt;
      row.lever = lever_of(drives, i);
      // Of friction that gives way, in a substep whose damping is implicit: the law's acceleration
      // is that of the explicit one, greater by 1 + dt KD / M of the joint alone.
      if (drives.friction_fade[i] > 0) {
        const double implicit =
            1 + parameters.dt * drives.damping[i] /
                    (articulation.tree->mass()[i - static_cast<size_t>(articulation.range.first)]
                                              [i - static_cast<size_t>(articulation.range.first)] +
                     drives.armature[i]);
        row.target = (1 - parameters.dt * drives.friction_fade[i] / implicit) * joints->u[i];
        row.give = drives.friction_give[i] / implicit;
      }
      row.impulse = joints->friction_impulse[i];
      problem->joint_frictions.push_back(row);
    }
  }
}

void couple_joints(const JointResponse& response, Problem* problem) {
  with_lanes(problem->lanes, [&](auto lanes) {
    for (size_t index = 0; index < problem->contacts.size(); ++index) {
      const Contact& c = problem->contacts[index];
      ContactRows& rows = problem->rows[index];
      double* column = rows.columns;
      for (size_t r = 0; r < (rows.torsion ? kRows : kTwist); ++r) {
        couple(response, lanes, problem->joints, c.body_k[r], column, &rows.rows[r]);
        if (column != nullptr) column += 2 * lanes;
      }
      if (rows.give > 0) {
        Row& normal = rows.rows[kNormal];
        normal.k += rows.give;
        normal.inverse_k = 1.0 / normal.k;
      }
    }
  });
  const auto own = [&](int joint) {
    return response.matrix[static_cast<size_t>(joint)][static_cast<size_t>(joint)];
  };
  for (LimitRow& row : problem->limits) row.k = own(row.joint);
  for (JointFrictionRow& row : problem->joint_frictions) row.k = own(row.joint);
}

}  // namespace probe::world
