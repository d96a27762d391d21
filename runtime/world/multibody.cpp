// Before all else: a wrong combination compiles, links and may even run.
#if defined(NDEBUG) && !defined(PROBE_SIMBODY_NDEBUG)
#error "NDEBUG: this Simbody is built without it, and its inline State has another layout with it"
#endif
#if !defined(NDEBUG) && defined(PROBE_SIMBODY_NDEBUG)
#error \
    "no NDEBUG: this Simbody is built with it, and its inline State has another layout without it"
#endif

#include "runtime/world/multibody.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <Simbody.h>
#pragma GCC diagnostic pop

#include <exception>

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

Mat3 from_simtk(const SimTK::Rotation& r) {
  Mat3 m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m(i, j) = r[i][j];
  }
  return m;
}

SimTK::MassProperties to_mass(double mass, const Vec3& moment, const Mat3& i) {
  return {mass, to_simtk(Vec3(moment / mass)),
          SimTK::Inertia(i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2))};
}

Failure world_failure(std::string message) { return {Fault::kWorld, std::move(message), ""}; }

}  // namespace

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

struct Multibody::Model {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  std::vector<SimTK::MobilizedBody> bodies;  // by link
  std::vector<SimTK::QIndex> q_index;
  SimTK::State state;
};

Multibody::Multibody() : model_(std::make_unique<Model>()) {}
Multibody::~Multibody() = default;

Result<std::unique_ptr<Multibody>> Multibody::create(const std::string& name,
                                                     const std::vector<TreeLink>& links,
                                                     const std::vector<int>& outward) {
  PROBE_TRY(check_layout(multibody_build()));
  try {
    std::unique_ptr<Multibody> made(new Multibody);
    Model& model = *made->model_;
    model.bodies.resize(links.size());
    for (const int k : outward) {
      const size_t i = static_cast<size_t>(k);
      const TreeLink& link = links[i];
      SimTK::MobilizedBody& parent =
          link.parent < 0 ? static_cast<SimTK::MobilizedBody&>(model.matter.updGround())
                          : model.bodies[static_cast<size_t>(link.parent)];
      // Simbody pins turn about z and sliders move along x: the same turn on both sides keeps the
      // body frame.
      const SimTK::Transform turn(SimTK::Rotation(SimTK::UnitVec3(to_simtk(link.axis)),
                                                  SimTK::CoordinateAxis(link.slides ? 0 : 2)));
      const SimTK::Body::Rigid body(to_mass(link.mass, link.moment, link.inertia));
      const SimTK::Transform frame = to_simtk(link.inboard) * turn;
      if (link.slides) {
        model.bodies[i] = SimTK::MobilizedBody::Slider(parent, frame, body, turn);
      } else {
        model.bodies[i] = SimTK::MobilizedBody::Pin(parent, frame, body, turn);
      }
    }
    model.system.realizeTopology();
    model.state = model.system.getDefaultState();
    model.system.realizeModel(model.state);
    for (const SimTK::MobilizedBody& body : model.bodies) {
      model.q_index.push_back(body.getFirstQIndex(model.state));
    }
    return made;
  } catch (const std::exception& error) {
    return world_failure("the multibody library refuses `" + name + "`: " + error.what());
  }
}

std::vector<JointFrame> Multibody::frames() const {
  std::vector<JointFrame> frames;
  for (const SimTK::MobilizedBody& body : model_->bodies) {
    const SimTK::Transform& in = body.getDefaultInboardFrame();
    const SimTK::Transform& out = body.getDefaultOutboardFrame();
    frames.push_back({from_simtk(in.R()), from_simtk(in.p()), from_simtk(out.R()).transpose()});
  }
  return frames;
}

Result<Multibody::Placed> Multibody::place(const std::vector<double>& q) {
  try {
    Model& m = *model_;
    SimTK::Vector& all_q = m.state.updQ();
    for (size_t k = 0; k < q.size(); ++k) all_q[m.q_index[k]] = q[k];
    m.system.realize(m.state, SimTK::Stage::Position);
    Placed placed;
    for (const SimTK::MobilizedBody& body : m.bodies) {
      const SimTK::Transform& x = body.getBodyTransform(m.state);
      placed.axes.push_back(from_simtk(x.R()));
      placed.origins.push_back(from_simtk(x.p()));
    }
    SimTK::Matrix mass;
    m.matter.calcM(m.state, mass);
    // The library orders speeds as positions: one a body here.
    for (size_t a = 0; a < q.size(); ++a) {
      placed.mass.emplace_back();
      for (size_t b = 0; b < q.size(); ++b) {
        placed.mass.back().push_back(
            mass(static_cast<int>(m.q_index[a]), static_cast<int>(m.q_index[b])));
      }
    }
    return placed;
  } catch (const std::exception& error) {
    return world_failure(std::string("the multibody library failed: ") + error.what());
  }
}

}  // namespace probe::world
