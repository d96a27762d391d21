// The boxes that the links of a fixture with joints fill, wherever its joints stand: what is in the
// way of a drawer is found by them. Each collision shape is bounded along its own axes, as objects
// are by their boxes: collision hulls are not known to the compiler.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/geometry/part_boxes.h"
#include "compiler/model/model.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/geometry.h"
#include "runtime/robot/kinematics.h"
#include "runtime/scene/solid.h"

namespace probe::sema {

class Travel {
 public:
  // Of a fixture that stands in the scene. Reads the collision meshes that the URDF names; one that
  // cannot be read, which is reported where assets are collected, fills nothing. Nothing when the
  // fixture has no description.
  static std::optional<Travel> of(const Scene& scene, const Fixture& fixture,
                                  const AssetRoot& asset_root);

  // With each joint at these positions.
  std::vector<PartBox> at(std::span<const double> joints) const;
  // All that the joints' ways let the parts fill: a part that one joint carries at places about
  // 2 mm apart; of one that several carry the whole way of each, the others where they begin, and
  // kSampled places of all of them together.
  const PartBoxes& everywhere() const { return everywhere_; }
  // The positions of all joints for a box of everywhere().
  std::span<const double> joints_of(const PartBox& box) const { return samples_[box.sample]; }
  // Indices of Fixture::joints that carry a part, from the root on; of a joint that follows
  // another, the other.
  const std::vector<std::size_t>& carriers(std::uint32_t part) const { return carriers_[part]; }

 private:
  struct Shape {
    std::uint32_t part;
    scene::Solid solid;  // in the link's frame
  };
  Travel(const Pose& place, const Fixture& fixture, robot::Tree tree);
  void put(std::span<const double> joints, std::uint32_t part, std::vector<PartBox>* to) const;
  void add(const std::vector<double>& joints, std::uint32_t part);
  void sweep(std::uint32_t part);
  void sweep_joint(std::uint32_t part, std::size_t joint, double lever);

  const Fixture* fixture_;
  robot::Tree tree_;
  Pose base_;
  std::vector<Shape> shapes_;
  std::vector<std::vector<std::size_t>> carriers_;  // by part
  std::vector<std::vector<double>> samples_;
  PartBoxes everywhere_;
};

}  // namespace probe::sema
