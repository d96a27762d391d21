// Small meshes and scenes for the tests of this folder.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "runtime/render/renderer.h"

namespace probe::render::test {

// A camera at the origin that looks along +x, left is +y.
inline Camera plain_camera(int width = 640, int height = 480) {
  return {.position = Vec3::Zero(),
          .forward_left_up = Mat3::Identity(),
          .width = width,
          .height = height,
          .fx = 623.588 * width / 640,
          .fy = 623.588 * height / 480,
          .cx = 319.501 * width / 640,
          .cy = 239.545 * height / 480};
}

inline Pose at(double x, double y, double z) { return {Vec3(x, y, z), Quat::Identity()}; }

inline scene::MeshPart quad_part(const Vec3& center, const Vec3& across, const Vec3& up) {
  scene::MeshPart part;
  const Vec3 normal = across.cross(up).normalized();
  // uv (0, 0) lies at center - across + up: the texture's upper left.
  for (const auto& [a, b] : {std::pair{-1, 1}, {1, 1}, {1, -1}, {-1, -1}}) {
    const Vec3 p = center + a * across + b * up;
    for (int k = 0; k < 3; ++k) {
      part.positions.push_back(static_cast<float>(p[k]));
      part.normals.push_back(static_cast<float>(normal[k]));
    }
    part.uv.push_back(a < 0 ? 0.0f : 1.0f);
    part.uv.push_back(b > 0 ? 0.0f : 1.0f);
  }
  part.indices = {0, 2, 1, 0, 3, 2};
  return part;
}

inline std::shared_ptr<scene::Mesh> colored(scene::MeshPart part, float albedo) {
  auto mesh = std::make_shared<scene::Mesh>();
  mesh->name = "test mesh";
  mesh->materials.push_back({.base_color = {albedo, albedo, albedo}, .f0 = 0});
  mesh->parts.push_back(std::move(part));
  return mesh;
}

// Faces the plain camera: a square in the y-z plane of the given half side.
inline std::shared_ptr<scene::Mesh> square(double half, float albedo = 0.5f) {
  return colored(quad_part(Vec3::Zero(), Vec3(0, -half, 0), Vec3(0, 0, half)), albedo);
}

inline std::shared_ptr<scene::Mesh> sphere(double radius, int segments, float albedo = 0.5f) {
  scene::MeshPart part;
  const int rings = segments / 2;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j <= segments; ++j) {
      const double theta = M_PI * i / rings, phi = 2 * M_PI * j / segments;
      const Vec3 n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                   std::cos(theta));
      for (int k = 0; k < 3; ++k) {
        part.positions.push_back(static_cast<float>(radius * n[k]));
        part.normals.push_back(static_cast<float>(n[k]));
      }
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      const auto a = static_cast<std::uint32_t>(i * (segments + 1) + j);
      const auto b = a + static_cast<std::uint32_t>(segments) + 1;
      part.indices.insert(part.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  }
  return colored(std::move(part), albedo);
}

inline Lights table_lights() {
  return {.ambient = 0.3,
          .suns = {{Vec3(0, 0, -1), 2.2}, {Vec3(-1, -0.5, -1), 0.7}, {Vec3(1, 1, -1), 0.7}}};
}

inline Visual visual(std::shared_ptr<const scene::Mesh> mesh, std::uint16_t body,
                     const char* name) {
  return {.mesh = std::move(mesh), .origin = {}, .body = body, .name = name};
}

}  // namespace probe::render::test
