// From a URDF tree to poses, columns and inertia.
#include "runtime/world/joint_tree.h"

#include <algorithm>
#include <string>

#include <Eigen/Eigenvalues>

#include "runtime/base/trig.h"

namespace probe::world {
namespace {

using std::size_t;

Failure world_failure(std::string message) { return {Fault::kWorld, std::move(message), ""}; }

// Products written out: the order of each sum is fixed, whatever the vector width. It is also the
// multibody library's, so that a test can compare bit for bit.
Mat3 times(const Mat3& a, const Mat3& b) {
  Mat3 out;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      out(i, j) = (a(i, 0) * b(0, j) + a(i, 1) * b(1, j)) + a(i, 2) * b(2, j);
    }
  }
  return out;
}

Vec3 times(const Mat3& a, const Vec3& b) {
  Vec3 out;
  for (int i = 0; i < 3; ++i) out[i] = (a(i, 0) * b[0] + a(i, 1) * b[1]) + a(i, 2) * b[2];
  return out;
}

Mat3 turn_about_z(double angle) {
  const SinCos t = portable_sincos(angle);
  Mat3 m;
  m << t.cos, -t.sin, 0, t.sin, t.cos, 0, 0, 0, 1;
  return m;
}

}  // namespace

void JointTree::Lump::add(const robot::Link& link, const Pose& offset) {
  const Mat3 r = offset.rotation.toRotationMatrix();
  const Vec3 c = offset.apply(link.center_of_mass);
  mass += link.mass;
  moment += link.mass * c;
  inertia += r * link.inertia * r.transpose() +
             link.mass * (c.squaredNorm() * Mat3::Identity() - c * c.transpose());
}

bool JointTree::Lump::is_possible() const {
  if (!(mass > 0) || !inertia.allFinite() || !moment.allFinite()) return false;
  const Vec3 c = moment / mass;
  const Mat3 central = inertia - mass * (c.squaredNorm() * Mat3::Identity() - c * c.transpose());
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(central).eigenvalues();
  return moments[0] > 0 && moments[0] + moments[1] >= moments[2] * (1 - 1e-6);
}

Result<std::unique_ptr<JointTree>> JointTree::create(const robot::RobotModel& model,
                                                     const Pose& base,
                                                     const std::vector<int>& joints, int first) {
  std::unique_ptr<JointTree> made(new JointTree);
  made->first_ = first;
  made->count_ = static_cast<int>(joints.size());
  made->base_ = base;
  PROBE_TRY(made->read_tree(model, joints));
  PROBE_ASSIGN(const auto library, Multibody::create(model.name, made->tree_, made->outward_));
  made->frames_ = library->frames();
  return made;
}

