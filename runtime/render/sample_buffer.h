// Which triangle each sample of a picture shows: nearest wins, of equally near ones the one of the
// greatest number, in whatever order they are drawn. A
// pixel has four samples, those that 4-sample antialiasing of hardware has; or, without it, one in
// its middle, kept four times.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace probe::render {

inline constexpr int kSubpixels = 256;  // a pixel's side, as corners are counted

// A corner as it is drawn: place in subpixels, row 0 on top, and 1 / depth (1/m).
struct DrawnCorner {
  std::int32_t x = 0, y = 0;
  float nearness = 0;
};

// Where the samples of a pixel lie, subpixels from its left top; least and greatest of both.
struct SampleGrid {
  std::array<std::int32_t, 4> across{}, down{};
  int low = 0, high = 0;
};

class SampleBuffer {
 public:
  // `smooth`: four places a pixel.
  void resize(int width, int height, bool smooth);
  void clear();
  // Columns and rows to the last ones too.
  void clear(int left, int right, int top, int bottom);
  // Of each pixel's samples the first so many alone, 1 to 4, are drawn into from now on.
  void take(int samples) { taken_ = samples; }
  // The samples that are in the triangle and nearer than what is there become `id`, from 1 on and
  // below 2^31. Corners lie within 2^27 subpixels. A face whose corners turn against the clock as
  // seen is a front; the back of one shows nothing.
  void draw(const DrawnCorner& a, const DrawnCorner& b, const DrawnCorner& c, std::uint32_t id);
  // One sample, numbered (y width + x) 4 + which, that a triangle holds. `note` says where such
  // are.
  void put(std::size_t sample, float nearness, std::uint32_t id) {
    if (static_cast<int>(sample % 4) >= taken_) return;
    float& near = nearness_[sample];
    std::uint32_t& shown = id_[sample];
    const bool passes = nearness > near || (nearness == near && id >= shown);
    near = passes ? nearness : near;
    shown = passes ? id : shown;
  }
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
  int taken_ = 4;
  std::vector<float> farthest_;        // by tile
  std::vector<std::uint8_t> changed_;  // since it was looked at
  bool is_looked_at_ = false;          // any
  SampleGrid grid_;
  std::vector<float> nearness_;
  std::vector<std::uint32_t> id_;
};

}  // namespace probe::render
