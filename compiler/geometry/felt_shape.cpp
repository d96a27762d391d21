#include "compiler/geometry/felt_shape.h"

#include "runtime/scene/collision_mesh.h"

namespace probe::sema {

Result<scene::CollisionShape> felt_shape(const Object& object, const AssetRoot& asset_root) {
  return scene::load_collision_mesh(
      asset_root.file("objects/" + object.mesh.text + "/collision.obj"),
      Vec3::Constant(object.scale));
}

}  // namespace probe::sema
