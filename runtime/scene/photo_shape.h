// Whether a photo can stand behind a camera's picture.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "runtime/scene/image.h"

namespace probe::scene {

// Why not: a photo is scaled to the picture, so it has the picture's shape; a pixel of rounding is
// fine. Nothing where it can. Sizes in pixels.
std::optional<std::string> photo_defect(ImageSize photo, std::uint32_t width, std::uint32_t height);

}  // namespace probe::scene
