#include "runtime/mjcf/mass.h"

#include <cmath>
#include <numbers>

namespace probe::mjcf {
namespace {

// Of density 1 about the geom's centre, in its axes.
MassProperties primitive(const Geom& geom) {
  constexpr double kPi = std::numbers::pi;
  const Vec3& s = geom.size;
  MassProperties m;
  const auto diagonal = [&](double x, double y, double z) {
    m.inertia = (m.mass * Vec3(x, y, z)).asDiagonal();
  };
  switch (geom.shape) {
    case Shape::kSphere:
      m.mass = 4 * kPi * s[0] * s[0] * s[0] / 3;
      diagonal(0.4 * s[0] * s[0], 0.4 * s[0] * s[0], 0.4 * s[0] * s[0]);
      break;
    case Shape::kEllipsoid:
      m.mass = 4 * kPi * s[0] * s[1] * s[2] / 3;
      diagonal((s[1] * s[1] + s[2] * s[2]) / 5, (s[0] * s[0] + s[2] * s[2]) / 5,
               (s[0] * s[0] + s[1] * s[1]) / 5);
      break;
    case Shape::kBox:
      m.mass = 8 * s[0] * s[1] * s[2];
      diagonal((s[1] * s[1] + s[2] * s[2]) / 3, (s[0] * s[0] + s[2] * s[2]) / 3,
               (s[0] * s[0] + s[1] * s[1]) / 3);
      break;
    case Shape::kCylinder: {
      const double height = 2 * s[1];
      m.mass = kPi * s[0] * s[0] * height;
      const double across = (3 * s[0] * s[0] + height * height) / 12;
      diagonal(across, across, s[0] * s[0] / 2);
      break;
    }
    case Shape::kCapsule: {
      const double r = s[0], height = 2 * s[1];
      const double ball = 4 * kPi * r * r * r / 3, tube = kPi * r * r * height;
      m.mass = ball + tube;
      const double along = tube * r * r / 2 + ball * 0.4 * r * r;
      // The two halves of the ball stand h / 2 off the middle, their own centres 3 r / 8 farther.
      const double across = tube * (3 * r * r + height * height) / 12 +
                            ball * (0.4 * r * r + height * height / 4 + 3 * r * height / 8);
      m.inertia = Vec3(across, across, along).asDiagonal();
      break;
    }
    case Shape::kPlane:
    case Shape::kMesh:
      break;
  }
  return m;
}

Vec3 corner(const scene::MeshPart& part, std::uint32_t i) {
  return {part.positions[3 * i], part.positions[3 * i + 1], part.positions[3 * i + 2]};
}

template <typename Use>
void each_triangle(const scene::Mesh& mesh, const Use& use) {
  for (const scene::MeshPart& part : mesh.parts) {
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3)
      use(corner(part, part.indices[i]), corner(part, part.indices[i + 1]),
          corner(part, part.indices[i + 2]));
  }
}

Mat3 parallel(const Vec3& offset) {
  return offset.squaredNorm() * Mat3::Identity() - offset * offset.transpose();
}

}  // namespace

MassProperties moved(const MassProperties& mass, const Pose& pose) {
  const Mat3 turn = pose.rotation.toRotationMatrix();
  return {mass.mass, pose.apply(mass.center), turn * mass.inertia * turn.transpose()};
}

MassProperties joined(const MassProperties& a, const MassProperties& b) {
  if (a.mass == 0 && b.mass == 0) return {0, a.center, a.inertia + b.inertia};
  MassProperties m;
  m.mass = a.mass + b.mass;
  m.center = (a.mass * a.center + b.mass * b.center) / m.mass;
  m.inertia = a.inertia + a.mass * parallel(a.center - m.center) + b.inertia +
              b.mass * parallel(b.center - m.center);
  return m;
}

MassProperties solid_of(const scene::Mesh& mesh, bool exact) {
  double area = 0;
  Vec3 middle = Vec3::Zero();
  each_triangle(mesh, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const double part = (b - a).cross(c - a).norm() / 2;
    area += part;
    middle += part * (a + b + c) / 3;
  });
  if (area > 0) middle /= area;
  const auto pyramid = [&](const Vec3& apex, const Vec3& a, const Vec3& b, const Vec3& c) {
    const double volume = (a - apex).dot((b - a).cross(c - a)) / 6;
    return exact ? volume : std::abs(volume);
  };
  MassProperties m;
  double volume = 0;
  each_triangle(mesh, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const double part = pyramid(middle, a, b, c);
    volume += part;
    m.center += part * ((a + b + c) / 4 + middle / 4);
  });
  if (!(std::abs(volume) > 1e-15)) return {};
  m.center /= volume;
  Mat3 second = Mat3::Zero();  // integral of x x^T about the centre
  each_triangle(mesh, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const double part = pyramid(m.center, a, b, c);
    m.mass += part;
    const Vec3 d = a - m.center, e = b - m.center, f = c - m.center, sum = d + e + f;
    second += part / 20 *
              (d * d.transpose() + e * e.transpose() + f * f.transpose() + sum * sum.transpose());
  });
  m.inertia = second.trace() * Mat3::Identity() - second;
  return m;
}