// From the root outwards: which moving link carries each link, how it moves and what it weighs.
Status JointTree::read_tree(const robot::RobotModel& model, const std::vector<int>& joints) {
  std::vector<int> moving_of_joint(model.joints.size(), -1);
  for (size_t k = 0; k < joints.size(); ++k) {
    moving_of_joint[static_cast<size_t>(joints[k])] = static_cast<int>(k);
    motions_.push_back({joints[k], static_cast<int>(k), 1, 0});
  }
  for (size_t i = 0; i < model.joints.size(); ++i) {
    const robot::Joint& joint = model.joints[i];
    if (joint.kind == robot::JointKind::kFixed || moving_of_joint[i] >= 0) continue;
    const auto leader = std::find(joints.begin(), joints.end(), joint.mimic);
    if (joint.mimic < 0 || leader == joints.end()) {
      return world_failure("joint `" + joint.name + "` moves but has no drive");
    }
    moving_of_joint[i] = static_cast<int>(motions_.size());
    motions_.push_back({static_cast<int>(i), static_cast<int>(leader - joints.begin()),
                        joint.mimic_scale, joint.mimic_offset});
    followers_.push_back(motions_.back());
  }
  const size_t n = motions_.size();
  if (n > kMaxJoints) {
    return world_failure("`" + model.name + "` may have at most " + std::to_string(kMaxJoints) +
                         " joints that move");
  }
  links_.resize(n), tree_.resize(n), lumps_.resize(n), placed_.resize(n), composites_.resize(n),
      paths_.resize(n);
  carriers_.assign(model.links.size(), {});

  std::vector<int> reached{model.root};
  for (size_t next = 0; next < reached.size(); ++next) {
    const int link = reached[next];
    const Carrier carrier = carriers_[static_cast<size_t>(link)];
    if (carrier.moving >= 0) {
      lumps_[static_cast<size_t>(carrier.moving)].add(model.links[static_cast<size_t>(link)],
                                                      carrier.offset);
    }
    for (size_t j = 0; j < model.joints.size(); ++j) {
      const robot::Joint& joint = model.joints[j];
      if (joint.parent_link != link) continue;
      const Pose at = carrier.offset * joint.origin;
      Carrier& child = carriers_[static_cast<size_t>(joint.child_link)];
      if (moving_of_joint[j] < 0) {
        child = {carrier.moving, at};
      } else {
        const int k = moving_of_joint[j];
        const size_t i = static_cast<size_t>(k);
        child = {k, Pose{}};
        tree_[i].parent = carrier.moving;
        tree_[i].inboard = carrier.moving < 0 ? base_ * at : at;
        tree_[i].slides = joint.kind == robot::JointKind::kPrismatic;
        tree_[i].axis = joint.axis;
        paths_[i] = path(carrier.moving) | (1U << k);
        links_[i].coordinate = first_ + motions_[i].leader;
        outward_.push_back(k);
      }
      reached.push_back(joint.child_link);
      if (reached.size() > model.links.size())
        return world_failure("the robot's links form a loop");
    }
  }
  for (size_t i = 0; i < n; ++i) {
    const robot::Joint& joint = model.joints[static_cast<size_t>(motions_[i].joint)];
    if (!lumps_[i].is_possible()) {
      return world_failure(
          "link `" + model.links[static_cast<size_t>(joint.child_link)].name +
          "` and what is fixed to it have a mass or inertia that no body can have");
    }
    tree_[i].mass = lumps_[i].mass;
    tree_[i].moment = lumps_[i].moment;
    tree_[i].inertia = lumps_[i].inertia;
  }
  return {};
}

void JointTree::update(const JointArray& q) {
  const auto mine = q.begin() + first_;
  if (fresh_ && std::equal(mine, mine + count_, q_.begin())) return;
  place(q);
  for (size_t k = 0; k < links_.size(); ++k) {
    MovingLink& link = links_[k];
    const Vec3 along = motions_[k].scale * (link.axes * tree_[k].axis);
    link.w = tree_[k].slides ? Vec3(Vec3::Zero()) : along;
    link.v = tree_[k].slides ? along : Vec3(along.cross(reference() - link.origin));
  }
  update_mass();
  std::copy(mine, mine + count_, q_.begin());
  fresh_ = true;
}

// Poses from the base outwards:
//   X_link = X_parent (in_parent, origin) M(q) (outboard, 0),
// with M(q) a turn by q about z, or a shift by q along x.
void JointTree::place(const JointArray& q) {
  for (const int k : outward_) {
    const size_t i = static_cast<size_t>(k);
    const Follower& motion = motions_[i];
    const JointFrame& frame = frames_[i];
    const double at = motion.scale * q[static_cast<size_t>(first_ + motion.leader)] + motion.offset;
    const bool slides = tree_[i].slides;
    const Mat3 moved = slides ? frame.outboard : times(turn_about_z(at), frame.outboard);
    const Vec3 shift(slides ? at : 0, 0, 0);
    const Mat3 in_parent = times(frame.in_parent, moved);
    const Vec3 origin = frame.origin + times(frame.in_parent, shift);
    const int parent = tree_[i].parent;
    if (parent < 0) {
      links_[i].axes = in_parent;
      links_[i].origin = origin;
    } else {
      const MovingLink& on = links_[static_cast<size_t>(parent)];
      links_[i].axes = times(on.axes, in_parent);
      links_[i].origin = on.origin + times(on.axes, origin);
    }
  }
}

