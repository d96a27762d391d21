// Monotone-chain hulls, clipping by half planes, distances between convex outlines.
#include "runtime/expert/footprint.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/base/trig.h"

namespace probe::expert {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

double area(const Outline& o) {
  double twice = 0;
  for (std::size_t i = 0; i < o.size(); ++i) twice += cross(o[i], o[(i + 1) % o.size()]);
  return 0.5 * twice;
}

// Centre of area, about the first vertex to keep digits; the mean of vertices for a sliver.
Vec2 center_of(const Outline& o) {
  Vec2 sum = Vec2::Zero(), mean = Vec2::Zero();
  double twice = 0;
  for (std::size_t i = 0; i < o.size(); ++i) {
    const Vec2 a = o[i] - o[0], b = o[(i + 1) % o.size()] - o[0];
    twice += cross(a, b);
    sum += (a + b) * cross(a, b);
    mean += o[i] / static_cast<double>(o.size());
  }
  return twice > 1e-12 ? Vec2(o[0] + sum / (3 * twice)) : mean;
}

// Keeps what lies on the side n . p <= limit.
Outline clipped(const Outline& o, const Vec2& n, double limit) {
  Outline out;
  for (std::size_t i = 0; i < o.size(); ++i) {
    const Vec2 &a = o[i], &b = o[(i + 1) % o.size()];
    const double da = n.dot(a) - limit, db = n.dot(b) - limit;
    if (da <= 0) out.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) out.push_back(a + (b - a) * (da / (da - db)));
  }
  return out;
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (p - (a + t * d)).norm();
}

// The largest gap along an edge normal of `a`.
double best_edge_gap(const Outline& a, const Outline& b) {
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec2 edge = a[(i + 1) % a.size()] - a[i];
    const double length = edge.norm();
    if (length < 1e-12) continue;
    const Vec2 normal(edge.y() / length, -edge.x() / length);
    double gap = std::numeric_limits<double>::infinity();
    for (const Vec2& p : b) gap = std::min(gap, normal.dot(p - a[i]));
    best = std::max(best, gap);
  }
  return best;
}

}  // namespace

double least_width(const Outline& outline) {
  if (outline.size() < 3) return 0;
  double least = std::numeric_limits<double>::infinity();
  // Two walls that are nearest to one another lie along an edge.
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 edge = outline[(i + 1) % outline.size()] - outline[i];
    const Vec2 inwards = Vec2(-edge.y(), edge.x()).normalized();
    double depth = 0;
    for (const Vec2& corner : outline) depth = std::max(depth, inwards.dot(corner - outline[i]));
    least = std::min(least, depth);
  }
  return least;
}

double half_diagonal(const Footprint& footprint) {
  Vec2 low = footprint.center, high = low;
  for (const Vec2& p : footprint.whole) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return 0.5 * (high - low).norm();
}