Mat3 inertia_frame(const Mat3& inertia) {
  constexpr double kNothing = 1e-12;
  constexpr int kMostTurns = 500;
  Quat turn = Quat::Identity();
  const auto seen = [&]() -> Mat3 {
    const Mat3 axes = turn.toRotationMatrix();
    return axes.transpose() * inertia * axes;
  };
  Mat3 left = seen();
  for (int i = 0; i < kMostTurns; ++i) {
    // The largest of what is beside the diagonal, and the axis that it is turned away about.
    Eigen::Index row = 1, column = 2, axis = 0;
    if (std::abs(left(0, 1)) > std::abs(left(0, 2)) &&
        std::abs(left(0, 1)) > std::abs(left(1, 2))) {
      row = 0, column = 1, axis = 2;
    } else if (std::abs(left(0, 2)) > std::abs(left(1, 2))) {
      row = 0, column = 2, axis = 1;
    }
    if (std::abs(left(row, column)) < kNothing) break;
    const double tau = (left(column, column) - left(row, row)) / (2 * left(row, column));
    const double tangent = (tau >= 0 ? 1 : -1) / (std::abs(tau) + std::sqrt(1 + tau * tau));
    const double cosine = 1 / std::sqrt(1 + tangent * tangent);
    if (cosine > 1 - kNothing) break;
    const double half = std::sqrt(0.5 - 0.5 * cosine) * ((tau >= 0) == (axis == 1) ? 1 : -1);
    Vec3 along = Vec3::Zero();
    along[axis] = half;
    turn = (turn * Quat(std::sqrt(1 - half * half), along.x(), along.y(), along.z())).normalized();
    left = seen();
  }
  Vec3 moments = left.diagonal();
  for (const Eigen::Index first : {0, 1, 0}) {
    if (moments[first] + kNothing >= moments[first + 1]) continue;
    std::swap(moments[first], moments[first + 1]);
    constexpr double kQuarter = 0.70710678118654752;
    Vec3 along = Vec3::Zero();
    along[(first + 2) % 3] = kQuarter;
    turn = (turn * Quat(kQuarter, along.x(), along.y(), along.z())).normalized();
  }
  return turn.toRotationMatrix();
}

bool has_mass(const Model& model, const Body& body, const Geom& geom) {
  const Compiler& c = model.compiler;
  if (c.inertia_from_geom == Compiler::FromGeom::kNever) return false;
  if (c.inertia_from_geom == Compiler::FromGeom::kAuto && body.inertial) return false;
  return geom.group >= c.first_group && geom.group <= c.last_group && geom.shape != Shape::kPlane;
}

Result<MassProperties> mass_of(const Model& model, const Body& body,
                               std::span<const MassProperties> solids) {
  MassProperties all;
  const bool said =
      body.inertial && model.compiler.inertia_from_geom != Compiler::FromGeom::kAlways;
  if (said) {
    all = moved({body.inertial->mass, Vec3::Zero(), body.inertial->inertia}, body.inertial->pose);
  }
  for (const Geom& geom : body.geoms) {
    if (!has_mass(model, body, geom) || (geom.mass && *geom.mass == 0)) continue;
    const bool is_mesh = geom.shape == Shape::kMesh;
    const auto mesh = static_cast<std::size_t>(geom.mesh);
    if (geom.shell || (is_mesh && model.meshes[mesh].inertia == MeshAsset::Inertia::kShell))
      return Failure{Fault::kAsset, "a mass on the surface of a geom is not read",
                     model.where(geom.at)};
    MassProperties own = is_mesh ? solids[mesh] : primitive(geom);
    const double density = !geom.mass ? geom.density : own.mass > 0 ? *geom.mass / own.mass : 0;
    if (geom.mass && density == 0)
      return Failure{Fault::kAsset, "a mass without a volume", model.where(geom.at)};
    own.mass *= density;
    own.inertia *= density;
    all = joined(all, moved(own, geom.pose));
  }
  if (all.mass > 0 || body.inertial) {
    all.mass = std::max(all.mass, model.compiler.bound_mass);
    if (model.compiler.bound_inertia > 0) {
      const Eigen::SelfAdjointEigenSolver<Mat3> axes(all.inertia);
      const Vec3 moments = axes.eigenvalues().cwiseMax(model.compiler.bound_inertia);
      all.inertia = axes.eigenvectors() * moments.asDiagonal() * axes.eigenvectors().transpose();
    }
  }
  return all;
}

}  // namespace probe::mjcf
