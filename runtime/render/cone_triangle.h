// A triangle as the cone of rays that meet it, in doubles: also one that reaches behind the camera,
// or far beyond its picture, where corners have no place in pixels that could be trusted.
#pragma once

#include <cstdint>

#include "runtime/render/camera_rays.h"
#include "runtime/render/hit_sheet.h"

namespace probe::render {

// Pixels, both ends included.
struct PixelRectangle {
  float x0, x1, y0, y1;
};

struct ValueRange {
  float low, high;
};
// Of a x + b y + c in a rectangle.
inline ValueRange range_in(const PixelRectangle& in, float a, float b, float c) {
  const float ax0 = a * in.x0, ax1 = a * in.x1, by0 = b * in.y0, by1 = b * in.y1;
  return {c + (ax0 < ax1 ? ax0 : ax1) + (by0 < by1 ? by0 : by1),
          c + (ax0 < ax1 ? ax1 : ax0) + (by0 < by1 ? by1 : by0)};
}

// Edge values are products of unit vectors; those of rays are wrong by less than this.
inline constexpr float kConeDoubt = 1e-5f;
inline constexpr float kConeRoom = 1.0f;  // pixels

// What the cones of a camera share.
struct ConeView {
  ConeView() = default;
  explicit ConeView(const Camera& camera);

  Vec3 forward, right, down;
  Vec3 corner;  // of rays through pixel (0, 0), with a forward part of 1
  Vec3 eye;
  double fx = 1, fy = 1, cx = 0, cy = 0;
  float longest = 1;      // ray, with a forward part of 1
  float across = 0;       // pixels a radian straight ahead
  float depth_doubt = 0;  // how wrong a solid triangle's depth may be
};

// Seen from the camera's place, a ray through pixel (x, y) meets the triangle where the three
// values a x + b y + c, one an edge, are positive; their weighted sum is 1 / depth.
struct ConeTriangle {
  float a[3], b[3], c[3];
  PixelRectangle bounds;
  float closeness_a, closeness_b, closeness_c;
  float closest;  // 1 / the nearest corner's depth, infinite where that is behind the camera
  // Of a sample alone: how wrong the edges' values may be in Embree and here, and places, m.
  float touch[3], doubt;
  bool thin;  // rounding could turn it over

  // `corners`: seen from the camera's place, along the world's axes. False of one behind it.
  static bool make(const Vec3 (&corners)[3], double doubt, const ConeView& view, ConeTriangle& out);
  // Whether it can be met from a rectangle of samples, with a pixel of room.
  bool may_meet(const PixelRectangle& samples) const;
  // Adds it to a batch that has room, as what samples of those `packets` of 4 x 2, which lie in
  // `samples`, can meet.
  struct Packets {
    int left, top, columns, rows;
  };
  void put(const PixelRectangle& samples, const Packets& packets, const ConeView& view,
           std::uint32_t number, TriangleBatch& batch) const;
};

}  // namespace probe::render
