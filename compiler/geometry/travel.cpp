#include "compiler/geometry/travel.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "compiler/geometry/camera_pose.h"
#include "runtime/scene/link_solids.h"

namespace probe::sema {
namespace {

constexpr double kStep = 2e-3;                // m between two places of a part
constexpr std::size_t kMostPositions = 2048;  // of one part; several joints share them
constexpr double kHalfTurn = 3.14159265358979323846;

// Indices of Fixture::joints on the way from the root to a link.
std::vector<std::size_t> carriers(const Fixture& fixture, int link) {
  std::vector<std::size_t> found;
  while (true) {
    const int above = fixture.model->links[static_cast<std::size_t>(link)].parent_joint;
    if (above < 0) return found;
    const robot::Joint* joint = &fixture.model->joints[static_cast<std::size_t>(above)];
    link = joint->parent_link;
    if (joint->mimic >= 0) joint = &fixture.model->joints[static_cast<std::size_t>(joint->mimic)];
    for (std::size_t i = 0; i < fixture.joints.size(); ++i) {
      if (fixture.joints[i].name == joint->name && std::ranges::find(found, i) == found.end())
        found.push_back(i);
    }
  }
}

}  // namespace

scene::Solid solid(const Object& object, const Mat3& turn, const Vec3& origin) {
  return moved(scene::upright_solid(Vec3(object.box_min.data()), Vec3(object.box_max.data())),
               {origin, Quat(turn)});
}

Travel::Travel(const Fixture& fixture, robot::Tree tree)
    : fixture_(&fixture), tree_(std::move(tree)) {
  base_ = pose_of(fixture.position, fixture.turn.rotation);
}

std::optional<Travel> Travel::of(const Fixture& fixture, const std::string& asset_root) {
  if (fixture.broken || !fixture.model) return std::nullopt;
  std::vector<std::string> joints;
  for (const Fixture::Joint& joint : fixture.joints) joints.push_back(joint.name);
  auto tree = robot::Tree::create(*fixture.model, joints);
  if (!tree.ok()) return std::nullopt;
  Travel travel(fixture, std::move(*tree));
  const std::string folder =
      (std::filesystem::path(asset_root) / fixture.urdf.text).parent_path().string();
  for (std::uint32_t i = 0; i < fixture.parts.size(); ++i) {
    const auto& link = fixture.model->links[static_cast<std::size_t>(fixture.parts[i].index)];
    for (const scene::Solid& solid : scene::link_solids(link, folder))
      travel.shapes_.push_back({i, solid});
  }
  for (std::uint32_t i = 0; i < fixture.parts.size(); ++i) travel.sweep(i);
  return travel;
}

void Travel::put(std::span<const double> joints, std::uint32_t part,
                 std::vector<PartBox>* to) const {
  std::vector<Pose> poses(tree_.link_count());
  tree_.link_poses(joints, poses);
  const Fixture::Part& record = fixture_->parts[part];
  const Pose pose = base_ * poses[static_cast<std::size_t>(record.index)];
  for (const Shape& shape : shapes_) {
    if (shape.part != part) continue;
    PartBox box{part, record.joint ? joints[*record.joint] : 0, moved(shape.solid, pose), {}};
    box.half = box.solid.half_extent();
    to->push_back(std::move(box));
  }
}

std::vector<PartBox> Travel::at(std::span<const double> joints) const {
  std::vector<PartBox> boxes;
  for (std::uint32_t i = 0; i < fixture_->parts.size(); ++i) put(joints, i, &boxes);
  return boxes;
}

void Travel::sweep(std::uint32_t part) {
  const int link = fixture_->parts[part].index;
  const std::vector<std::size_t> moving = carriers(*fixture_, link);
  std::vector<double> joints;
  for (const Fixture::Joint& joint : fixture_->joints) joints.push_back(joint.start);
  // How far the part's farthest corner is from any hinge, at most.
  double lever = 0;
  std::vector<PartBox> begun;
  put(joints, part, &begun);
  for (const PartBox& box : begun)
    lever = std::max(lever, (box.solid.centre - base_.position).norm() + box.half.norm());
  std::vector<std::size_t> places;
  std::size_t all = 1;
  for (const std::size_t i : moving) {
    const Fixture::Joint& joint = fixture_->joints[i];
    const double way = joint.is_endless ? 2 * kHalfTurn : joint.upper - joint.lower;
    const double length = joint.slides ? way : way * lever;
    places.push_back(std::min(kMostPositions, 2 + static_cast<std::size_t>(length / kStep)));
    all *= places.back();
  }
  while (all > kMostPositions) {
    all = 1;
    for (std::size_t& count : places) all *= count = std::max<std::size_t>(2, count * 9 / 10);
    if (std::ranges::all_of(places, [](std::size_t count) { return count == 2; })) break;
  }
  for (std::size_t n = 0; n < all; ++n) {
    std::size_t left = n;
    for (std::size_t k = 0; k < moving.size(); ++k) {
      const Fixture::Joint& joint = fixture_->joints[moving[k]];
      const double low = joint.is_endless ? -kHalfTurn : joint.lower;
      const double high = joint.is_endless ? kHalfTurn : joint.upper;
      const std::size_t at = left % places[k];
      left /= places[k];
      joints[moving[k]] =
          low + (high - low) * static_cast<double>(at) / static_cast<double>(places[k] - 1);
    }
    put(joints, part, &everywhere_);
  }
}

}  // namespace probe::sema
