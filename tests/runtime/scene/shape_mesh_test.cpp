#include "runtime/scene/shape_mesh.h"

#include <doctest/doctest.h>

#include "runtime/base/geometry.h"

using namespace probe;
using Kind = robot::Primitive::Kind;

namespace {

Vec3 at(const std::vector<float>& of, std::uint32_t i) {
  return {of[3 * i], of[3 * i + 1], of[3 * i + 2]};
}

// What the triangles enclose, by the divergence theorem: positive where all look outwards.
double volume_of(const scene::Mesh& mesh) {
  const scene::MeshPart& part = mesh.parts.at(0);
  double volume = 0;
  for (std::size_t t = 0; t < part.indices.size(); t += 3) {
    const auto corner = [&](std::size_t k) { return at(part.positions, part.indices[t + k]); };
    volume += corner(0).dot(corner(1).cross(corner(2))) / 6;
  }
  return volume;
}

scene::Mesh mesh_of(Kind kind, const Vec3& half) {
  return scene::shape_mesh({{kind, half, {}}, {1, 0, 0.5}});
}

}  // namespace

TEST_CASE("drawn shapes enclose their volume, and their normals look outwards") {
  CHECK(volume_of(mesh_of(Kind::kBox, {0.1, 0.2, 0.3})) == doctest::Approx(8 * 0.006));
  // What is round has 32 corners: 1 to 2 % less.
  CHECK(volume_of(mesh_of(Kind::kCylinder, {0.1, 0.1, 0.2})) ==
        doctest::Approx(3.14159265 * 0.01 * 0.4).epsilon(0.02));
  CHECK(volume_of(mesh_of(Kind::kSphere, {0.1, 0.1, 0.1})) ==
        doctest::Approx(4.0 / 3 * 3.14159265 * 0.001).epsilon(0.03));
  for (const Kind kind : {Kind::kBox, Kind::kCylinder, Kind::kSphere}) {
    const scene::Mesh mesh = mesh_of(kind, {0.1, 0.1, 0.1});
    const scene::MeshPart& part = mesh.parts.at(0);
    for (std::size_t t = 0; t < part.indices.size(); t += 3) {
      const auto corner = [&](std::size_t k) { return at(part.positions, part.indices[t + k]); };
      const Vec3 out = (corner(1) - corner(0)).cross(corner(2) - corner(0));
      for (std::size_t k = 0; k < 3; ++k) CHECK(out.dot(at(part.normals, part.indices[t + k])) > 0);
    }
  }
}

TEST_CASE("a drawn shape has its colour as linear light") {
  const scene::Mesh mesh = mesh_of(Kind::kBox, {0.1, 0.1, 0.1});
  CHECK(mesh.materials.at(0).base_color[0] == 1);
  CHECK(mesh.materials.at(0).base_color[1] == 0);
  CHECK(mesh.materials.at(0).base_color[2] == doctest::Approx(0.2158605));
}
