#include "compiler/audit/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "runtime/base/geometry.h"
#include "runtime/plan/fixtures.h"
#include "runtime/plan/regions.h"

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

const std::optional<FixtureStarts::Model>& FixtureStarts::model_of(std::uint32_t fixture) {
  const auto [known, is_new] = models_.try_emplace(fixture);
  if (!is_new) return known->second;
  const plan::FixtureRecord& record = plan_.tables().fixtures[fixture];
  if (record.urdf == plan::kNone) return known->second;
  const std::string path(plan_.text(plan_.assets()[record.urdf].path));
  auto model = robot::load_urdf(compilation_.asset_root.file(path));
  if (!model) return known->second;  // a text that has such a file does not compile
  std::vector<std::string> joints;
  for (const auto& joint : plan::slice_of(plan_.tables().fixture_joints, record.joints))
    joints.emplace_back(plan_.text(joint.joint));
  auto tree = robot::Tree::create(*model, joints);
  if (tree) known->second.emplace(Model{*std::move(model), *std::move(tree)});
  return known->second;
}

namespace {

// The middle of an object's box where a start places it; world.
Vec3 middle_of(const plan::Plan& plan, const plan::PlacementRecord& placement) {
  const plan::ObjectRecord& object = plan.objects()[placement.object];
  const auto& q = placement.rotation;
  const Pose placed{Vec3(placement.position.data()), Quat(q[0], q[1], q[2], q[3])};
  return placed.apply((Vec3(object.box_min.data()) + Vec3(object.box_max.data())) / 2);
}

bool is_within(const plan::TurnedBox& box, const Vec3& at) {
  const auto axes = plan::axes_of(box);
  const Vec3 off = at - to_vec(box.middle);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (std::abs(off.dot(to_vec(axes[axis]))) > box.half[axis]) return false;
  }
  return true;
}

}  // namespace

// World, by region of parts of the task's fixtures; nothing where that is not known.
std::vector<std::optional<Pose>> FixtureStarts::owners(std::uint32_t task, std::uint32_t start) {
  std::vector<std::optional<Pose>> poses(plan_.regions().size());
  const plan::TaskRecord& record = plan_.tasks()[task];
  const plan::SceneRecord& scene = plan_.scenes()[record.scene];
  const std::vector<double> joints =
      plan::joint_starts_of(plan_.tables(), scene, plan_.episodes(record)[start]);
  std::size_t first = 0;
  for (const std::uint32_t fixture : plan::slice_of(plan_.tables().list, scene.fixtures)) {
    const plan::FixtureRecord& stands = plan_.tables().fixtures[fixture];
    const auto own = std::span<const double>(joints).subspan(first, stands.joints.count);
    first += stands.joints.count;
    const auto& model = model_of(fixture);
    if (!model) continue;
    std::vector<Pose> links(model->tree.link_count());
    model->tree.link_poses(own, links);
    const auto& q = stands.rotation;
    const Pose base{Vec3(stands.position.data()), Quat(q[0], q[1], q[2], q[3])};
    for (std::uint32_t r = 0; r < poses.size(); ++r) {
      const plan::RegionRecord& region = plan_.regions()[r];
      const std::uint32_t from = stands.parts.first, to = from + stands.parts.count;
      if (static_cast<plan::BodyKind>(region.kind) != plan::BodyKind::kPart ||
          region.index < from || region.index >= to)
        continue;
      const int link = model->model.find_link(plan_.text(plan_.tables().parts[region.index].link));
      poses[r] = base * links[static_cast<std::size_t>(link)];
    }
  }
  return poses;
}

std::vector<vm::BegunIn> FixtureStarts::of(std::uint32_t task, std::uint32_t start) {
  std::vector<vm::BegunIn> found;
  const plan::TaskRecord& record = plan_.tasks()[task];
  if (plan_.scenes()[record.scene].fixtures.count == 0) return found;
  const std::vector<std::optional<Pose>> poses = owners(task, start);
  const auto placements = plan_.placements(plan_.episodes(record)[start]);
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const Vec3 middle = middle_of(plan_, placements[i]);
    for (std::uint32_t r = 0; r < poses.size(); ++r) {
      if (!poses[r]) continue;
      const Vec3 at = poses[r]->inverse().apply(middle);
      const auto owner = plan::owner_of(plan_.tables(), record, plan_.regions()[r]);
      if (!owner || !is_within(plan::box_of(plan_.tables(), r), at)) continue;
      found.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(*owner), at});
      break;
    }
  }
  return found;
}

}  // namespace probe::audit
