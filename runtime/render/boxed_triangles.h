// Triangles of few pixels, drawn by all samples of a box around each: what a loop would have to
// find out first costs more. The same samples as of SampleBuffer::draw.
#pragma once

#include <cstdint>

#include "runtime/render/drawn_corners.h"

namespace probe::render {

// What samples show, four a pixel, rows of `width` pixels.
struct SampleRows {
  float* nearness = nullptr;
  std::uint32_t* ids = nullptr;
  int width = 0;
};

// `side`: of the boxes, 2 or 3 pixels. Of each pixel's samples the first `taken` alone are drawn
// into. The number of a triangle is first_id + ids[its place in `triangles`].
void draw_boxes(const SmallTriangles& triangles, const SomeTriangles& boxed, int side,
                std::uint32_t first_id, const std::uint32_t* ids, const SampleGrid& grid, int taken,
                const SampleRows& rows);

}  // namespace probe::render
