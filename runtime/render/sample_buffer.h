// Which triangle each sample of a picture shows: nearest wins, of equally near ones the one of the
// greatest number, in whatever order they are drawn. A pixel has four samples, those that 4-sample
// antialiasing of hardware has; or, without it, one in its middle, kept four times.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/render/drawn_corners.h"

namespace probe::render {

class SampleBuffer {
 public:
  // `smooth`: four places a pixel.
  void resize(int width, int height, bool smooth);
  void clear();
  // Columns and rows to the last ones too; what is drawn beyond them need not be there from now on.
  void clear(int left, int right, int top, int bottom);
  // Of each pixel's samples the first so many alone, 1 to 4, are drawn into from now on.
  void take(int samples) { taken_ = samples; }
  // The samples that are in the triangle and nearer than what is there become `id`, from 1 on and
  // below 2^31. Corners lie within 2^27 subpixels. A face whose corners turn against the clock as
  // seen is a front; the back of one shows nothing.
  void draw(const DrawnCorner& a, const DrawnCorner& b, const DrawnCorner& c, std::uint32_t id);
  // The same of fronts, of which all samples lie in a box of kBoxes[box] pixels a side in the
  // picture, the first of which has the first sample that is not left of or above all corners.
  // The number of a triangle is first_id + ids[its place in `triangles`].
  static constexpr std::array<int, 2> kBoxes{2, 3};
  void draw_boxed(const SmallTriangles& triangles, const SomeTriangles& boxed, std::size_t box,
                  std::uint32_t first_id, const std::uint32_t* ids);
  // What draw_boxed may have changed.
  void note(int left, int right, int top, int bottom);
  // Whether samples that near would be behind everything there is in these columns and rows, to the
  // last ones; an area of many pixels is taken for seen. What is drawn makes no difference then.
  bool hides(int left, int right, int top, int bottom, float nearness);
  // What another buffer of the same size has in columns [left, right) of a row.
  void restore(const SampleBuffer& from, int row, int left, int right);

  int width() const { return width_; }
  int height() const { return height_; }
  const SampleGrid& grid() const { return grid_; }
  const std::uint32_t* ids(int x, int y) const { return &id_[4 * at(x, y)]; }
  const float* nearness(int x, int y) const { return &nearness_[4 * at(x, y)]; }

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  // Pixels in squares of kTile a side, and how near the farthest sample of each is: as it was when
  // it was looked at last, which is no nearer than it is now.
  static constexpr int kTileShift = 3, kTile = 1 << kTileShift;
  std::size_t tile_at(int column, int row) const {
    return static_cast<std::size_t>(row * tiles_across_ + column);
  }
  float look_at(int column, int row);
  void forget(int left, int right, int top, int bottom);

  int width_ = 0, height_ = 0, tiles_across_ = 0;
  int left_ = 0, right_ = 0, top_ = 0, bottom_ = 0;  // what is drawn in; the last ones too
  int taken_ = 4;
  std::vector<float> farthest_;        // by tile
  std::vector<std::uint8_t> changed_;  // since it was looked at
  bool is_looked_at_ = false;          // any
  SampleGrid grid_;
  std::vector<float> nearness_;
  std::vector<std::uint32_t> id_;
};

}  // namespace probe::render
