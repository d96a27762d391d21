// The vertex law: what a corner of a triangle shows under lamps, by the formula of fixed-function
// OpenGL (README.md, "Vertex law"). Knows nothing of pixels or textures.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "runtime/render/renderer.h"

namespace probe::render {

using Float3 = Eigen::Vector3f;

// Around some places.
struct Ball {
  Float3 middle = Float3::Zero();
  float radius = 0;
};

// x^e for x in [0, 1], 0^0 being 1: read between 4096 steps, made without a C library's pow.
class PowerTable {
 public:
  explicit PowerTable(double exponent);
  float at(float x) const { return read(values_.data(), x); }
  // Of `values()`: loops over arrays read the table without the object.
  static float read(const float* values, float x) {
    const float place = x * static_cast<float>(kSteps);
    const auto i = static_cast<std::int32_t>(place);
    const float low = values[i];
    return low + (values[i + 1] - low) * (place - static_cast<float>(i));
  }
  // Of many, those beyond [0, 1] being its ends.
  static void read_all(const float* values, const float* x, std::size_t count, float* powers);
  const float* values() const { return values_.data(); }

 private:
  static constexpr int kSteps = 4096;
  std::array<float, kSteps + 2> values_;
};

// What the law reads of a part's material.
struct VertexMaterial {
  std::array<float, 3> color{1, 1, 1};  // 0 .. 1 as bytes have it; what a texture is multiplied by
  std::array<float, 3> emission{0, 0, 0};
  float specular = 0.5f;
  std::shared_ptr<const PowerTable> shine;
};

// Corners as arrays of `count`: where they are, their unit normals, and the colours to be found.
struct CornerArrays {
  std::size_t count = 0;
  std::array<const float*, 3> position{}, normal{};
  std::array<float*, 3> color{};
};

// Lamps as a mesh sees them: places and directions in its frame.
struct LampsThere {
  struct Lamp {
    Float3 place = Float3::Zero();    // of what is no spot the unit direction towards it
    Float3 forward = Float3::Zero();  // unit, the way it shines
    bool is_spot = false;
    float cutoff_cosine = -1;
    const PowerTable* narrowing = nullptr;
    std::array<float, 3> fade{1, 0, 0};
    std::array<float, 3> diffuse{}, specular{}, ambient{};
    // Whether something in the ball may lie in the cone of a spot.
    bool may_reach(const Ball& ball) const;
  };
  std::vector<Lamp> lamps;
  std::array<float, 3> ambient{};
  Float3 eye = Float3::Zero();
  float share = 1;  // of a material's colour, not of its highlight: what a mirror shows

  // Of corners of one material, between 0 and 1; all of them lie in the ball.
  void light(const VertexMaterial& material, const CornerArrays& corners, const Ball& around) const;
  // Of one.
  std::array<float, 3> color_of(const VertexMaterial& material, const Float3& position,
                                const Float3& normal) const;
};

// Lamps in world, checked once.
class LampTable {
 public:
  // Fails (kRender) on a number that is not finite, negative strength, a lamp without direction.
  static Result<LampTable> make(const Lights& lights);
  // `place`: mesh to world. `eye` and `forward`: world, where the camera is and the way it looks,
  // which is the way its headlight shines.
  void put(const Pose& place, const Vec3& eye, const Vec3& forward, LampsThere& there) const;

 private:
  Lights lights_;
  std::vector<std::shared_ptr<const PowerTable>> narrowing_;  // by lamp
};

}  // namespace probe::render
