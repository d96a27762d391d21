#include "compiler/geometry/travel.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numbers>

#include "compiler/geometry/part_place.h"
#include "compiler/geometry/pose.h"
#include "runtime/scene/link_solids.h"

namespace probe::sema {
namespace {

constexpr double kStep = 2e-3;                // m between two places of a part
constexpr std::size_t kMostPositions = 2048;  // of one joint
constexpr std::uint32_t kSampled = 2048;      // of several joints together
constexpr double kHalfTurn = std::numbers::pi;

// Fractions that fill a cube of as many dimensions as there are bases evenly: van der Corput's.
double radical_inverse(std::uint32_t n, std::uint32_t base) {
  double value = 0, digit = 1.0 / base;
  for (; n > 0; n /= base, digit /= base) value += digit * (n % base);
  return value;
}
constexpr std::uint32_t kBases[] = {2,  3,  5,  7,   11,  13,  17,  19,  23,  29, 31,
                                    37, 41, 43, 47,  53,  59,  61,  67,  71,  73, 79,
                                    83, 89, 97, 101, 103, 107, 109, 113, 127, 131};

double low_of(const Fixture::Joint& joint) { return joint.is_endless ? -kHalfTurn : joint.lower; }
double high_of(const Fixture::Joint& joint) { return joint.is_endless ? kHalfTurn : joint.upper; }

std::vector<std::size_t> carriers_of(const Fixture& fixture, int link) {
  std::vector<std::size_t> found;
  while (true) {
    const int above = fixture.model->links[static_cast<std::size_t>(link)].parent_joint;
    if (above < 0) break;
    const robot::Joint* joint = &fixture.model->joints[static_cast<std::size_t>(above)];
    link = joint->parent_link;
    if (joint->mimic >= 0) joint = &fixture.model->joints[static_cast<std::size_t>(joint->mimic)];
    for (std::size_t i = 0; i < fixture.joints.size(); ++i) {
      if (fixture.joints[i].name == joint->name && std::ranges::find(found, i) == found.end())
        found.push_back(i);
    }
  }
  std::ranges::reverse(found);
  return found;
}

}  // namespace

Travel::Travel(const Pose& place, const Fixture& fixture, robot::Tree tree)
    : fixture_(&fixture), tree_(std::move(tree)), base_(place) {}

std::optional<Travel> Travel::of(const Scene& scene, const Fixture& fixture,
                                 const AssetRoot& asset_root) {
  if (fixture.broken || !fixture.model) return std::nullopt;
  auto tree = tree_of(fixture);
  if (!tree) return std::nullopt;
  Travel travel(place_of(scene, fixture), fixture, std::move(*tree));
  const std::string folder =
      std::filesystem::path(asset_root.file(fixture.urdf.text)).parent_path().string();
  for (std::uint32_t i = 0; i < fixture.parts.size(); ++i) {
    const auto& link = fixture.model->links[static_cast<std::size_t>(fixture.parts[i].index)];
    for (const scene::Solid& solid : scene::link_solids(link, folder))
      travel.shapes_.push_back({i, solid});
  }
  for (std::uint32_t i = 0; i < fixture.parts.size(); ++i) {
    travel.carriers_.push_back(carriers_of(fixture, fixture.parts[i].index));
    travel.sweep(i);
  }
  return travel;
}

void Travel::put(std::span<const double> joints, std::uint32_t part,
                 std::vector<PartBox>* to) const {
  const Pose pose = part_pose(base_, *fixture_, tree_, joints, part);
  for (const Shape& shape : shapes_) {
    if (shape.part != part) continue;
    PartBox box{part, 0, moved(shape.solid, pose), {}};
    box.half = box.solid.half_extent();
    to->push_back(std::move(box));
  }
}

std::vector<PartBox> Travel::at(std::span<const double> joints) const {
  std::vector<PartBox> boxes;
  for (std::uint32_t i = 0; i < fixture_->parts.size(); ++i) put(joints, i, &boxes);
  return boxes;
}

void Travel::add(const std::vector<double>& joints, std::uint32_t part) {
  std::vector<PartBox> boxes;
  put(joints, part, &boxes);
  for (PartBox& box : boxes) {
    box.sample = static_cast<std::uint32_t>(samples_.size());
    everywhere_.add(box);
  }
  samples_.push_back(joints);
}

// The others stay where they begin.
void Travel::sweep_joint(std::uint32_t part, std::size_t joint, double lever) {
  std::vector<double> joints;
  for (const Fixture::Joint& other : fixture_->joints) joints.push_back(other.start);
  const Fixture::Joint& moving = fixture_->joints[joint];
  const double low = low_of(moving), way = high_of(moving) - low;
  const double steps = std::min((moving.slides ? way : way * lever) / kStep,
                                static_cast<double>(kMostPositions - 2));
  const auto count = static_cast<std::size_t>(std::max(steps, 0.0)) + 2;
  for (std::size_t i = 0; i < count; ++i) {
    joints[joint] = low + way * static_cast<double>(i) / static_cast<double>(count - 1);
    add(joints, part);
  }
}

void Travel::sweep(std::uint32_t part) {
  const std::vector<std::size_t>& moving = carriers_[part];
  std::vector<double> joints;
  for (const Fixture::Joint& joint : fixture_->joints) joints.push_back(joint.start);
  if (moving.empty()) return add(joints, part);
  // How far the part's farthest corner is from any hinge, at most.
  double lever = 0;
  std::vector<PartBox> begun;
  put(joints, part, &begun);
  for (const PartBox& box : begun)
    lever = std::max(lever, (box.solid.centre - base_.position).norm() + box.half.norm());
  for (const std::size_t joint : moving) sweep_joint(part, joint, lever);
  if (moving.size() < 2) return;
  for (std::uint32_t n = 1; n <= kSampled; ++n) {
    for (std::size_t k = 0; k < moving.size(); ++k) {
      const Fixture::Joint& joint = fixture_->joints[moving[k]];
      const double share = radical_inverse(n, kBases[k % std::size(kBases)]);
      joints[moving[k]] = low_of(joint) + (high_of(joint) - low_of(joint)) * share;
    }
    add(joints, part);
  }
}

}  // namespace probe::sema
