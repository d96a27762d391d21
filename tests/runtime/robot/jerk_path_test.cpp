#include "runtime/robot/jerk_path.h"

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

namespace probe::robot {
namespace {

constexpr PathLimits kArm{1.5, 2, 50}, kFingers{1, 7, 50};

double rest_to_rest(double length, const PathLimits& limits) {
  return JerkPath::fastest({}, length, limits).duration();
}

TEST_CASE("from rest to rest a path lasts as the setup's page says") {
  const std::array<std::array<double, 2>, 6> of_arm = {
      {{0.01, 0.187}, {0.02, 0.244}, {0.05, 0.359}, {0.1, 0.489}, {0.2, 0.674}, {0.5, 1.041}}};
  for (const auto& [length, seconds] : of_arm) {
    CHECK(std::abs(rest_to_rest(length, kArm) - seconds) < 6e-4);
    CHECK(rest_to_rest(-length, kArm) == rest_to_rest(length, kArm));
  }
  CHECK(std::abs(rest_to_rest(1.31, kFingers) - 1.593) < 6e-4);
  const PathPoint after = JerkPath::fastest({}, 1.31, kFingers).at(1.0 / 3);
  CHECK(std::abs(after.position - 0.192) < 6e-4);
  CHECK(after.speed == doctest::Approx(1.0));
}

// Two joints under the arm's limits, of which the second begins at rest and is the slower one:
// recorded from Ruckig 0.17 (its default settings), the first joint at two times.
struct Recorded {
  double speed, to, slower_to, duration;
  std::array<std::array<double, 3>, 2> at;  // s, rad, rad/s
};
const Recorded kRecorded[] = {
    {0.2,
     0.05,
     0.3,
     0.815628777187,
     {{{0.15, 0.016305268442, 0.053230180472}, {0.25, 0.021628286490, 0.053230180472}}}},
    {0.6,
     0.25,
     0.35,
     0.877615663655,
     {{{0.15, 0.072966666667, 0.340000000000}, {0.25, 0.101675818841, 0.275289598138}}}},
    {-0.4,
     0.1,
     0.3,
     0.815628777187,
     {{{0.15, -0.042966666667, -0.140000000000}, {0.25, -0.046966666667, 0.060000000000}}}},
    {0.9,
     0.1,
     0.5,
     1.040799680256,
     {{{0.15, 0.117966666667, 0.640000000000}, {0.25, 0.171966666667, 0.440000000000}}}},
    {0.12638513370785778,
     0.00798835208554552,
     0.004211933869636964,
     0.139172631578,
     {{{0.03976360902215983, 0.004501597183, 0.086867024388},
       {0.07952721804431966, 0.006902118738, 0.041812546811}}}},
    {0.0938123525385656,
     0.00487880565615923,
     0.0015472349360312468,
     0.099673278998,
     {{{0.028478079713833294, 0.002556661905, 0.079183646867},
       {0.05695615942766659, 0.004257350338, 0.039995447463}}}},
    {0.16194185923913396,
     0.009813579451592327,
     0.002802209325235347,
     0.121495497203,
     {{{0.034712999200892304, 0.005272913487, 0.131817051401},
       {0.06942599840178461, 0.008666712609, 0.063089862436}}}},
    {1.493552618618275,
     0.638531942739345,
     0.3078563145068333,
     0.825692451926,
     {{{0.23591212912174647, 0.313748993151, 1.139560645609},
       {0.47182425824349294, 0.526930638653, 0.667736387365}}}},
};

TEST_CASE("paths that end together are those that were recorded") {
  for (const Recorded& r : kRecorded) {
    CAPTURE(r.speed);
    CAPTURE(r.to);
    const std::array<PathPoint, 2> from = {PathPoint{0, r.speed}, PathPoint{}};
    const std::array<double, 2> to = {r.to, r.slower_to};
    std::vector<JerkPath> paths(2, JerkPath::fastest({}, 0, kArm));
    CHECK(paths_together(from, to, kArm, paths) == doctest::Approx(r.duration).epsilon(1e-10));
    for (const auto& [time, position, speed] : r.at) {
      const PathPoint now = paths[0].at(time);
      CHECK(std::abs(now.position - position) < 1e-9);
      CHECK(std::abs(now.speed - speed) < 1e-8);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(std::abs(paths[i].at(r.duration - 1e-9).position - to[i]) < 1e-8);
      CHECK(paths[i].at(r.duration + 1e-9).position == to[i]);
    }
  }
}

TEST_CASE("a path goes on without a jump, keeps its limits and ends at rest where it should") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1, 1), stretch(1, 3);
  for (int i = 0; i < 2000; ++i) {
    const PathPoint from{0.1 * unit(random), kArm.speed * unit(random)};
    const double to = unit(random) * (i % 2 == 0 ? 0.05 : 1.0);
    const JerkPath fastest = JerkPath::fastest(from, to, kArm);
    const double duration = fastest.duration() *
                            (i % 3 == 0 ? 1 + 0.01 * unit(random) * unit(random) : stretch(random));
    const JerkPath path = i % 3 == 0 && duration < fastest.duration()
                              ? fastest
                              : JerkPath::lasting(from, to, kArm, duration);
    CAPTURE(from.speed);
    CAPTURE(to - from.position);
    CAPTURE(duration);
    const int steps = 400;
    const double h = path.duration() / steps;
    PathPoint before = path.at(0);
    CHECK(before.position == from.position);
    CHECK(before.speed == from.speed);
    double acceleration = 0;
    bool smooth = true, limited = true;
    for (int k = 1; k <= steps; ++k) {
      const PathPoint now = path.at(k * h);
      const double mean = (now.speed - before.speed) / h;
      smooth = smooth && std::abs(now.position - before.position -
                                  0.5 * h * (now.speed + before.speed)) < 60 * h * h * h + 1e-9;
      limited = limited && std::abs(now.speed) <= kArm.speed + 1e-8 &&
                std::abs(mean) <= kArm.acceleration + 1e-6 &&
                std::abs(mean - acceleration) <= kArm.jerk * h * 1.01 + 1e-6;
      acceleration = mean;
      before = now;
    }
    CHECK(smooth);
    CHECK(limited);
    CHECK(std::abs(acceleration) <= kArm.jerk * h + 1e-6);
    CHECK(std::abs(path.at(path.duration() * (1 - 1e-12)).position - to) < 1e-8);
  }
}

TEST_CASE("a joint that is where it shall be stays, however long the others take") {
  const JerkPath path = JerkPath::lasting({0.3, 0}, 0.3, kArm, 0.7);
  for (const double time : {0.0, 0.2, 0.7, 2.0}) {
    CHECK(path.at(time).position == 0.3);
    CHECK(path.at(time).speed == 0);
  }
}

}  // namespace
}  // namespace probe::robot
