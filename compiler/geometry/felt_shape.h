// What is felt of an object: its collision mesh, at its scale.
#pragma once

#include "compiler/model/model.h"
#include "runtime/base/asset_root.h"
#include "runtime/scene/collision_shape.h"

namespace probe::sema {

// Reads a file. Fails where it is not there or no shape; that is said where assets are collected.
Result<scene::CollisionShape> felt_shape(const Object& object, const AssetRoot& asset_root);

}  // namespace probe::sema
