// Triangles as they are drawn: corners in whole numbers, where the samples of pixels lie.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace probe::render {

inline constexpr int kSubpixels = 256;  // a pixel's side, as corners are counted

// A corner as it is drawn: place in subpixels, row 0 on top, and 1 / depth (1/m).
struct DrawnCorner {
  std::int32_t x = 0, y = 0;
  float nearness = 0;
};

// Corners as above, in arrays, and triangles of them, at most kMost.
struct SmallTriangles {
  static constexpr std::size_t kMost = 128;
  const std::int32_t* x = nullptr;
  const std::int32_t* y = nullptr;
  const float* nearness = nullptr;
  std::array<const std::uint16_t*, 3> corner{};
  std::size_t count = 0;
};

// The numbers of some of them.
struct SomeTriangles {
  std::array<std::uint16_t, SmallTriangles::kMost> which;
  std::size_t count = 0;
};

// Where the samples of a pixel lie, subpixels from its left top; least and greatest of both.
struct SampleGrid {
  std::array<std::int32_t, 4> across{}, down{};
  int low = 0, high = 0;
};

}  // namespace probe::render
