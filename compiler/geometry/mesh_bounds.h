// How large a model is along its own axes, read from its collision mesh: what a declared box can be
// compared with. Looks at positions alone; shapes are the scene library's.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/base/asset_root.h"

namespace probe::sema {

struct Bounds {
  std::array<double, 3> low{}, high{};  // m, model frame
};

// Of the positions (`v x y z`) of a Wavefront text; nothing when there is none or one is no number.
std::optional<Bounds> bounds_of_obj(std::string_view text);
// Of assets/objects/MESH/collision.obj; nothing as well when the file cannot be read, which is
// reported where assets are collected.
std::optional<Bounds> bounds_of_mesh(const AssetRoot& asset_root, const std::string& mesh);

}  // namespace probe::sema
