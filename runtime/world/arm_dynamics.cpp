// Before all else: a wrong combination compiles, links and may even run.
#if defined(NDEBUG) && !defined(PROBE_SIMBODY_NDEBUG)
#error "NDEBUG: this Simbody is built without it, and its inline State has another layout with it"
#endif
#if !defined(NDEBUG) && defined(PROBE_SIMBODY_NDEBUG)
#error \
    "no NDEBUG: this Simbody is built with it, and its inline State has another layout without it"
#endif

#include "runtime/world/arm_dynamics.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <Simbody.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>

namespace probe::world {
namespace {

using std::size_t;

SimTK::Vec3 to_simtk(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 from_simtk(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

SimTK::Transform to_simtk(const Pose& pose) {
  const SimTK::Quaternion q(pose.rotation.w(), pose.rotation.x(), pose.rotation.y(),
                            pose.rotation.z());
  return {SimTK::Rotation(q), to_simtk(pose.position)};
}

SimTK::MassProperties to_mass(double mass, const Vec3& moment, const Mat3& i) {
  return {mass, to_simtk(Vec3(moment / mass)),
          SimTK::Inertia(i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2))};
}

Failure world_failure(std::string message) { return {Fault::kWorld, std::move(message), ""}; }

}  // namespace

void ArmDynamics::Lump::add(const robot::Link& link, const Pose& offset) {
  const Mat3 r = offset.rotation.toRotationMatrix();
  const Vec3 c = offset.apply(link.center_of_mass);
  mass += link.mass;
  moment += link.mass * c;
  inertia += r * link.inertia * r.transpose() +
             link.mass * (c.squaredNorm() * Mat3::Identity() - c * c.transpose());
}

bool ArmDynamics::Lump::is_possible() const {
  if (!(mass > 0) || !inertia.allFinite() || !moment.allFinite()) return false;
  const Vec3 c = moment / mass;
  const Mat3 central = inertia - mass * (c.squaredNorm() * Mat3::Identity() - c * c.transpose());
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(central).eigenvalues();
  return moments[0] > 0 && moments[0] + moments[1] >= moments[2] * (1 - 1e-6);
}

MultibodyBuild multibody_build() {
  char debug[64] = "", version[64] = "";
  SimTK_about_SimTKcommon("debug", sizeof debug, debug);
  SimTK_about_SimTKcommon("version", sizeof version, version);
#ifdef NDEBUG
  constexpr bool kAssertsHere = false;
#else
  constexpr bool kAssertsHere = true;
#endif
  return {version, std::string(debug) == "debug", kAssertsHere};
}

Status check_layout(const MultibodyBuild& build) {
  if (build.library_asserts == build.adapter_asserts) return {};
  const char* with[] = {"with NDEBUG", "without NDEBUG"};
  return world_failure("the linked Simbody " + build.version + " is built " +
                       with[build.library_asserts ? 1 : 0] +
                       ", but vlaprobe was compiled for one " +
                       with[build.adapter_asserts ? 1 : 0] + ": their data do not fit");
}

struct ArmDynamics::Simbody {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  std::vector<SimTK::MobilizedBody> bodies;  // by moving link
  std::vector<SimTK::QIndex> q_index;
  SimTK::State state;
};

ArmDynamics::ArmDynamics() : simbody_(std::make_unique<Simbody>()) {}
ArmDynamics::~ArmDynamics() = default;

Result<std::unique_ptr<ArmDynamics>> ArmDynamics::create(const robot::RobotModel& model,
                                                         const Pose& base,
                                                         const std::vector<int>& joints) {
  PROBE_TRY(check_layout(multibody_build()));
  std::unique_ptr<ArmDynamics> arm(new ArmDynamics);
  arm->count_ = static_cast<int>(joints.size());
  arm->base_ = base;
  PROBE_TRY(arm->read_tree(model, joints));
  PROBE_TRY(arm->assemble(model));
  return arm;
}

// From the root outwards: which moving link carries each link, how it moves and what it weighs.
Status ArmDynamics::read_tree(const robot::RobotModel& model, const std::vector<int>& joints) {
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
    return world_failure("a robot may have at most " + std::to_string(kMaxJoints) +
                         " joints that move");
  }
  links_.resize(n), slides_.resize(n), axes_.resize(n), inboard_.resize(n), lumps_.resize(n);
  composites_.resize(n), paths_.resize(n), parents_.assign(n, -1);
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
        parents_[i] = carrier.moving;
        inboard_[i] = carrier.moving < 0 ? base_ * at : at;
        paths_[i] = path(carrier.moving) | (1U << k);
        slides_[i] = joint.kind == robot::JointKind::kPrismatic;
        axes_[i] = joint.axis;
        links_[i].coordinate = motions_[i].leader;
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
  }
  return {};
}

