// Numbers that policies are normalised with.
#include "runtime/export/dataset/statistics.h"

#include <doctest/doctest.h>

#include <cmath>

namespace probe::dataset {
namespace {

TEST_CASE(
    "an episode's statistics are those of each dimension, its quantiles between the nearest") {
  const std::vector<double> rows = {4, -1, 1, -1, 2, -1, 3, -1, 5, -1};
  const Statistics of = statistics_of(rows, 2);
  CHECK(of.count == 5);
  CHECK(of.values[kMin] == std::vector<double>{1, -1});
  CHECK(of.values[kMax] == std::vector<double>{5, -1});
  CHECK(of.values[kMean] == std::vector<double>{3, -1});
  CHECK(of.values[kStd][0] == doctest::Approx(std::sqrt(2.0)));
  CHECK(of.values[kStd][1] == 0);
  CHECK(of.values[kFirstQuantile][0] == doctest::Approx(1.04));     // 0.01
  CHECK(of.values[kFirstQuantile + 2][0] == 3);                     // the median
  CHECK(of.values[kFirstQuantile + 3][0] == doctest::Approx(4.6));  // 0.9
}

TEST_CASE("episodes together have the mean and deviation of all frames, and bounds of quantiles") {
  const std::vector<double> a = {1, 2, 3, 4}, b = {10, 20}, all = {1, 2, 3, 4, 10, 20};
  StatisticsSum sum;
  sum.add(statistics_of(a, 1));
  sum.add(statistics_of(b, 1));
  const Statistics whole = statistics_of(all, 1);
  for (const std::size_t which : {kMin, kMax, kMean, kStd})
    CHECK(sum.total().values[which][0] == doctest::Approx(whole.values[which][0]));
  CHECK(sum.total().count == 6);
  CHECK(sum.total().values[kFirstQuantile + 2][0] == 2.5);  // the least median
  CHECK(sum.total().values[kFirstQuantile + 4][0] == doctest::Approx(19.9));
}

TEST_CASE("a picture's statistics are of its channels, of large ones of some pixels alone") {
  PictureStatistics small;
  const std::vector<std::uint8_t> rgb = {0, 10, 255, 255, 10, 255};
  small.add(rgb, 2, 1);
  const Statistics of = small.finish();
  CHECK(of.count == 1);
  CHECK(of.values[kMean][0] == doctest::Approx(0.5));
  CHECK(of.values[kStd][0] == doctest::Approx(0.5));
  CHECK(of.values[kMax][1] == doctest::Approx(10 / 255.0));
  CHECK(of.values[kFirstQuantile + 2][0] == doctest::Approx(0.5));
  PictureStatistics large;  // every second pixel of every second row
  std::vector<std::uint8_t> striped(300 * 300 * 3, 0);
  for (std::size_t i = 0; i < striped.size(); ++i) striped[i] = (i / 3) % 2 == 1 ? 255 : 0;
  large.add(striped, 300, 300);
  CHECK(large.finish().values[kMax][0] == 0);
}

TEST_CASE("long episodes are sampled from their first to their last frame") {
  CHECK(sampled_frames(1) == std::vector<std::size_t>{0});
  CHECK(sampled_frames(60).size() == 60);
  const auto some = sampled_frames(10'000);
  CHECK(some.size() == 1000);
  CHECK(some.front() == 0);
  CHECK(some.back() == 9'999);
}

}  // namespace
}  // namespace probe::dataset
