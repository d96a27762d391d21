#include "runtime/show/picture.h"

#include <algorithm>

#include "runtime/base/check.h"

namespace probe::show {
namespace {

using Color = std::array<std::uint8_t, 3>;

std::size_t offset(const Picture& picture, int x, int y) {
  return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
              static_cast<std::size_t>(x));
}

}  // namespace

void fill(Picture& picture, int x0, int y0, int width, int height, Color color) {
  for (int y = std::max(0, y0); y < std::min(picture.height, y0 + height); ++y) {
    for (int x = std::max(0, x0); x < std::min(picture.width, x0 + width); ++x) {
      std::copy(color.begin(), color.end(),
                picture.rgb.begin() + static_cast<std::ptrdiff_t>(offset(picture, x, y)));
    }
  }
}

Picture make_picture(int width, int height, Color color) {
  PROBE_CHECK(width > 0 && height > 0, "a picture has at least one pixel");
  Picture picture{width, height, {}};
  picture.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  fill(picture, 0, 0, width, height, color);
  return picture;
}

Picture copy_picture(int width, int height, std::span<const std::uint8_t> rgb) {
  PROBE_CHECK(rgb.size() == 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
              "three bytes a pixel");
  return {width, height, {rgb.begin(), rgb.end()}};
}

Picture shrink(const Picture& picture, int width, int height) {
  Picture small = make_picture(width, height, {0, 0, 0});
  for (int y = 0; y < height; ++y) {
    const int top = y * picture.height / height;
    const int bottom = std::max(top + 1, (y + 1) * picture.height / height);
    for (int x = 0; x < width; ++x) {
      const int left = x * picture.width / width;
      const int right = std::max(left + 1, (x + 1) * picture.width / width);
      std::array<unsigned, 3> sum{};
      for (int v = top; v < bottom; ++v) {
        for (int u = left; u < right; ++u) {
          for (std::size_t c = 0; c < 3; ++c) sum[c] += picture.rgb[offset(picture, u, v) + c];
        }
      }
      const auto count = static_cast<unsigned>((bottom - top) * (right - left));
      for (std::size_t c = 0; c < 3; ++c) {
        small.rgb[offset(small, x, y) + c] =
            static_cast<std::uint8_t>((sum[c] + count / 2) / count);
      }
    }
  }
  return small;
}

void paste(Picture& onto, const Picture& what, int x, int y) {
  for (int v = std::max(0, -y); v < what.height && y + v < onto.height; ++v) {
    for (int u = std::max(0, -x); u < what.width && x + u < onto.width; ++u) {
      for (std::size_t c = 0; c < 3; ++c) {
        onto.rgb[offset(onto, x + u, y + v) + c] = what.rgb[offset(what, u, v) + c];
      }
    }
  }
}

}  // namespace probe::show
