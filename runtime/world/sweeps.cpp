#include "runtime/world/sweeps.h"

#include <algorithm>
#include <cmath>

#include "runtime/world/lanes.h"

namespace probe::world {
namespace {

using std::size_t;

constexpr int kHeldRounds = 4;  // of sweeps between renewals of friction's bounds
constexpr RowIndex kWarmOrder[] = {kTwist, kNormal, kTangent1, kTangent2};

// The bodies of a contact; absent ones are never touched.
struct Sides {
  Body* a;
  Body* b;
};

Sides sides(const ContactRows& c, std::vector<Body>* bodies) {
  return {c.body_a < 0 ? nullptr : &(*bodies)[static_cast<size_t>(c.body_a)],
          c.body_b < 0 ? nullptr : &(*bodies)[static_cast<size_t>(c.body_b)]};
}

template <typename Lanes>
inline double row_speed(const ContactRows& c, RowIndex which, const Sides& s, const double* u,
                        Lanes lanes) {
  const Row& row = c.rows[which];
  double v = c.columns != nullptr
                 ? dot_joints(c.columns + 2 * static_cast<int>(which) * lanes, u, lanes)
                 : 0.0;
  if (s.a != nullptr) v += row.d.dot(s.a->velocity) + row.arm_a.dot(s.a->spin);
  if (s.b != nullptr) v -= row.d.dot(s.b->velocity) + row.arm_b.dot(s.b->spin);
  return v;
}

template <typename Lanes>
inline void push(const ContactRows& c, RowIndex which, const Sides& s, double impulse, double* u,
                 Lanes lanes) {
  const Row& row = c.rows[which];
  if (c.columns != nullptr)
    add_scaled(u, c.columns + (2 * static_cast<int>(which) + 1) * lanes, impulse, lanes);
  if (s.a != nullptr) {
    s.a->velocity += (impulse * c.inverse_mass_a) * row.d;
    s.a->spin += impulse * row.ka;
  }
  if (s.b != nullptr) {
    s.b->velocity -= (impulse * c.inverse_mass_b) * row.d;
    s.b->spin -= impulse * row.kb;
  }
}

struct Sweeps {
  int count = 0;
  double change = 0;  // m/s, of the last
};

// A limit pushes one way: l >= 0, speed + bias >= 0, one of them 0.
template <typename Lanes>
double sweep_limits(const JointResponse& response, Lanes lanes, Problem* problem) {
  double change = 0;
  for (LimitRow& row : problem->limits) {
    const size_t j = static_cast<size_t>(row.joint);
    const double v = row.sign * problem->u[j];
    const double next = std::max(0.0, row.impulse - (v + row.bias) / row.k);
    const double delta = next - row.impulse;
    row.impulse = next;
    if (delta == 0) continue;
    add_scaled(problem->u.data(), response.matrix[j].data(), row.sign * delta, lanes);
    change = std::max(change, std::fabs(delta) * row.k * row.lever);
  }
  return change;
}

// Friction in a joint stops it as far as its bound goes: |l| <= bound, speed 0 or l at the bound
// against it.
template <typename Lanes>
double sweep_joint_frictions(const JointResponse& response, Lanes lanes, Problem* problem) {
  double change = 0;
  for (JointFrictionRow& row : problem->joint_frictions) {
    const size_t j = static_cast<size_t>(row.joint);
    const double miss = problem->u[j] + row.give * row.impulse - row.target;
    const double next = std::clamp(row.impulse - miss / (row.k + row.give), -row.bound, row.bound);
    const double delta = next - row.impulse;
    row.impulse = next;
    if (delta == 0) continue;
    add_scaled(problem->u.data(), response.matrix[j].data(), delta, lanes);
    change = std::max(change, std::fabs(delta) * row.k * row.lever);
  }
  return change;
}

// Friction's bound follows the normal impulse of the moment, or is held at ContactRows::grip.
enum class Friction { kFollows, kHeld };

// The normal impulse first, then both tangents, scaled back into the disc of friction, then
// torsion.
template <Friction kFriction, typename Lanes>
inline double sweep_contact(ContactRows* contact, const Sides& s, double* u, Lanes lanes) {
  ContactRows& c = *contact;
  Row& normal = c.rows[kNormal];
  const double v = row_speed(c, kNormal, s, u, lanes);
  const double miss = v + c.bias + c.give * normal.impulse;
  const double next = std::max(0.0, normal.impulse - miss * normal.inverse_k);
  const double delta = next - normal.impulse;
  double change = std::fabs(delta) * normal.k;
  if (delta != 0) {
    normal.impulse = next;
    push(c, kNormal, s, delta, u, lanes);
  }

  const double bound = kFriction == Friction::kHeld ? c.grip : c.friction * normal.impulse;
  Row &t1 = c.rows[kTangent1], &t2 = c.rows[kTangent2];
  if (bound > 0 || t1.impulse != 0 || t2.impulse != 0) {
    const double v1 = row_speed(c, kTangent1, s, u, lanes);
    const double v2 = row_speed(c, kTangent2, s, u, lanes);
    double a1 = t1.impulse - v1 * t1.inverse_k;
    double a2 = t2.impulse - v2 * t2.inverse_k;
    const double length2 = a1 * a1 + a2 * a2;
    if (length2 > bound * bound) {
      const double scale = bound / std::sqrt(length2);
      a1 *= scale;
      a2 *= scale;
    }
    const double d1 = a1 - t1.impulse, d2 = a2 - t2.impulse;
    t1.impulse = a1;
    t2.impulse = a2;
    push(c, kTangent1, s, d1, u, lanes);
    push(c, kTangent2, s, d2, u, lanes);
    change = std::max(change, std::max(std::fabs(d1) * t1.k, std::fabs(d2) * t2.k));
  }

  Row& torsion = c.rows[kTwist];
  if (c.torsion && (bound > 0 || torsion.impulse != 0)) {
    const double limit = bound * c.patch;
    const double w = row_speed(c, kTwist, s, u, lanes);
    const double twist = std::clamp(torsion.impulse - w * torsion.inverse_k, -limit, limit);
    const double d = twist - torsion.impulse;
    torsion.impulse = twist;
    push(c, kTwist, s, d, u, lanes);
    change = std::max(change, std::fabs(d) * torsion.k * c.patch);
  }
  return change;
}

// Ends after a sweep that changes less than the tolerance, after `enough` sweeps unless the last
// changed more than jam_change, and after `most` in any case.
template <Friction kFriction, typename Lanes>
Sweeps sweep(const Parameters& parameters, int enough, int most, const JointResponse& response,
             Lanes lanes, Problem* problem) {
  for (int count = 1;; ++count) {
    double change = sweep_limits(response, lanes, problem);
    change = std::max(change, sweep_joint_frictions(response, lanes, problem));
    for (ContactRows& c : problem->rows) {
      change = std::max(change, sweep_contact<kFriction>(&c, sides(c, problem->bodies),
                                                         problem->u.data(), lanes));
    }
    const bool stop = count >= enough && change < parameters.jam_change;
    if (change < parameters.tolerance || stop || count >= most) return {count, change};
  }
}

// Every impulse as warm_start() found it.
void reset_impulses(Problem* problem) {
  for (LimitRow& row : problem->limits) row.impulse = row.start;
  for (JointFrictionRow& row : problem->joint_frictions) row.impulse = row.start;
  for (size_t index = 0; index < problem->rows.size(); ++index) {
    for (const RowIndex r : kWarmOrder) {
      problem->rows[index].rows[r].impulse = problem->contacts[index].start[r];
    }
  }
}

bool is_soft(const ContactRows& c) { return c.give > 0 && c.columns != nullptr; }

template <typename Lanes>
void apply_impulses(std::size_t index, Lanes lanes, Problem* problem) {
  const ContactRows& c = problem->rows[index];
  const Sides s = sides(c, problem->bodies);
  for (const RowIndex r : kWarmOrder) {
    const double impulse = c.rows[r].impulse;
    problem->contacts[index].start[r] = impulse;
    if (impulse != 0 && (c.torsion || r != kTwist))
      push(c, r, s, impulse, problem->u.data(), lanes);
  }
}

// The impulses that a substep begins with answer what the drives pressed with in the last one.
// Where targets grow from substep to substep, and begin anew, sweeps find by themselves only slowly
// how much more or less that is now: a light thing between two fingers hides one from the other. So
// the impulses of what is soft, these fingers, are scaled to what the drives press with now, by the
// factor that leaves the least energy along that line; all other impulses stay as they were.
template <typename Lanes>
class LoadMatch {
 public:
  // After the impulses of all contacts that are not soft were applied; those of limits and of
  // joints' friction come later still.
  LoadMatch(Problem* problem, Lanes lanes) : problem_(problem), lanes_(lanes) {
    for (const ContactRows& c : problem->rows)
      if (is_soft(c)) {
        free_ += work(c);
        give_ += c.give * c.rows[kNormal].impulse * c.rows[kNormal].impulse;
      }
  }
  // After those of what is soft were, too.
  void scale() {
    double with = 0;
    for (const ContactRows& c : problem_->rows)
      if (is_soft(c)) with += work(c);
    const double own = with - free_ + give_;  // of the impulses, by themselves
    if (!(own > 0)) return;
    const double factor = std::clamp(-free_ / own, 0.0, kMostMatched);
    for (size_t index = 0; index < problem_->rows.size(); ++index) {
      ContactRows& c = problem_->rows[index];
      if (!is_soft(c)) continue;
      const Sides s = sides(c, problem_->bodies);
      for (const RowIndex r : kWarmOrder) {
        const double more = (factor - 1) * c.rows[r].impulse;
        if (more == 0 || (r == kTwist && !c.torsion)) continue;
        c.rows[r].impulse += more;
        problem_->contacts[index].start[r] = c.rows[r].impulse;
        push(c, r, s, more, problem_->u.data(), lanes_);
      }
    }
  }

