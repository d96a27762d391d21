#include "runtime/plan/moves.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/base/trig.h"

namespace probe::plan {
namespace {

using Point = std::array<double, 2>;

Way way_of(std::span<const MoveRecord> legs) { return static_cast<Way>(legs.front().way); }

double between(const Point& a, const Point& b) {
  const double x = b[0] - a[0], y = b[1] - a[1];
  return std::sqrt(x * x + y * y);
}

// On a circle about `centre` that begins at (0, 0), after so many rad.
Point on_circle(const Point& centre, double angle) {
  const SinCos turn = portable_sincos(angle);
  return {centre[0] - turn.cos * centre[0] + turn.sin * centre[1],
          centre[1] - turn.sin * centre[0] - turn.cos * centre[1]};
}

// From (0, 0) to each leg's end, and back to the beginning where it goes on from there.
std::vector<Point> way_points(std::span<const MoveRecord> legs) {
  std::vector<Point> points = {{0, 0}};
  for (const MoveRecord& leg : legs) points.push_back(leg.to);
  if (way_of(legs) == Way::kLoop) points.push_back({0, 0});
  return points;
}

double length_of(const std::vector<Point>& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += between(points[i - 1], points[i]);
  return length;
}

}  // namespace

std::string_view to_text(Way way) {
  switch (way) {
    case Way::kBack:
      return "";
    case Way::kLoop:
      return "loop";
    case Way::kOnce:
      return "once";
    case Way::kRound:
      return "around";
  }
  return "";
}

std::vector<std::span<const MoveRecord>> moves_of(const Tables& tables, const TaskRecord& task) {
  std::vector<std::span<const MoveRecord>> found;
  std::span<const MoveRecord> left = slice_of(tables.moves, task.moves);
  while (!left.empty()) {
    std::size_t legs = 1;
    while (legs < left.size() && left[legs].body == left.front().body) ++legs;
    found.push_back(left.first(legs));
    left = left.subspan(legs);
  }
  return found;
}

Point offset_at(std::span<const MoveRecord> legs, double seconds) {
  double along = legs.front().speed * seconds;  // m
  if (way_of(legs) == Way::kRound) {
    const Point& centre = legs.front().to;
    return on_circle(centre, std::fmod(along / between({0, 0}, centre), 2 * std::numbers::pi));
  }
  const std::vector<Point> points = way_points(legs);
  const double length = length_of(points);
  if (way_of(legs) == Way::kOnce) along = std::min(along, length);
  if (way_of(legs) == Way::kLoop) along = std::fmod(along, length);
  if (way_of(legs) == Way::kBack) {
    along = std::fmod(along, 2 * length);
    if (along > length) along = 2 * length - along;
  }
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Point &from = points[i - 1], &to = points[i];
    const double leg = between(from, to);
    if (along > leg && i + 1 < points.size()) {
      along -= leg;
      continue;
    }
    const double share = std::min(along / leg, 1.0);
    return {from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])};
  }
  return {0, 0};
}

double moves_until(std::span<const MoveRecord> legs) {
  if (way_of(legs) != Way::kOnce) return std::numeric_limits<double>::infinity();
  return length_of(way_points(legs)) / legs.front().speed;
}

std::vector<Point> corners_of(std::span<const MoveRecord> legs) {
  if (way_of(legs) != Way::kRound) return way_points(legs);
  std::vector<Point> points;
  for (int i = 0; i <= kCirclePoints; ++i)
    points.push_back(on_circle(legs.front().to, 2 * std::numbers::pi * i / kCirclePoints));
  return points;
}

std::string move_text(std::span<const MoveRecord> legs) {
  const bool is_round = way_of(legs) == Way::kRound;
  std::string text = is_round ? "around " : "along ";
  for (std::size_t i = 0; i < legs.size(); ++i) {
    text += fmt::format("{}({:.6g}cm, {:.6g}cm)", i == 0 ? "" : ", ", 100 * legs[i].to[0],
                        100 * legs[i].to[1]);
  }
  text += fmt::format(" at {:.6g}cm/s", 100 * legs.front().speed);
  if (!is_round && way_of(legs) != Way::kBack) text += " " + std::string(to_text(way_of(legs)));
  return text;
}

}  // namespace probe::plan
