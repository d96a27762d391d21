// A joint's way to rest under limits of speed, acceleration and jerk: the fastest one, or one that
// lasts a given time. A third-order profile: pieces of constant jerk. Knows no robot. Only + - * /
// and square roots, so same input gives same bits.
//
// The joint begins at any speed within the limit, without acceleration, and ends at rest. The
// family is Ruckig's (Berscheid and Kroeger 2021) for such states: to a cruising speed as fast as
// can be, along at it, to rest as fast as can be; and where no such speed lasts the time, two
// brakings of which the first is not let go of whole.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace probe::robot {

// rad or m, a second: all above 0.
struct PathLimits {
  double speed = 0, acceleration = 0, jerk = 0;
  bool operator==(const PathLimits&) const = default;
};

struct PathPoint {
  double position = 0, speed = 0;
};

struct Shoulder;

class JerkPath {
 public:
  // As fast as can be. `from.speed` is within the limit.
  static JerkPath fastest(const PathPoint& from, double to, const PathLimits& limits);
  // In `duration` s, no less than the fastest one's.
  static JerkPath lasting(const PathPoint& from, double to, const PathLimits& limits,
                          double duration);

  double duration() const { return duration_; }  // s
  // At a time from 0 on; behind the end it rests there.
  PathPoint at(double time) const;

 private:
  static constexpr std::size_t kMost = 7;
  struct Piece {
    double begin = 0;  // s
    double position = 0, speed = 0, acceleration = 0, jerk = 0;
  };

  JerkPath(const PathPoint& from, double to);
  void add(double seconds, double jerk);
  void change_speed(double by, const PathLimits& limits);
  void cruise(double speed, double seconds, const PathLimits& limits);
  void brake(const Shoulder& braking, bool early, double jerk);
  void brake_after(double push, double speed, double duration, double jerk);
  bool keeps(const PathLimits& limits) const;
  static JerkPath brake_in(const PathPoint& from, double to, const PathLimits& limits,
                           double duration);

  std::array<Piece, kMost + 1> pieces_{};  // the last: where the next would begin
  std::size_t count_ = 0;
  double to_ = 0, duration_ = 0;
};

// The joints' paths that end together: each the fastest where it is the slowest joint, else lasting
// as long. One `out` for each joint, which all have the same limits. Their duration, s.
double paths_together(std::span<const PathPoint> from, std::span<const double> to,
                      const PathLimits& limits, std::span<JerkPath> out);

}  // namespace probe::robot