Status ArmDynamics::assemble(const robot::RobotModel& model) {
  try {
    Simbody& simbody = *simbody_;
    simbody.bodies.resize(motions_.size());
    for (const int k : outward_) {
      const size_t i = static_cast<size_t>(k);
      SimTK::MobilizedBody& parent =
          parents_[i] < 0 ? static_cast<SimTK::MobilizedBody&>(simbody.matter.updGround())
                          : simbody.bodies[static_cast<size_t>(parents_[i])];
      // Simbody pins turn about z and sliders move along x: the same turn on both sides keeps the
      // body frame.
      const SimTK::Transform turn(SimTK::Rotation(SimTK::UnitVec3(to_simtk(axes_[i])),
                                                  SimTK::CoordinateAxis(slides_[i] ? 0 : 2)));
      const SimTK::Body::Rigid body(to_mass(lumps_[i].mass, lumps_[i].moment, lumps_[i].inertia));
      const SimTK::Transform frame = to_simtk(inboard_[i]) * turn;
      if (slides_[i]) {
        simbody.bodies[i] = SimTK::MobilizedBody::Slider(parent, frame, body, turn);
      } else {
        simbody.bodies[i] = SimTK::MobilizedBody::Pin(parent, frame, body, turn);
      }
    }
    simbody.system.realizeTopology();
    simbody.state = simbody.system.getDefaultState();
    simbody.system.realizeModel(simbody.state);
    simbody.system.realize(simbody.state, SimTK::Stage::Time);
    for (const SimTK::MobilizedBody& body : simbody.bodies) {
      simbody.q_index.push_back(body.getFirstQIndex(simbody.state));
    }
  } catch (const std::exception& error) {
    return world_failure("the multibody library refuses the robot `" + model.name +
                         "`: " + error.what());
  }
  return {};
}

Status ArmDynamics::update(const JointArray& q) {
  if (count_ == 0 || (fresh_ && q == q_)) return {};
  try {
    Simbody& s = *simbody_;
    SimTK::Vector& all_q = s.state.updQ();
    for (size_t k = 0; k < links_.size(); ++k) {
      const Follower& motion = motions_[k];
      all_q[s.q_index[k]] = motion.scale * q[static_cast<size_t>(motion.leader)] + motion.offset;
    }
    // Only positions: realizing the whole stage also does what nobody here reads.
    s.matter.realizePositionKinematics(s.state);
    for (size_t k = 0; k < links_.size(); ++k) {
      const SimTK::Transform& x = s.bodies[k].getBodyTransform(s.state);
      MovingLink& link = links_[k];
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) link.axes(r, c) = x.R()[r][c];
      }
      link.origin = from_simtk(x.p());
    }
  } catch (const std::exception& error) {
    fresh_ = false;
    return world_failure(std::string("the multibody library failed: ") + error.what());
  }
  for (size_t k = 0; k < links_.size(); ++k) {
    MovingLink& link = links_[k];
    const Vec3 along = motions_[k].scale * (link.axes * axes_[k]);
    link.w = slides_[k] ? Vec3(Vec3::Zero()) : along;
    link.v = slides_[k] ? along : Vec3(along.cross(reference() - link.origin));
  }
  update_mass();
  q_ = q;
  fresh_ = true;
  return {};
}

// Composite inertias about the one reference point, so that they add up and columns need no shift:
// M_ij = column i . momentum of all that hangs on j when j moves at unit speed.
void ArmDynamics::update_mass() {
  for (size_t k = 0; k < links_.size(); ++k) {
    const MovingLink& link = links_[k];
    const Lump& own = lumps_[k];
    Lump& about = composites_[k];
    const Vec3 o = link.origin - reference(), c = link.axes * own.moment;
    about.mass = own.mass;
    about.moment = c + own.mass * o;
    const Mat3 turned = link.axes * own.inertia;
    about.inertia = turned * link.axes.transpose();
    const Vec3 both = own.mass * o + c;  // m o o^T + c o^T + o c^T in two products
    const Mat3 outer = both * o.transpose() + o * c.transpose();
    about.inertia += outer.trace() * Mat3::Identity() - outer;
  }
  for (size_t n = outward_.size(); n-- > 0;) {
    const size_t k = static_cast<size_t>(outward_[n]);
    if (parents_[k] < 0) continue;
    Lump& parent = composites_[static_cast<size_t>(parents_[k])];
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
    const size_t cj = static_cast<size_t>(link.coordinate);
    for (size_t i = 0; i < links_.size(); ++i) {
      if ((paths_[j] >> i & 1U) == 0) continue;
      const size_t ci = static_cast<size_t>(links_[i].coordinate);
      const double m = links_[i].w.dot(t) + links_[i].v.dot(f);
      mass_[ci][cj] += m;
      if (i != j) mass_[cj][ci] += m;
    }
  }
}

JointMatrix ArmDynamics::library_mass() const {
  JointMatrix out{};
  SimTK::Matrix m;
  simbody_->system.realize(simbody_->state, SimTK::Stage::Position);
  simbody_->matter.calcM(simbody_->state, m);
  for (size_t a = 0; a < motions_.size(); ++a) {
    for (size_t b = 0; b < motions_.size(); ++b) {
      // The library orders speeds as positions: one a body here.
      out[static_cast<size_t>(motions_[a].leader)][static_cast<size_t>(motions_[b].leader)] +=
          motions_[a].scale * motions_[b].scale *
          m(static_cast<int>(simbody_->q_index[a]), static_cast<int>(simbody_->q_index[b]));
    }
  }
  return out;
}

Pose ArmDynamics::pose(const Carrier& carrier) const {
  if (carrier.moving < 0) return base_ * carrier.offset;
  const MovingLink& body = link(carrier.moving);
  return Pose{body.origin, Quat(body.axes)} * carrier.offset;
}

}  // namespace probe::world
