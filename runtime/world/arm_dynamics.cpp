#include "runtime/world/arm_dynamics.h"

#ifdef NDEBUG
#error "Debian's libsimbody is built without NDEBUG and its inline State has another layout with it"
#endif

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <Simbody.h>
#pragma GCC diagnostic pop

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

// Mass, first moment and inertia about the frame's origin.
struct Lump {
  double mass = 0;
  Vec3 moment = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();

  void add(const robot::Link& link, const Pose& offset) {
    const Mat3 r = offset.rotation.toRotationMatrix();
    const Vec3 c = offset.apply(link.center_of_mass);
    mass += link.mass;
    moment += link.mass * c;
    inertia += r * link.inertia * r.transpose() +
               link.mass * (c.squaredNorm() * Mat3::Identity() - c * c.transpose());
  }
};

SimTK::MassProperties to_simtk(const Lump& lump) {
  const Mat3& i = lump.inertia;
  return {lump.mass, to_simtk(Vec3(lump.moment / lump.mass)),
          SimTK::Inertia(i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2))};
}

Failure world_failure(std::string message) { return {"world", std::move(message), ""}; }

// A mass and principal moments that some distribution of matter has.
bool is_possible(const Lump& lump) {
  if (!(lump.mass > 0) || !lump.inertia.allFinite() || !lump.moment.allFinite()) return false;
  const Vec3 c = lump.moment / lump.mass;
  const Mat3 central =
      lump.inertia - lump.mass * (c.squaredNorm() * Mat3::Identity() - c * c.transpose());
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(central).eigenvalues();
  return moments[0] > 0 && moments[0] + moments[1] >= moments[2] * (1 - 1e-6);
}

}  // namespace

struct ArmDynamics::Simbody {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  std::vector<SimTK::MobilizedBody> bodies;  // by joint
  SimTK::State state;
};

ArmDynamics::ArmDynamics() : simbody_(std::make_unique<Simbody>()) {}
ArmDynamics::~ArmDynamics() = default;

Result<std::unique_ptr<ArmDynamics>> ArmDynamics::create(const robot::RobotModel& model,
                                                         const Pose& base,
                                                         const std::vector<int>& joints) {
  if (joints.size() > kMaxJoints) {
    return world_failure("a robot may have at most " + std::to_string(kMaxJoints) +
                         " driven joints");
  }
  std::vector<int> order_of_joint(model.joints.size(), -1);
  for (size_t k = 0; k < joints.size(); ++k)
    order_of_joint[static_cast<size_t>(joints[k])] = static_cast<int>(k);
  for (size_t i = 0; i < model.joints.size(); ++i) {
    if (model.joints[i].kind != robot::JointKind::kFixed && order_of_joint[i] < 0) {
      return world_failure("joint `" + model.joints[i].name + "` moves but has no drive");
    }
  }

  std::unique_ptr<ArmDynamics> arm(new ArmDynamics);
  arm->count_ = static_cast<int>(joints.size());
  arm->base_ = base;
  arm->carriers_.resize(model.links.size());

  // From the root outwards: which moving link carries each link, and what each moving link weighs.
  std::vector<Lump> lumps(joints.size());
  std::vector<int> outward{model.root};
  std::vector<int> joint_order;  // of joints, parents first
  std::vector<int> parent_carrier(joints.size(), -1);
  std::vector<Pose> inboard(joints.size());
  for (size_t next = 0; next < outward.size(); ++next) {
    const int link = outward[next];
    const Carrier carrier = arm->carriers_[static_cast<size_t>(link)];
    if (carrier.joint >= 0) {
      lumps[static_cast<size_t>(carrier.joint)].add(model.links[static_cast<size_t>(link)],
                                                    carrier.offset);
    }
    for (size_t j = 0; j < model.joints.size(); ++j) {
      const robot::Joint& joint = model.joints[j];
      if (joint.parent_link != link) continue;
      const Pose at = carrier.offset * joint.origin;
      const int k = order_of_joint[j];
      Carrier& child = arm->carriers_[static_cast<size_t>(joint.child_link)];
      if (k < 0 || joint.kind == robot::JointKind::kFixed) {
        child = {carrier.joint, at};
      } else {
        child = {k, Pose{}};
        parent_carrier[static_cast<size_t>(k)] = carrier.joint;
        inboard[static_cast<size_t>(k)] = carrier.joint < 0 ? base * at : at;
        arm->paths_[static_cast<size_t>(k)] = arm->path(carrier.joint) | (1U << k);
        joint_order.push_back(k);
      }
      outward.push_back(joint.child_link);
      if (outward.size() > model.links.size())
        return world_failure("the robot's links form a loop");
    }
  }
  for (size_t k = 0; k < joints.size(); ++k) {
    const robot::Joint& joint = model.joints[static_cast<size_t>(joints[k])];
    if (!is_possible(lumps[k])) {
      return world_failure(
          "link `" + model.links[static_cast<size_t>(joint.child_link)].name +
          "` and what is fixed to it have a mass or inertia that no body can have");
    }
  }

  try {
    Simbody& simbody = *arm->simbody_;
    simbody.bodies.resize(joints.size());
    for (const int k : joint_order) {
      const size_t i = static_cast<size_t>(k);
      const robot::Joint& joint = model.joints[static_cast<size_t>(joints[i])];
      const bool slides = joint.kind == robot::JointKind::kPrismatic;
      SimTK::MobilizedBody& parent =
          parent_carrier[i] < 0 ? static_cast<SimTK::MobilizedBody&>(simbody.matter.updGround())
                                : simbody.bodies[static_cast<size_t>(parent_carrier[i])];
      // Simbody pins turn about z and sliders move along x: the same turn on both sides keeps the
      // body frame.
      const SimTK::Transform turn(SimTK::Rotation(SimTK::UnitVec3(to_simtk(joint.axis)),
                                                  SimTK::CoordinateAxis(slides ? 0 : 2)));
      const SimTK::Body::Rigid body(to_simtk(lumps[i]));
      const SimTK::Transform frame = to_simtk(inboard[i]) * turn;
      if (slides) {
        simbody.bodies[i] = SimTK::MobilizedBody::Slider(parent, frame, body, turn);
      } else {
        simbody.bodies[i] = SimTK::MobilizedBody::Pin(parent, frame, body, turn);
      }
    }
    simbody.system.realizeTopology();
    simbody.state = simbody.system.getDefaultState();
    simbody.system.realizeModel(simbody.state);
  } catch (const std::exception& error) {
    return world_failure(std::string("the multibody library refuses the robot: ") + error.what());
  }
  return arm;
}

