// A part of a placed mesh as a camera sees it: where its vertices lie in pixels, and the rectangle
// of pixels that each of its triangles can meet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/render/camera_rays.h"
#include "runtime/render/mesh_geometry.h"
#include "runtime/render/top_scene.h"

namespace probe::render {

// Pixels, not cut at the picture's edges.
struct PixelBounds {
  float min_x, max_x, min_y, max_y;
};

// Gives (x z, y z, z) of a point in an instance's mesh frame: pixels and metres of depth. Three
// rows of four, row by row.
struct Projection {
  float rows[12];
};
// From the floats that Embree was given, so that both see the same triangles.
Projection projection_of(const Instance& instance, const Camera& camera);

// Keeps its memory from part to part.
class ProjectedPart {
 public:
  void project(const MeshGeometry::Part& part, const Projection& projection);

  // Of the last part, one a vertex. Behind the camera only the depth means something.
  const float* x() const { return x_.data(); }
  const float* y() const { return y_.data(); }
  const float* depth() const { return z_.data(); }
  const float* closeness() const { return w_.data(); }  // 1 / depth

  // Of the part's triangle that begins at `index` (three a triangle): what of it lies beyond
  // `nearest`, with room for rounding. False if nothing does.
  bool bounds(const MeshGeometry::Part& part, std::size_t index, float nearest,
              PixelBounds& out) const {
    const std::uint32_t* v = part.indices.data() + index;
    const auto least = [v](const std::vector<float>& of) {
      const float a = of[v[0]], b = of[v[1]], c = of[v[2]];
      const float ab = a < b ? a : b;
      return ab < c ? ab : c;
    };
    const auto greatest = [v](const std::vector<float>& of) {
      const float a = of[v[0]], b = of[v[1]], c = of[v[2]];
      const float ab = a > b ? a : b;
      return ab > c ? ab : c;
    };
    if (least(z_) > nearest) {
      out = {least(x_), greatest(x_), least(y_), greatest(y_)};
      return true;
    }
    return greatest(z_) > nearest && cut_bounds(part, v, nearest, out);
  }

 private:
  bool cut_bounds(const MeshGeometry::Part& part, const std::uint32_t* vertices, float nearest,
                  PixelBounds& out) const;

  Projection projection_{};
  std::vector<float> x_, y_, z_, w_;
};

}  // namespace probe::render
