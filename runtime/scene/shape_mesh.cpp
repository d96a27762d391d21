#include "runtime/scene/shape_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "runtime/base/trig.h"
#include "runtime/scene/color.h"

namespace probe::scene {
namespace {

constexpr std::size_t kAround = 32;  // corners of a circle
constexpr std::size_t kRings = 16;   // of a sphere, from pole to pole

// Triangles whose corners have normals of their own.
class Builder {
 public:
  explicit Builder(MeshPart& part) : part_(part) {}

  std::uint32_t add(const Vec3& at, const Vec3& normal) {
    for (int k = 0; k < 3; ++k) part_.positions.push_back(static_cast<float>(at[k]));
    for (int k = 0; k < 3; ++k) part_.normals.push_back(static_cast<float>(normal[k]));
    return static_cast<std::uint32_t>(part_.positions.size() / 3 - 1);
  }
  // Against the clock as seen from outside.
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t corner : {a, b, c}) part_.indices.push_back(corner);
  }
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }

 private:
  MeshPart& part_;
};

Vec3 on_circle(std::size_t i) {
  const double turn = 2 * std::numbers::pi * static_cast<double>(i % kAround) / kAround;
  return {portable_cos(turn), portable_sin(turn), 0};
}

void add_box(Builder& to, const Vec3& half) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const Vec3 out = side * Vec3::Unit(axis);
      const Vec3 u = Vec3::Unit((axis + 1) % 3), v = side * Vec3::Unit((axis + 2) % 3);
      const auto corner = [&](double a, double b) {
        return to.add(half.cwiseProduct(out + a * u + b * v), out);
      };
      const std::uint32_t a = corner(-1, -1), b = corner(1, -1), c = corner(1, 1),
                          d = corner(-1, 1);
      to.quad(a, b, c, d);
    }
  }
}

void add_cylinder(Builder& to, double radius, double half) {
  const Vec3 up = half * Vec3::UnitZ();
  for (std::size_t i = 0; i < kAround; ++i) {
    const Vec3 a = on_circle(i), b = on_circle(i + 1);
    const std::uint32_t low_a = to.add(radius * a - up, a), low_b = to.add(radius * b - up, b),
                        high_b = to.add(radius * b + up, b), high_a = to.add(radius * a + up, a);
    to.quad(low_a, low_b, high_b, high_a);
    for (const double side : {-1.0, 1.0}) {
      const Vec3 out = side * Vec3::UnitZ();
      const std::uint32_t middle = to.add(side * up, out),
                          first = to.add(radius * (side > 0 ? a : b) + side * up, out),
                          second = to.add(radius * (side > 0 ? b : a) + side * up, out);
      to.triangle(middle, first, second);
    }
  }
}

void add_sphere(Builder& to, double radius) {
  const auto at = [&](std::size_t ring, std::size_t i) {
    const double down = std::numbers::pi * static_cast<double>(ring) / kRings;
    const Vec3 out = portable_sin(down) * on_circle(i) + portable_cos(down) * Vec3::UnitZ();
    return to.add(radius * out, out);
  };
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    for (std::size_t i = 0; i < kAround; ++i) {
      const std::uint32_t a = at(ring, i), b = at(ring + 1, i), c = at(ring + 1, i + 1),
                          d = at(ring, i + 1);
      if (ring + 1 < kRings) to.triangle(a, b, c);
      if (ring > 0) to.triangle(a, c, d);
    }
  }
}

}  // namespace

Mesh shape_mesh(const robot::DrawnPrimitive& drawn) {
  Mesh mesh;
  mesh.parts.emplace_back();
  Builder builder(mesh.parts.back());
  const Vec3& half = drawn.shape.half;
  switch (drawn.shape.kind) {
    case robot::Primitive::Kind::kBox:
      mesh.name = "box";
      add_box(builder, half);
      break;
    case robot::Primitive::Kind::kCylinder:
      mesh.name = "cylinder";
      add_cylinder(builder, half.x(), half.z());
      break;
    case robot::Primitive::Kind::kSphere:
      mesh.name = "sphere";
      add_sphere(builder, half.x());
      break;
  }
  Material material;
  for (int k = 0; k < 3; ++k) {
    const double byte = std::clamp(std::floor(drawn.color[k] * 255 + 0.5), 0.0, 255.0);
    material.base_color[static_cast<std::size_t>(k)] =
        kSrgbToLinear[static_cast<std::size_t>(byte)];
  }
  mesh.materials.push_back(material);
  return mesh;
}

}  // namespace probe::scene
