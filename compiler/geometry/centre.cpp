#include "compiler/geometry/centre.h"

#include "compiler/geometry/felt_shape.h"

namespace probe::sema {

const Centre& Centres::of(const Object& object) {
  const auto [at, is_new] = known_.try_emplace(object.name);
  if (!is_new) return at->second;
  if (object.mass && object.mass->spread) {
    at->second.at = Vec3(object.mass->spread->centre.data());
    return at->second;
  }
  if (const auto shape = felt_shape(object, asset_root_)) {
    at->second.at = shape->center_of_mass;
    return at->second;
  }
  const Vec3 low(object.box_min.data()), high(object.box_max.data());
  at->second.at = (low + high) / 2;
  at->second.within = (high - low) / 4;
  return at->second;
}

}  // namespace probe::sema