Status ArmDynamics::update(const JointArray& q) {
  if (count_ == 0 || (fresh_ && q == q_)) return {};
  try {
    Simbody& s = *simbody_;
    SimTK::Vector& all_q = s.state.updQ();
    for (size_t k = 0; k < s.bodies.size(); ++k) all_q[s.bodies[k].getFirstQIndex(s.state)] = q[k];
    s.system.realize(s.state, SimTK::Stage::Position);
    s.matter.realizeCompositeBodyInertias(s.state);
    for (size_t k = 0; k < s.bodies.size(); ++k) {
      const SimTK::Transform& x = s.bodies[k].getBodyTransform(s.state);
      MovingLink& link = links_[k];
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) link.axes(r, c) = x.R()[r][c];
      }
      link.origin = from_simtk(x.p());
      const SimTK::SpatialVec column = s.bodies[k].getHCol(s.state, SimTK::MobilizerUIndex(0));
      link.w = from_simtk(column[0]);
      link.h = from_simtk(column[1]);
    }
    for (size_t j = 0; j < s.bodies.size(); ++j) {
      const MovingLink& link = links_[j];
      const SimTK::SpatialInertia& inertia =
          s.matter.getCompositeBodyInertia(s.state, s.bodies[j].getMobilizedBodyIndex());
      const SimTK::SpatialVec momentum =
          inertia * SimTK::SpatialVec(to_simtk(link.w), to_simtk(link.h));
      const Vec3 t = from_simtk(momentum[0]), f = from_simtk(momentum[1]);
      for (size_t i = 0; i < s.bodies.size(); ++i) {
        if ((paths_[j] >> i & 1U) == 0) continue;
        const double m =
            links_[i].w.dot(t + (link.origin - links_[i].origin).cross(f)) + links_[i].h.dot(f);
        mass_[i][j] = m;
        mass_[j][i] = m;
      }
    }
  } catch (const std::exception& error) {
    fresh_ = false;
    return world_failure(std::string("the multibody library failed: ") + error.what());
  }
  q_ = q;
  fresh_ = true;
  return {};
}

Pose ArmDynamics::pose(const Carrier& carrier) const {
  if (carrier.joint < 0) return base_ * carrier.offset;
  const MovingLink& body = link(carrier.joint);
  return Pose{body.origin, Quat(body.axes)} * carrier.offset;
}

}  // namespace probe::world