 private:
  // Impulses times the speeds that they work on.
  double work(const ContactRows& c) const {
    const Sides s = sides(c, problem_->bodies);
    double sum = 0;
    for (const RowIndex r : kWarmOrder) {
      const double impulse = c.rows[r].impulse;
      if (impulse == 0 || (r == kTwist && !c.torsion)) continue;
      const double v = row_speed(c, r, s, problem_->u.data(), lanes_);
      sum += impulse * (r == kNormal ? v + c.bias : v);
    }
    return sum;
  }

  static constexpr double kMostMatched = 2;
  Problem* problem_;
  Lanes lanes_;
  double free_ = 0, give_ = 0;
};

}  // namespace

void warm_start(Problem* problem, const JointResponse& response) {
  double* u = problem->u.data();
  with_lanes(problem->lanes, [&](auto lanes) {
    bool any_soft = false;
    for (size_t index = 0; index < problem->rows.size(); ++index) {
      if (is_soft(problem->rows[index]))
        any_soft = true;
      else
        apply_impulses(index, lanes, problem);
    }
    if (!any_soft) return;
    LoadMatch match(problem, lanes);
    for (size_t index = 0; index < problem->rows.size(); ++index)
      if (is_soft(problem->rows[index])) apply_impulses(index, lanes, problem);
    match.scale();
  });
  for (LimitRow& row : problem->limits) {
    row.start = row.impulse;
    if (row.impulse == 0) continue;
    add_scaled(u, response.matrix[static_cast<size_t>(row.joint)].data(), row.sign * row.impulse,
               problem->lanes);
  }
  for (JointFrictionRow& row : problem->joint_frictions) {
    row.start = row.impulse;
    if (row.impulse == 0) continue;
    add_scaled(u, response.matrix[static_cast<size_t>(row.joint)].data(), row.impulse,
               problem->lanes);
  }
}

void rewind(Problem* problem, const JointResponse& response) {
  problem->u = response.free_speed;
  for (Body& body : *problem->bodies) {
    if (body.asleep) continue;
    body.velocity = body.start_velocity;
    body.spin = body.start_spin;
  }
}

int solve(const Parameters& parameters, const JointResponse& response, Problem* problem) {
  if (problem->rows.empty() && problem->limits.empty() && problem->joint_frictions.empty()) {
    return 0;
  }
  return with_lanes(problem->lanes, [&](auto lanes) {
    const Sweeps free = sweep<Friction::kFollows>(parameters, parameters.max_sweeps,
                                                  parameters.jam_sweeps, response, lanes, problem);
    if (!(free.change > parameters.runaway)) return free.count;

    // Normal impulses and friction drive each other up. Again from the start with friction's bounds
    // held, which makes the problem convex; bounds renewed a few times cannot run far.
    int count = free.count;
    reset_impulses(problem);
    rewind(problem, response);
    warm_start(problem, response);
    for (int round = 0; round < kHeldRounds; ++round) {
      for (ContactRows& c : problem->rows) c.grip = c.friction * c.rows[kNormal].impulse;
      count += sweep<Friction::kHeld>(parameters, parameters.max_sweeps, parameters.max_sweeps,
                                      response, lanes, problem)
                   .count;
    }
    return count;
  });
}

}  // namespace probe::world
