// Which triangle each sample of a picture shows: nearest wins, of equally near ones the last. A
// pixel has four samples, those that 4-sample antialiasing of hardware has; or, without it, one in
// its middle, kept four times.
#pragma once

#include <cstdint>
#include <vector>

namespace probe::render {

inline constexpr int kSubpixels = 256;  // a pixel's side, as corners are counted

// A corner as it is drawn: place in subpixels, row 0 on top, and 1 / depth (1/m).
struct DrawnCorner {
  std::int64_t x = 0, y = 0;
  float nearness = 0;
};

class SampleBuffer {
 public:
  using Floats = float __attribute__((vector_size(16)));
  using Ints = std::int32_t __attribute__((vector_size(16)));

  // `smooth`: four places a pixel.
  void resize(int width, int height, bool smooth);
  void clear();
  // The samples that are in the triangle and nearer than what is there become `id`; says whether
  // any did. Corners lie within 2^27 subpixels. A face whose corners turn against the clock as seen
  // is a front; the back of one shows nothing.
  bool draw(const DrawnCorner& a, const DrawnCorner& b, const DrawnCorner& c, std::uint32_t id);
  // What another buffer of the same size has in columns [left, right) of a row.
  void restore(const SampleBuffer& from, int row, int left, int right);

  const std::uint32_t* ids(int x, int y) const { return &id_[4 * at(x, y)]; }
  const float* nearness(int x, int y) const { return &nearness_[4 * at(x, y)]; }

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  int width_ = 0, height_ = 0;
  Ints across_{}, down_{};  // of the samples, subpixels from the pixel's left top
  int low_ = 0, high_ = 0;  // least and greatest of both
  std::vector<float> nearness_;
  std::vector<std::uint32_t> id_;
};

}  // namespace probe::render
