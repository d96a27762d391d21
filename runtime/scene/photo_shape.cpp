#include "runtime/scene/photo_shape.h"

#include <algorithm>
#include <cmath>

namespace probe::scene {

std::optional<std::string> photo_defect(ImageSize photo, std::uint32_t width,
                                        std::uint32_t height) {
  const double across = static_cast<double>(photo.width) * height;
  const double down = static_cast<double>(photo.height) * width;
  // A pixel, but not where one is all there is of the shape.
  const double rounding = std::min(1.5 * std::max(width, height), 0.05 * down);
  if (std::abs(across - down) <= std::max(rounding, 0.01 * down)) return std::nullopt;
  const auto size = [](auto w, auto h) { return std::to_string(w) + " x " + std::to_string(h); };
  return "the photo is " + size(photo.width, photo.height) + " pixels, the camera's picture " +
         size(width, height) +
         ": a photo of another size is scaled, one of another shape must be cut first";
}

}  // namespace probe::scene
