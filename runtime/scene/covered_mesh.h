// Meshes that look other than their file says: painted in one colour, or covered by a picture.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "runtime/base/geometry.h"
#include "runtime/scene/mesh.h"

namespace probe::scene {

// `rgb`: sRGB bytes. Roughness stays; nothing shines by itself or is metal.
Mesh painted_mesh(const Mesh& mesh, const std::array<std::uint8_t, 3>& rgb);

// Whether a triangle is covered, given its corners in the mesh's frame (m) and its unit normal.
using IsCovered =
    std::function<bool(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal)>;

// Every triangle that `is_covered` shows `picture`, laid on along the axis that is nearest its
// normal: a side of `side` metres is one picture, which repeats; its top is up. Others stay.
// `covered` counts them.
Mesh covered_mesh(const Mesh& mesh, const Texture& picture, double side,
                  const IsCovered& is_covered, std::size_t* covered = nullptr);

}  // namespace probe::scene