Outline convex_outline(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  Outline hull;
  // Lower chain left to right, then the upper one back.
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= start + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

Footprint footprint_of(std::span<const std::vector<Vec3>> parts, const Pose& pose) {
  Footprint out;
  out.bottom = std::numeric_limits<double>::infinity();
  out.top = -out.bottom;
  std::vector<Vec2> all;
  Vec2 weighted = Vec2::Zero();
  double total = 0;
  for (const std::vector<Vec3>& part : parts) {
    std::vector<Vec2> flat;
    double top = -std::numeric_limits<double>::infinity();
    for (const Vec3& vertex : part) {
      const Vec3 p = pose.apply(vertex);
      flat.emplace_back(p.x(), p.y());
      out.bottom = std::min(out.bottom, p.z());
      top = std::max(top, p.z());
    }
    if (flat.empty()) continue;
    all.insert(all.end(), flat.begin(), flat.end());
    out.parts.push_back(convex_outline(std::move(flat)));
    out.part_tops.push_back(top);
    out.top = std::max(out.top, top);
    const double weight = std::max(area(out.parts.back()), 1e-12);
    weighted += weight * center_of(out.parts.back());
    total += weight;
  }
  if (all.empty()) {
    out.bottom = out.top = pose.position.z();
    out.center = pose.position.head<2>();
    return out;
  }
  out.whole = convex_outline(std::move(all));
  recenter(out, weighted / total);
  return out;
}

void recenter(Footprint& footprint, const Vec2& center) {
  footprint.center = center;
  footprint.radius = 0;
  for (const Vec2& p : footprint.whole) {
    footprint.radius = std::max(footprint.radius, (p - center).norm());
  }
}

std::vector<Outline> section_above(std::span<const std::vector<Vec3>> parts, double height) {
  std::vector<Outline> out;
  for (const std::vector<Vec3>& part : parts) {
    std::vector<Vec2> flat;
    for (const Vec3& a : part) {
      if (a.z() >= height) flat.emplace_back(a.x(), a.y());
      // All pairs, for edges are not known; what is not an edge lies inside.
      for (const Vec3& b : part) {
        if (a.z() < height || b.z() >= height) continue;
        const double t = (height - b.z()) / (a.z() - b.z());
        const Vec3 cut = b + t * (a - b);
        flat.emplace_back(cut.x(), cut.y());
      }
    }
    if (Outline outline = convex_outline(std::move(flat)); outline.size() >= 3) {
      out.push_back(std::move(outline));
    }
  }
  return out;
}

Extent extent_in_slab(std::span<const Outline> parts, const Slab& slab, const Vec2& along) {
  Extent out;
  for (const Outline& part : parts) {
    const Outline cut =
        clipped(clipped(part, slab.across, slab.at + slab.half), -slab.across, slab.half - slab.at);
    for (const Vec2& p : cut) {
      const double s = along.dot(p);
      if (out.empty()) out = {s, s};
      out.lower = std::min(out.lower, s);
      out.upper = std::max(out.upper, s);
    }
  }
  return out;
}

std::vector<double> turns_square_to(const Outline& outline,
                                    std::span<const Footprint* const> others, const Vec2& at,
                                    double near) {
  constexpr double kLongEdge = 0.05, kAlike = 0.03;  // m, rad
  constexpr std::size_t kMost = 4;
  constexpr double kQuarter = std::numbers::pi / 2;
  const auto longest = [](const Outline& o) {
    Vec2 best = Vec2::Zero();
    for (std::size_t i = 0; i < o.size(); ++i) {
      const Vec2 edge = o[(i + 1) % o.size()] - o[i];
      if (edge.squaredNorm() > best.squaredNorm()) best = edge;
    }
    return best;
  };
  const Vec2 own = longest(outline);
  std::vector<double> turns;
  if (own.norm() < 1e-9) return turns;
  const Outline point = {at};
  for (const Footprint* other : others) {
    for (const Outline& part : other->parts) {
      const Vec2 edge = longest(part);
      if (part.size() < 3 || edge.norm() < kLongEdge || turns.size() >= 4 * kMost) continue;
      if (separation(part, point) > near) continue;
      const double along = portable_atan2(cross(own, edge), own.dot(edge));
      // Into -45 .. 45 degrees.
      const double least = along - kQuarter * std::round(along / kQuarter);
      const auto is_alike = [&](double turn) { return std::abs(turn - least) < kAlike; };
      if (std::any_of(turns.begin(), turns.end(), is_alike)) continue;
      for (const double quarter : {0.0, 1.0, -1.0, 2.0})
        turns.push_back(least + quarter * kQuarter);
    }
  }
  return turns;
}

double separation(const Outline& a, const Outline& b) {
  if (a.empty() || b.empty()) return std::numeric_limits<double>::infinity();
  const double gap = std::max(best_edge_gap(a, b), best_edge_gap(b, a));
  if (gap <= 0 && std::isfinite(gap)) return gap;
  // Apart: corner distances, which an edge normal underestimates.
  double nearest = std::numeric_limits<double>::infinity();
  const auto corners = [&](const Outline& from, const Outline& to) {
    for (const Vec2& p : from) {
      for (std::size_t i = 0; i < to.size(); ++i) {
        nearest = std::min(nearest, distance_to_segment(p, to[i], to[(i + 1) % to.size()]));
      }
    }
  };
  corners(a, b);
  corners(b, a);
  return nearest;
}

}  // namespace probe::expert
