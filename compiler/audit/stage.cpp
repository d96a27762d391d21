#include "compiler/audit/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "runtime/base/geometry.h"
#include "runtime/robot/urdf.h"

namespace probe::audit {
namespace {

constexpr double kOverlap = 0.01;  // m that two boxes share as seen from above
constexpr double kFall = 0.01;     // m: less is no fall, as of what a layout puts on a thing
constexpr double kUnfelt = 0.005;  // m that is seen beyond what is felt

struct Box {
  Vec3 low = Vec3::Constant(1e9), high = Vec3::Constant(-1e9);

  void add(const Vec3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  bool is_empty() const { return low.x() > high.x(); }
};

// Upright, around the object's own box where it is placed.
Box box_of(const plan::Plan& plan, const plan::PlacementRecord& placement) {
  const plan::ObjectRecord& object = plan.objects()[placement.object];
  const auto& q = placement.rotation;
  const Quat turn(q[0], q[1], q[2], q[3]);
  const Vec3 at(placement.position.data());
  Box box;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 point;
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      point[axis] = (corner >> axis & 1) != 0 ? object.box_max[k] : object.box_min[k];
    }
    box.add(at + turn * point);
  }
  return box;
}

bool is_above(const Box& a, const Box& b) {
  for (const int axis : {0, 1}) {
    if (std::min(a.high[axis], b.high[axis]) - std::max(a.low[axis], b.low[axis]) <= kOverlap)
      return false;
  }
  return a.low.z() >= b.high.z();
}

// Of all that begin: which do not stand on another of them.
std::vector<bool> falling_of(const std::vector<Box>& boxes) {
  std::vector<bool> falling;
  for (const Box& box : boxes) {
    falling.push_back(std::none_of(boxes.begin(), boxes.end(), [&](const Box& other) {
      return is_above(box, other) && box.low.z() - other.high.z() < kFall;
    }));
  }
  return falling;
}

void add(Box& box, const robot::Primitive& shape) {
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 point = shape.half;
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1) != 0) point[axis] = -point[axis];
    }
    box.add(shape.origin.position + shape.origin.rotation * point);
  }
}

}  // namespace

Falls falls_in(const plan::Plan& plan, std::uint32_t task) {
  Falls falls;
  for (const plan::EpisodeRecord& episode : plan.episodes(plan.tasks()[task])) {
    const auto placements = plan::slice_of(plan.tables().placements, episode.placements);
    std::vector<Box> boxes;
    for (const plan::PlacementRecord& placement : placements)
      boxes.push_back(box_of(plan, placement));
    const std::vector<bool> falling = falling_of(boxes);
    bool any = false;
    for (std::size_t i = 0; i < boxes.size() && !any; ++i) {
      for (std::size_t j = 0; j < i && !any; ++j) {
        any = (falling[i] && is_above(boxes[i], boxes[j])) ||
              (falling[j] && is_above(boxes[j], boxes[i]));
        if (!any || falls.starts > 0) continue;
        falls.first = falls.of;
        falls.first_pair = fmt::format("`{}` and `{}`",
                                       plan.text(plan.objects()[placements[j].object].name),
                                       plan.text(plan.objects()[placements[i].object].name));
      }
    }
    falls.starts += any;
    ++falls.of;
  }
  return falls;
}

std::vector<std::string> unfelt_in(const Compilation& compilation, const plan::Plan& plan,
                                   std::uint32_t fixture) {
  const plan::FixtureRecord& record = plan.tables().fixtures[fixture];
  if (record.urdf == plan::kNone) return {};
  const std::string path(plan.text(plan.assets()[record.urdf].path));
  const auto model = robot::load_urdf(compilation.asset_root.file(path));
  if (!model) return {};  // a text that has such a file does not compile
  std::vector<std::string> sentences;
  for (const robot::Link& link : model->links) {
    if (!link.visuals.empty() || !link.collisions.empty()) continue;
    Box seen, felt;
    for (const robot::DrawnPrimitive& one : link.drawn) add(seen, one.shape);
    for (const robot::Primitive& one : link.primitives) add(felt, one);
    if (seen.is_empty()) continue;
    if (felt.is_empty()) {
      sentences.push_back(fmt::format("link `{}` of fixture `{}` is seen and cannot be touched",
                                      link.name, plan.text(record.name)));
      continue;
    }
    const double beyond =
        std::max((felt.low - seen.low).maxCoeff(), (seen.high - felt.high).maxCoeff());
    if (beyond <= kUnfelt) continue;
    sentences.push_back(
        fmt::format("link `{}` of fixture `{}` is seen {:.3g}cm beyond what is felt of it, as a handle "
                    "is that hands pass through",
                    link.name, plan.text(record.name), 100 * beyond));
  }
  return sentences;
}

}  // namespace probe::audit
