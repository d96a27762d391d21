// What of many small triangles a picture can show at all: most of a fine mesh look away, or lie
// between the samples, and most of the rest lie in few pixels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime/render/sample_buffer.h"

namespace probe::render {

// The numbers of those that SampleBuffer::draw has to see, and of those for draw_boxed, by box.
// Nothing would be seen of the rest.
struct SeenTriangles {
  SomeTriangles to_draw;
  std::array<SomeTriangles, SampleBuffer::kBoxes.size()> boxed;
};

// Corners lie within 2^27 subpixels.
void find_seen(const SmallTriangles& triangles, const SampleBuffer& picture, SeenTriangles& out);

}  // namespace probe::render
