#include "runtime/rejudge/motion.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

using namespace probe;
using namespace probe::rejudge;

namespace {

const Told& of(const std::vector<Told>& told, MotionKind kind) {
  return told[static_cast<std::size_t>(kind)];
}

// Along a line by the movement of least jerk: x = D (10 s^3 - 15 s^4 + 6 s^5), s = t / T.
std::vector<Vec3> least_jerk(double distance, double time, double hz) {
  std::vector<Vec3> out;
  const int steps = static_cast<int>(std::lround(time * hz));
  for (int i = 0; i <= steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    const double x = distance * s * s * s * (10 + s * (6 * s - 15));
    out.emplace_back(0.6 * x, 0.8 * x, 1.0);
  }
  return out;
}

// The spectral arc length of the speed of least jerk, v(s) = 30 s^2 (1 - s)^2, from its Fourier
// integral, by Simpson's rule over s and many frequencies: no samples, no transform.
double arc_of_least_jerk(double time) {
  const auto magnitude = [&](double f) {
    constexpr int kIntervals = 2000;
    double re = 0, im = 0;
    for (int i = 0; i <= kIntervals; ++i) {
      const double s = static_cast<double>(i) / kIntervals;
      const double weight = i == 0 || i == kIntervals ? 1 : (i % 2 == 1 ? 4 : 2);
      const double v = 30 * s * s * (1 - s) * (1 - s) * weight / (3.0 * kIntervals);
      re += v * std::cos(2 * std::numbers::pi * f * time * s);
      im += v * std::sin(2 * std::numbers::pi * f * time * s);
    }
    return std::hypot(re, im);
  };
  constexpr double kStep = 0.002;
  std::vector<double> curve;
  for (double f = 0; f <= 10; f += kStep) curve.push_back(magnitude(f));
  while (curve.back() < 0.05) curve.pop_back();
  double length = 0;
  for (std::size_t i = 1; i < curve.size(); ++i)
    length += std::hypot(1 / static_cast<double>(curve.size() - 1), curve[i] - curve[i - 1]);
  return -length;
}

}  // namespace

TEST_CASE(
    "a movement of least jerk has the path, the jerk and the spectrum that its formula gives") {
  const auto told = motion_of(least_jerk(0.4, 2, 500), 500);
  CHECK(*of(told, MotionKind::k_path).value == doctest::Approx(0.4));
  // T^3 / v_max^2 times the integral of (v'')^2 is 720 / 1.875^2 whatever the distance and time.
  CHECK(*of(told, MotionKind::k_log_jerk).value ==
        doctest::Approx(-std::log(720 / (1.875 * 1.875))).epsilon(0.004));
  CHECK(*of(told, MotionKind::k_sparc).value ==
        doctest::Approx(arc_of_least_jerk(2)).epsilon(0.005));
  const auto longer = motion_of(least_jerk(0.1, 4, 250), 250);
  CHECK(*of(longer, MotionKind::k_log_jerk).value ==
        doctest::Approx(*of(told, MotionKind::k_log_jerk).value).epsilon(0.005));
}

TEST_CASE("a straight line of even speed has its length, no jerk, and stands nowhere still") {
  std::vector<Vec3> line;
  for (int i = 0; i <= 64; ++i) line.emplace_back(i / 64.0, 0, 0);
  const auto told = motion_of(line, 8);
  CHECK(*of(told, MotionKind::k_path).value == 1.0);
  CHECK(*of(told, MotionKind::k_still).value == 0.0);
  CHECK(!of(told, MotionKind::k_log_jerk).value);
  CHECK(of(told, MotionKind::k_log_jerk).why_not == "its speed never changed");
}

TEST_CASE("a pause is time in which the tool is still, and makes a movement rougher") {
  const std::vector<Vec3> whole = least_jerk(0.4, 2, 100);
  std::vector<Vec3> halting = least_jerk(0.2, 2, 100);
  const Vec3 middle = halting.back();
  halting.insert(halting.end(), 100, middle);
  for (const Vec3& p : least_jerk(0.2, 2, 100)) halting.push_back(middle + p - Vec3(0, 0, 1));
  const auto a = motion_of(whole, 100), b = motion_of(halting, 100);
  CHECK(*of(b, MotionKind::k_path).value == doctest::Approx(*of(a, MotionKind::k_path).value));
  CHECK(*of(b, MotionKind::k_still).value > 1.0);
  CHECK(*of(a, MotionKind::k_still).value < 0.5);
  CHECK(*of(b, MotionKind::k_sparc).value < *of(a, MotionKind::k_sparc).value);
  CHECK(*of(b, MotionKind::k_log_jerk).value < *of(a, MotionKind::k_log_jerk).value);
}

TEST_CASE("what did not move has a path and no smoothness, and says why") {
  const auto still = motion_of(std::vector<Vec3>(20, Vec3(1, 2, 3)), 5);
  CHECK(*of(still, MotionKind::k_path).value == 0.0);
  CHECK(*of(still, MotionKind::k_still).value == doctest::Approx(19 / 5.0));
  CHECK(!of(still, MotionKind::k_sparc).value);
  CHECK(of(still, MotionKind::k_sparc).why_not == "the tool did not move");
  const auto brief = motion_of(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, 5);
  CHECK(!of(brief, MotionKind::k_log_jerk).value);
  CHECK(of(brief, MotionKind::k_log_jerk).why_not == "fewer than 4 steps");
}

TEST_CASE("smoothness agrees with a script that sums what the definitions say") {
  const std::string script = VLAPROBE_SOURCE_DIR "/tests/runtime/rejudge/motion_reference.py";
  std::mt19937_64 draw(7);
  const auto noise = [&] { return static_cast<double>(draw() % 1000) / 1000.0 - 0.5; };
  for (const double hz : {3.0, 5.0, 20.0, 100.0}) {
    std::vector<Vec3> path = least_jerk(0.3, 12, hz);
    for (Vec3& p : path) p += 0.02 * Vec3(noise(), noise(), noise());
    const auto file =
        std::filesystem::temp_directory_path() / fmt::format("probe_motion_{}_{}", getpid(), hz);
    {
      std::ofstream out(file);
      out << fmt::format("{}\n", hz);
      for (const Vec3& p : path) out << fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
    }
    FILE* python =
        popen(("/usr/bin/python3 '" + script + "' < '" + file.string() + "'").c_str(), "r");
    REQUIRE(python != nullptr);
    double sparc = 0, log_jerk = 0;
    const int read = std::fscanf(python, "%lf %lf", &sparc, &log_jerk);
    const int exit = pclose(python);
    std::filesystem::remove(file);
    REQUIRE(exit == 0);
    REQUIRE(read == 2);
    const auto told = motion_of(path, hz);
    CHECK(*of(told, MotionKind::k_sparc).value == doctest::Approx(sparc).epsilon(1e-9));
    CHECK(*of(told, MotionKind::k_log_jerk).value == doctest::Approx(log_jerk).epsilon(1e-9));
  }
}