// Composite inertias about the one reference point, so that they add up and columns need no shift:
// M_ij = column i . momentum of all that hangs on j when j moves at unit speed.
void JointTree::update_mass() {
  for (size_t k = 0; k < links_.size(); ++k) {
    const MovingLink& link = links_[k];
    const Lump& own = lumps_[k];
    Lump& about = placed_[k];
    const Vec3 o = link.origin - reference(), c = link.axes * own.moment;
    about.mass = own.mass;
    about.moment = c + own.mass * o;
    const Mat3 turned = link.axes * own.inertia;
    about.inertia = turned * link.axes.transpose();
    const Vec3 both = own.mass * o + c;  // m o o^T + c o^T + o c^T in two products
    const Mat3 outer = both * o.transpose() + o * c.transpose();
    about.inertia += outer.trace() * Mat3::Identity() - outer;
  }
  composites_ = placed_;
  for (size_t n = outward_.size(); n-- > 0;) {
    const size_t k = static_cast<size_t>(outward_[n]);
    if (tree_[k].parent < 0) continue;
    Lump& parent = composites_[static_cast<size_t>(tree_[k].parent)];
    parent.mass += composites_[k].mass;
    parent.moment += composites_[k].moment;
    parent.inertia += composites_[k].inertia;
  }
  for (size_t i = 0; i < static_cast<size_t>(count_); ++i) {
    for (size_t j = 0; j < static_cast<size_t>(count_); ++j) mass_[i][j] = 0;
  }
  for (size_t j = 0; j < links_.size(); ++j) {
    const MovingLink& link = links_[j];
    const Lump& all = composites_[j];
    const Vec3 t = all.inertia * link.w + all.moment.cross(link.v);
    const Vec3 f = all.mass * link.v + link.w.cross(all.moment);
    const size_t cj = static_cast<size_t>(motions_[j].leader);
    for (size_t i = 0; i < links_.size(); ++i) {
      if ((paths_[j] >> i & 1U) == 0) continue;
      const size_t ci = static_cast<size_t>(motions_[i].leader);
      const double m = links_[i].w.dot(t) + links_[i].v.dot(f);
      mass_[ci][cj] += m;
      if (i != j) mass_[cj][ci] += m;
    }
  }
}

// Newton and Euler from the base outwards and back, all about the one fixed reference point, for
// speeds that do not change: with V = (W, v) the motion of a link (angular velocity, velocity of
// its point at the reference), s its column and I its inertia,
//   A = A_parent + u V x s,  V x s = (W x s.w, W x s.v + v x s.w),  A_base = (0, -g),
//   F = I A + V x* I V,      V x* (n, f) = (W x n + v x f, W x f),
// and what keeps position i at its speed is s_i . (sum of F of all that hangs on it). The forces
// that act are the opposite.
JointArray JointTree::own_forces(const Vec3& gravity, const JointArray& u) const {
  struct Pair {
    Vec3 w, v;
  };
  std::array<Pair, kMaxJoints> motion, acceleration, force;
  const auto momentum = [](const Lump& of, const Pair& m) {
    return Pair{of.inertia * m.w + of.moment.cross(m.v), of.mass * m.v + m.w.cross(of.moment)};
  };
  for (const int k : outward_) {
    const size_t i = static_cast<size_t>(k);
    const MovingLink& link = links_[i];
    const double rate = u[static_cast<size_t>(link.coordinate)];
    const int parent = tree_[i].parent;
    Pair& m = motion[i];
    Pair& a = acceleration[i];
    m = {rate * link.w, rate * link.v};
    a = {Vec3::Zero(), -gravity};
    if (parent >= 0) {
      m.w += motion[static_cast<size_t>(parent)].w;
      m.v += motion[static_cast<size_t>(parent)].v;
      a = acceleration[static_cast<size_t>(parent)];
    }
    a.w += rate * m.w.cross(link.w);
    a.v += rate * (m.w.cross(link.v) + m.v.cross(link.w));
    const Pair inertial = momentum(placed_[i], a), moving = momentum(placed_[i], m);
    force[i] = {inertial.w + m.w.cross(moving.w) + m.v.cross(moving.v),
                inertial.v + m.w.cross(moving.v)};
  }
  JointArray out{};
  for (size_t n = outward_.size(); n-- > 0;) {
    const size_t i = static_cast<size_t>(outward_[n]);
    out[static_cast<size_t>(motions_[i].leader)] -=
        links_[i].w.dot(force[i].w) + links_[i].v.dot(force[i].v);
    if (tree_[i].parent < 0) continue;
    Pair& parent = force[static_cast<size_t>(tree_[i].parent)];
    parent.w += force[i].w;
    parent.v += force[i].v;
  }
  return out;
}

Pose JointTree::pose(const Carrier& carrier) const {
  if (carrier.moving < 0) return base_ * carrier.offset;
  const MovingLink& body = link(carrier.moving);
  return Pose{body.origin, Quat(body.axes)} * carrier.offset;
}

}  // namespace probe::world
