// Where the centre of mass of an object lies in its model's frame, and how well that is known.
#pragma once

#include <map>
#include <string>

#include "compiler/model/model.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/geometry.h"

namespace probe::sema {

struct Centre {
  Vec3 at = Vec3::Zero();      // m
  Vec3 within = Vec3::Zero();  // it is no farther from `at` along each axis, m
};

// Reads collision meshes, each once. Of one that cannot be read, which is said where assets are
// collected, it is in the middle half of the box.
class Centres {
 public:
  explicit Centres(AssetRoot asset_root) : asset_root_(std::move(asset_root)) {}
  const Centre& of(const Object& object);

 private:
  AssetRoot asset_root_;
  std::map<std::string, Centre> known_;  // by object
};

}  // namespace probe::sema
