// What of many small triangles a picture can show at all: most of a fine mesh look away, or lie
// between the samples, and most of the rest hold one or two.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime/render/sample_buffer.h"

namespace probe::render {

// Corners as SampleBuffer counts them, and triangles of them, at most kMost.
struct SmallTriangles {
  static constexpr std::size_t kMost = 128;
  const std::int32_t* x = nullptr;
  const std::int32_t* y = nullptr;
  const float* nearness = nullptr;
  std::array<const std::uint16_t*, 3> corner{};
  std::size_t count = 0;
};

// The numbers of those that have to be drawn, and the samples that the others, smaller than a
// pixel, hold. SampleBuffer::draw would show the same of them, and nothing of the rest.
struct SeenTriangles {
  struct Sample {
    std::uint32_t at = 0;  // (y width + x) 4 + which
    float nearness = 0;
    std::uint32_t triangle = 0;
  };
  std::array<std::uint16_t, SmallTriangles::kMost> to_draw;
  std::array<Sample, 4 * SmallTriangles::kMost> samples;
  std::size_t draws = 0, held = 0;
};

// Corners lie within 2^27 subpixels.
void find_seen(const SmallTriangles& triangles, const SampleBuffer& picture, SeenTriangles& out);

}  // namespace probe::render
