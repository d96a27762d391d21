#include "runtime/render/cone_triangle.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/extremes.h"

namespace probe::render {
namespace {

constexpr float kRounded = 1e-6f;  // of what is added up to a closeness

}  // namespace

ConeView::ConeView(const Camera& camera)
    : forward(camera.forward_left_up.col(0)),
      right(-camera.forward_left_up.col(1) / camera.fx),
      down(-camera.forward_left_up.col(2) / camera.fy),
      corner(forward - camera.cx * right - camera.cy * down),
      eye(camera.position),
      fx(camera.fx),
      fy(camera.fy),
      cx(camera.cx),
      cy(camera.cy),
      across(static_cast<float>(std::max(camera.fx, camera.fy))) {
  const double to_side = std::max(std::abs(cx), std::abs(camera.width - cx)) + 16;
  const double to_end = std::max(std::abs(cy), std::abs(camera.height - cy)) + 16;
  longest = static_cast<float>(
      std::sqrt(1 + to_side * to_side / (fx * fx) + to_end * to_end / (fy * fy)));
  depth_doubt = kDistanceDoubt / longest;
}

bool ConeTriangle::make(const Vec3 (&corners)[3], double doubt, const ConeView& view,
                        ConeTriangle& out) {
  const double z[3] = {view.forward.dot(corners[0]), view.forward.dot(corners[1]),
                       view.forward.dot(corners[2])};
  const double nearest = std::min({z[0], z[1], z[2]});
  if (std::max({z[0], z[1], z[2]}) <= 0) return false;
  out.bounds = {-kInfinite, kInfinite, -kInfinite, kInfinite};
  out.closest = kInfinite;
  if (nearest > 1e-3) {
    out.bounds = {kInfinite, -kInfinite, kInfinite, -kInfinite};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto x =
          static_cast<float>(view.right.dot(corners[k]) * view.fx * view.fx / z[k] + view.cx);
      const auto y =
          static_cast<float>(view.down.dot(corners[k]) * view.fy * view.fy / z[k] + view.cy);
      out.bounds = {std::min(out.bounds.x0, x), std::max(out.bounds.x1, x),
                    std::min(out.bounds.y0, y), std::max(out.bounds.y1, y)};
    }
    out.closest = static_cast<float>(1 / nearest);
  }
  // det / depth is the sum of the three edges' products with the ray (forward part 1).
  const double det = corners[0].dot(corners[1].cross(corners[2]));
  const double sign = det < 0 ? -1 : 1;
  Vec3 sum = Vec3::Zero();
  double size = 1;
  for (std::size_t e = 0; e < 3; ++e) {
    const Vec3 &p = corners[(e + 1) % 3], &q = corners[(e + 2) % 3];
    const Vec3 edge = sign * p.cross(q);
    const double scale = 1 / std::max(p.norm() * q.norm(), 1e-12);
    out.a[e] = static_cast<float>(scale * edge.dot(view.right));
    out.b[e] = static_cast<float>(scale * edge.dot(view.down));
    out.c[e] = static_cast<float>(scale * edge.dot(view.corner));
    const double closer = std::max(std::min(p.norm(), q.norm()), 1e-6);
    out.touch[e] = kConeDoubt + static_cast<float>(2 * doubt * view.longest / closer);
    sum += edge;
    size *= p.norm();
  }
  out.doubt = static_cast<float>(doubt);
  const double flatness = std::abs(det) / std::max(size, 1e-12);
  out.thin = !(flatness > 2.0 * std::max({out.touch[0], out.touch[1], out.touch[2]}));
  // Of one seen from the side no more is known than its corners.
  out.closeness_a = out.closeness_b = 0;
  out.closeness_c = kInfinite;
  if (std::abs(det) > 1e-6 * size) {
    sum /= std::abs(det);
    out.closeness_a = static_cast<float>(sum.dot(view.right));
    out.closeness_b = static_cast<float>(sum.dot(view.down));
    out.closeness_c = static_cast<float>(sum.dot(view.corner));
  }
  return true;
}

bool ConeTriangle::may_meet(const PixelRectangle& samples) const {
  if (bounds.x0 > samples.x1 + kConeRoom || bounds.x1 < samples.x0 - kConeRoom ||
      bounds.y0 > samples.y1 + kConeRoom || bounds.y1 < samples.y0 - kConeRoom)
    return false;
  for (std::size_t e = 0; e < 3 && !thin; ++e) {
    if (range_in(samples, a[e], b[e], c[e]).high < -touch[e]) return false;
  }
  return true;
}

void ConeTriangle::put(const PixelRectangle& samples, const Packets& packets, const ConeView& view,
                       std::uint32_t number, TriangleBatch& batch) const {
  const std::size_t i = batch.count++;
  batch.order[i] = static_cast<std::uint16_t>(i);
  batch.triangle[i] = number;
  batch.left[i] = packets.left;
  batch.top[i] = packets.top;
  batch.columns[i] = packets.columns;
  batch.rows[i] = packets.rows;
  for (std::size_t e = 0; e < 3; ++e) {
    batch.a[e][i] = thin ? 0 : a[e];
    batch.b[e][i] = thin ? 0 : b[e];
    batch.e[e][i] = thin ? 0 : c[e] + a[e] * samples.x0 + b[e] * samples.y0;
    batch.touch[e][i] = touch[e];
  }
  const ValueRange its = range_in(samples, closeness_a, closeness_b, closeness_c);
  const bool known = !thin && its.high < kInfinite;
  const float slope = std::abs(closeness_a) + std::abs(closeness_b);
  const float wrong =
      view.across * slope * (doubt * its.high + kConeDoubt) + doubt * its.high * its.high;
  const bool solid = known && its.low > 0 && wrong < kDepthDoubt * its.low &&
                     wrong < view.depth_doubt * its.low * its.low && its.high < 0.5f / kNearest;
  const float summed = std::abs(closeness_c) + std::abs(closeness_a) * samples.x1 +
                       std::abs(closeness_b) * samples.y1;
  batch.solid[i] = is(solid);
  batch.fine[i] = is(solid && wrong + kRounded * summed < kFineDoubt * its.low);
  batch.w[i] =
      !known ? kInfinite
             : closeness_c + closeness_a * samples.x0 + closeness_b * samples.y0 + std::abs(wrong);
  batch.wx[i] = known ? closeness_a : 0;
  batch.wy[i] = known ? closeness_b : 0;
}

}  // namespace probe::render
