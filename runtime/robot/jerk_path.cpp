// All is worked out for a joint that does not move down at first; one that does is its mirror
// image. Roots are found by bisection between bounds of which the functions are monotone, down to
// neighbouring numbers: exact enough, and the same everywhere.
#include "runtime/robot/jerk_path.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/check.h"

namespace probe::robot {
namespace {

// The least time in which a speed changes by `by` >= 0, without acceleration before and after: a
// triangle of acceleration, or a trapezoid.
double change_time(double by, const PathLimits& l) {
  if (by * l.jerk <= l.acceleration * l.acceleration) return 2 * std::sqrt(by / l.jerk);
  return by / l.acceleration + l.acceleration / l.jerk;
}

// From `speed` >= 0 to a cruising speed and to rest from there.
struct Cruise {
  double to = 0, rest = 0;  // s
  double time() const { return to + rest; }
};
Cruise changes(double speed, double cruise, const PathLimits& l) {
  return {change_time(std::abs(cruise - speed), l), change_time(std::abs(cruise), l)};
}

// How far that leads, without time at the cruising speed. Speeds change evenly about their middle.
double changes_length(double speed, double cruise, const PathLimits& l) {
  const Cruise c = changes(speed, cruise, l);
  return 0.5 * (speed + cruise) * c.to + 0.5 * cruise * c.rest;
}

double length_of(double speed, double cruise, double duration, const PathLimits& l) {
  return changes_length(speed, cruise, l) + cruise * (duration - changes(speed, cruise, l).time());
}

// Where `is_low` turns from true to false between two numbers of which the first is low.
template <typename IsLow>
double turning(double low, double high, IsLow is_low) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (is_low(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

// Braking to rest in a time that is longer than needed: the deceleration rises with the jerk to a
// peak, is held there, falls to a shoulder, is held there, and falls to 0. From the trapezoid,
// whose shoulder is as high as its peak, to the fastest braking, with no shoulder but a wait at
// rest.
struct Shoulder {
  double peak = 0, flat = 0;      // rad/s2 or m/s2, and s at it
  double shoulder = 0, held = 0;  // the same
};

namespace {

Shoulder shoulder_of(double speed, double duration, double peak, double flat, const PathLimits& l) {
  const double held = duration - 2 * peak / l.jerk - flat;
  const double left = speed - peak * (peak / l.jerk + flat);
  return {peak, flat, held > 0 ? std::clamp(left / held, 0.0, peak) : 0, std::max(held, 0.0)};
}

}  // namespace

JerkPath::JerkPath(const PathPoint& from, double to) : to_(to) {
  pieces_[0] = {0, from.position, from.speed, 0, 0};
}

void JerkPath::add(double seconds, double jerk) {
  if (!(seconds > 0)) return;
  PROBE_CHECK(count_ < kMost, "a path has seven pieces");
  Piece& now = pieces_[count_];
  now.jerk = jerk;
  const double t = seconds;
  pieces_[++count_] = {
      now.begin + t, now.position + t * (now.speed + t * (now.acceleration / 2 + t * jerk / 6)),
      now.speed + t * (now.acceleration + t * jerk / 2), now.acceleration + t * jerk, 0};
  duration_ = pieces_[count_].begin;
}

void JerkPath::change_speed(double by, const PathLimits& l) {
  const double size = std::abs(by), jerk = by < 0 ? -l.jerk : l.jerk;
  const bool sharp = size * l.jerk <= l.acceleration * l.acceleration;
  const double rise = sharp ? std::sqrt(size / l.jerk) : l.acceleration / l.jerk;
  add(rise, jerk);
  if (!sharp) add(size / l.acceleration - rise, 0);
  add(rise, -jerk);
  pieces_[count_].acceleration = 0;  // but for rounding it is
}

void JerkPath::cruise(double speed, double seconds, const PathLimits& l) {
  change_speed(speed - pieces_[0].speed, l);
  pieces_[count_].speed = speed;
  add(seconds, 0);
  change_speed(-speed, l);
}

void JerkPath::brake(const Shoulder& s, bool early, double jerk) {
  const double size = std::abs(jerk);
  const double foot = s.shoulder / size, fall = (s.peak - s.shoulder) / size;
  if (early) {
    add(s.peak / size, jerk);
    add(s.flat, 0);
    add(fall, -jerk);
    add(s.held, 0);
    add(foot, -jerk);
    return;
  }
  add(foot, jerk);
  add(s.held, 0);
  add(fall, jerk);
  add(s.flat, 0);
  add(s.peak / size, -jerk);
}

// Before it brakes it speeds up for `push` s at the jerk.
void JerkPath::brake_after(double push, double speed, double duration, double jerk) {
  const double size = std::abs(jerk);
  const double width = duration - 2 * push, part = speed / size + push * push;
  const double root = std::sqrt(std::max(0.0, width * width - 4 * part));
  const double peak = 2 * part / (width + root);  // s at the jerk
  add(push, -jerk);
  add(push + peak, jerk);
  add(width - 2 * peak, 0);
  add(peak, -jerk);
}

JerkPath JerkPath::fastest(const PathPoint& from, double to, const PathLimits& limits) {
  JerkPath path(from, to);
  const double stop = from.position + 0.5 * from.speed * change_time(std::abs(from.speed), limits);
  if (to == stop) {
    path.change_speed(-from.speed, limits);
    return path;
  }
  // Upwards from where it would come to rest by itself, or the mirror image.
  const double way = to > stop ? 1 : -1;
  const double speed = way * from.speed, length = way * (to - from.position);
  const double all = changes_length(speed, limits.speed, limits);
  if (all <= length) {
    path.cruise(way * limits.speed, (length - all) / limits.speed, limits);
    return path;
  }
  const double peak = turning(std::max(0.0, speed), limits.speed, [&](double cruise) {
    return changes_length(speed, cruise, limits) < length;
  });
  path.cruise(way * peak, 0, limits);
  return path;
}

JerkPath JerkPath::lasting(const PathPoint& from, double to, const PathLimits& limits,
                           double duration) {
  JerkPath path(from, to);
  const double way = from.speed < 0 ? -1 : 1;
  const double speed = way * from.speed, length = way * (to - from.position);
  const auto time = [&](double cruise) { return changes(speed, cruise, limits).time(); };
  const auto reached = [&](double cruise) { return length_of(speed, cruise, duration, limits); };
  const auto cruise = [&](double at) {
    path.cruise(way * at, std::max(0.0, duration - time(at)), limits);
    return path;
  };
  const auto between = [&](double low, double high) {
    return cruise(turning(low, high, [&](double at) { return reached(at) < length; }));
  };
  if (reached(0) == length) return cruise(0);
  if (length < reached(0)) {
    return cruise(turning(-limits.speed, 0,
                          [&](double at) { return time(at) > duration || reached(at) < length; }));
  }
  if (length >= reached(speed)) {
    return cruise(turning(speed, limits.speed,
                          [&](double at) { return time(at) <= duration && reached(at) < length; }));
  }
  if (time(0.5 * speed) <= duration) return between(0, speed);
  // Cruising speeds about the middle would take longer than there is.
  const double slow = turning(0, 0.5 * speed, [&](double at) { return time(at) <= duration; });
  const double fast = speed - slow;
  if (length <= reached(slow)) return between(0, slow);
  if (length >= reached(fast)) return between(fast, speed);
  return brake_in(from, to, limits, duration);
}

JerkPath JerkPath::brake_in(const PathPoint& from, double to, const PathLimits& l,
                            double duration) {
  const double way = from.speed < 0 ? -1 : 1;
  const double speed = way * from.speed, length = way * (to - from.position);
  const double jerk = -way * l.jerk;
  const auto reached = [&](const JerkPath& path) {
    return way * (path.pieces_[path.count_].position - from.position);
  };
  const double half = 0.5 * duration;
  const double root = std::sqrt(std::max(0.0, half * half - speed / l.jerk));  // s
  const bool early = length < speed * half;
  if (!early && half > 0) {
    const auto pushed = [&](double push) {
      JerkPath path(from, to);
      path.brake_after(push, speed, duration, jerk);
      return path;
    };
    // Up to where the braking has no flat.
    const double most = 0.5 * root * root / half;
    const JerkPath path =
        pushed(turning(0, most, [&](double push) { return reached(pushed(push)) < length; }));
    if (path.keeps(l)) return path;
  }
  const auto braked = [&](double peak, double flat) {
    JerkPath path(from, to);
    path.brake(shoulder_of(speed, duration, peak, flat, l), early, jerk);
    return path;
  };
  // The higher and longer the peak, the shorter the way, or the longer where it comes last.
  const auto is_low = [&](double peak, double flat) {
    const double now = reached(braked(peak, flat));
    return early ? now > length : now < length;
  };
  const double least = l.jerk * (half - root);
  const double most = std::min(l.acceleration, std::sqrt(l.jerk * speed));
  if (most == l.acceleration && is_low(most, 0)) {
    return braked(most, turning(0, speed / most - most / l.jerk,
                                [&](double flat) { return is_low(most, flat); }));
  }
  return braked(turning(least, most, [&](double peak) { return is_low(peak, 0); }), 0);
}

bool JerkPath::keeps(const PathLimits& l) const {
  constexpr double kOver = 1e-9;  // of rounding
  for (std::size_t i = 0; i <= count_; ++i) {
    const Piece& p = pieces_[i];
    if (std::abs(p.speed) > l.speed + kOver) return false;
    if (std::abs(p.acceleration) > l.acceleration + kOver) return false;
    // Within a piece, where its acceleration goes through 0.
    if (i == count_ || !(p.acceleration * pieces_[i + 1].acceleration < 0)) continue;
    const double top = p.speed - p.acceleration * p.acceleration / (2 * p.jerk);
    if (std::abs(top) > l.speed + kOver) return false;
  }
  return true;
}

PathPoint JerkPath::at(double time) const {
  if (time >= duration_) return {to_, 0};
  std::size_t i = 0;
  while (i + 1 < count_ && pieces_[i + 1].begin <= time) ++i;
  const Piece& piece = pieces_[i];
  const double t = time - piece.begin;
  return {piece.position + t * (piece.speed + t * (piece.acceleration / 2 + t * piece.jerk / 6)),
          piece.speed + t * (piece.acceleration + t * piece.jerk / 2)};
}

double paths_together(std::span<const PathPoint> from, std::span<const double> to,
                      const PathLimits& limits, std::span<JerkPath> out) {
  PROBE_CHECK(from.size() == to.size() && out.size() == to.size(), "a path a joint");
  double duration = 0;
  for (std::size_t i = 0; i < to.size(); ++i) {
    out[i] = JerkPath::fastest(from[i], to[i], limits);
    duration = std::max(duration, out[i].duration());
  }
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (out[i].duration() == duration) continue;
    out[i] = JerkPath::lasting(from[i], to[i], limits, duration);
  }
  return duration;
}

}  // namespace probe::robot
