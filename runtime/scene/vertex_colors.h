// Colours at vertices as a texture, so that the renderer knows one way to colour a triangle.
#pragma once

#include <span>
#include <vector>

#include "runtime/scene/color.h"
#include "runtime/scene/mesh.h"

namespace probe::scene {

// Gives `part` (one linear colour a vertex, in [0, 1]) a texture with 4 x 4 texels a triangle, the
// three corners at texel centres: bilinear reading between them is the linear mix of the corners,
// but along the side between the second and the third, where it may be off by a few levels.
// Vertices are no longer shared afterwards. Colours that are all equal become `material`'s factor.
void bake_vertex_colors(std::span<const LinearRgb> colors, MeshPart& part, Material& material,
                        std::vector<Texture>& textures);

// The sRGB byte nearest to a linear value.
std::uint8_t to_srgb_byte(float linear);

}  // namespace probe::scene
