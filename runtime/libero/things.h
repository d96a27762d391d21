// What tasks say of a category of things, beside its declaration: which joints, parts and regions a
// model has, by the benchmark's names.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "runtime/base/geometry.h"

namespace probe::libero {

struct ThingJoint {
  std::string name, part;  // "top_level" moves "cabinet_top"
};
struct ThingRegion {
  std::string name, part;  // "top_region" of "cabinet_top"; no part: of the thing itself
};

struct Thing {
  std::string category;  // "wooden_cabinet", as it is declared
  bool is_fixture = false;
  double bottom = 0;  // m: z of the model's `bottom_site`, by which the benchmark stands it up
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  // m, of what is felt, in the model's frame
  std::vector<ThingJoint> joints;
  std::vector<ThingRegion> regions;
};
using Things = std::map<std::string, Thing, std::less<>>;  // by category

}  // namespace probe::libero
