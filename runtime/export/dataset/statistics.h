// What normalises a policy's inputs and outputs: least, greatest, mean, deviation and quantiles of
// every number, of an episode and, from those of its episodes, of a dataset. As LeRobot combines
// them (compute_stats.py): quantiles of a dataset are bounds, the least or greatest of its
// episodes'. Those of an episode are exact, where LeRobot interpolates in a histogram.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace probe::dataset {

inline constexpr std::array<double, 5> kQuantiles = {0.01, 0.10, 0.50, 0.90, 0.99};

// What each is called in files: `values` of Statistics in this order.
inline constexpr std::array<std::string_view, 9> kStatisticNames = {
    "min", "max", "mean", "std", "q01", "q10", "q50", "q90", "q99"};
inline constexpr std::size_t kMin = 0, kMax = 1, kMean = 2, kStd = 3, kFirstQuantile = 4;

struct Statistics {
  // One number for each dimension of what they are of.
  std::array<std::vector<double>, kStatisticNames.size()> values;
  std::int64_t count = 0;  // of frames
};

// `rows` is not empty: frame after frame of `size` numbers.
Statistics statistics_of(std::span<const double> rows, std::size_t size);

// Of pictures: their channels, 0..1. Bytes are counted, so nothing of the pictures is kept.
class PictureStatistics {
 public:
  // Every pixel, or of large pictures (a side of 300 and more) one in so many that about 150 a side
  // are left.
  void add(std::span<const std::uint8_t> rgb, int width, int height);
  // After one picture at least.
  Statistics finish() const;

 private:
  std::array<std::array<std::uint64_t, 256>, 3> counts_{};
  std::int64_t frames_ = 0;
};

// Which of `count` frames a picture's statistics are of: all of up to 100, else `count` to the
// power of 3/4 of them, 100 at least and 10,000 at most, evenly spread. Ascending.
std::vector<std::size_t> sampled_frames(std::size_t count);

class StatisticsSum {
 public:
  void add(const Statistics& part);
  const Statistics& total() const { return total_; }

 private:
  Statistics total_;
};

}  // namespace probe::dataset
