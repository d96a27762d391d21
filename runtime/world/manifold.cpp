#include "runtime/world/manifold.h"

#include <algorithm>
#include <cmath>

namespace probe::world {
namespace {

// A later candidate must beat an earlier one by this, so that rounding never changes the choice.
// m where gaps are compared, m2 where areas are.
constexpr double kBeat = 1e-7;
constexpr double kDepthScale = 3e-4;  // m of extra gap that halves a point's weight

struct Weighted {
  const Candidates& all;
  double lowest;
  double weight(std::size_t i) const {
    return 1.0 / (1.0 + (all.points[i].gap - lowest) / kDepthScale);
  }
};

}  // namespace

bool can_reuse(const PairRecord& record, std::uint64_t substep, const RelativePose& pose,
               double radius, double reuse) {
  if (!record.valid || record.last + 1 != substep) return false;
  if (!((pose.offset - record.offset).squaredNorm() < reuse * reuse)) return false;
  return (pose.axes - record.axes).squaredNorm() * radius * radius < 2 * reuse * reuse;
}

void renew(PairRecord* record, std::uint64_t substep, const RelativePose& pose,
           const Candidates& candidates, bool plane, double match) {
  const bool inherits = record->valid && record->last + 1 == substep;
  const std::array<ManifoldPoint, kMaxPoints> old = record->points;
  const int old_count = inherits ? record->count : 0;
  std::array<bool, kMaxPoints> used{};
  record->valid = true;
  record->axes = pose.axes;
  record->offset = pose.offset;
  record->count = static_cast<std::int8_t>(std::min(candidates.count, kMaxPoints));
  for (std::size_t i = 0; i < static_cast<std::size_t>(record->count); ++i) {
    const Candidate& c = candidates.points[i];
    ManifoldPoint& point = record->points[i];
    point = ManifoldPoint{};
    point.anchor_a = plane ? Vec3(pose.axes.transpose() * (c.on_a - pose.offset)) : c.on_a;
    point.anchor_b = plane ? c.on_b : Vec3(pose.axes.transpose() * (c.on_b - pose.offset));
    point.normal_a = candidates.own_normals ? candidates.normals[i] : candidates.normal;
    point.id = c.id;
    std::size_t source = kMaxPoints;
    double nearest = match * match;
    for (std::size_t k = 0; k < static_cast<std::size_t>(old_count); ++k) {
      if (used[k]) continue;
      if (plane && old[k].id == c.id) {
        source = k;
        break;
      }
      const double d = (old[k].anchor_a - point.anchor_a).squaredNorm();
      if (d < nearest) {
        nearest = d;
        source = k;
      }
    }
    if (source == kMaxPoints) continue;
    used[source] = true;
    point.normal_impulse = old[source].normal_impulse;
    point.torsion_impulse = old[source].torsion_impulse;
    point.friction_impulse = old[source].friction_impulse;
  }
}

void reduce(Candidates* candidates, bool plane) {
  const std::size_t count = static_cast<std::size_t>(candidates->count);
  if (count <= 4) return;
  std::array<Candidate, Candidates::kMax>& points = candidates->points;
  double lowest = points[0].gap;
  for (std::size_t i = 1; i < count; ++i) lowest = std::min(lowest, points[i].gap);
  const Weighted weighted{*candidates, lowest};

  std::size_t deepest = 0;
  for (std::size_t i = 1; i < count; ++i) {
    if (points[i].gap < points[deepest].gap - kBeat) deepest = i;
  }
  std::size_t a = deepest;
  if (plane) {
    Vec3 centroid = Vec3::Zero();
    for (std::size_t i = 0; i < count; ++i) centroid += points[i].middle;
    centroid /= static_cast<double>(count);
    double best = -1;
    for (std::size_t i = 0; i < count; ++i) {
      const double score = (points[i].middle - centroid).norm() * weighted.weight(i);
      if (score > best + kBeat) {
        best = score;
        a = i;
      }
    }
  }
  std::size_t b = a;
  double best = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double score = (points[i].middle - points[a].middle).norm() * weighted.weight(i);
    if (score > best + kBeat) {
      best = score;
      b = i;
    }
  }
  const Vec3 line = points[b].middle - points[a].middle;
  std::size_t c = a, d = a;
  double most = 0, least = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double area = candidates->normal.dot(line.cross(points[i].middle - points[a].middle)) *
                        weighted.weight(i);
    if (area > most + kBeat) {
      most = area;
      c = i;
    }
    if (area < least - kBeat) {
      least = area;
      d = i;
    }
  }
  std::array<Candidate, kMaxPoints> kept;
  std::array<std::size_t, kMaxPoints> chosen{};
  int n = 0;
  for (const std::size_t i : {a, b, c, d, plane ? deepest : a}) {
    bool known = false;
    for (int k = 0; k < n; ++k) known = known || chosen[static_cast<std::size_t>(k)] == i;
    if (known) continue;
    chosen[static_cast<std::size_t>(n)] = i;
    kept[static_cast<std::size_t>(n)] = points[i];
    ++n;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) points[i] = kept[i];
  candidates->count = n;
}

}  // namespace probe::world
