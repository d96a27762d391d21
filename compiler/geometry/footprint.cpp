#include "compiler/geometry/footprint.h"

#include <algorithm>
#include <cmath>

namespace probe::sema {

double Footprint::reach_along(const Vec2& n) const {
  double sum = 0;
  for (const Vec2& axis : axes) sum += std::abs(axis.x * n.x + axis.y * n.y);
  return sum;
}

Footprint footprint(const Object& object, const Start::Placed& placed) {
  const auto& [w, x, y, z] = placed.turn.rotation;
  const double rows[2][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                             {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)}};
  Footprint result;
  result.centre = {placed.x, placed.y};
  for (std::size_t i = 0; i < 3; ++i) {
    const double middle = (object.box_min[i] + object.box_max[i]) / 2;
    const double half = (object.box_max[i] - object.box_min[i]) / 2;
    result.centre.x += rows[0][i] * middle;
    result.centre.y += rows[1][i] * middle;
    result.axes[i] = {rows[0][i] * half, rows[1][i] * half};
  }
  return result;
}

bool is_inside(const Footprint& print, const std::array<double, 4>& area) {
  const double rx = print.reach_along({1, 0}), ry = print.reach_along({0, 1});
  return print.centre.x - rx >= area[0] && print.centre.x + rx <= area[2] &&
         print.centre.y - ry >= area[1] && print.centre.y + ry <= area[3];
}

double reach_of(const Object& object) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double most = std::max(std::abs(object.box_min[i]), std::abs(object.box_max[i]));
    sum += most * most;
  }
  return std::sqrt(sum) + 1e-6;
}

double overlap(const Footprint& a, const Footprint& b) {
  double least = 1e9;
  for (const Footprint* shape : {&a, &b}) {
    for (const Vec2& axis : shape->axes) {
      const double length = std::sqrt(axis.x * axis.x + axis.y * axis.y);
      if (length < 1e-9) continue;
      const Vec2 n = {-axis.y / length, axis.x / length};
      const double apart =
          std::abs((b.centre.x - a.centre.x) * n.x + (b.centre.y - a.centre.y) * n.y);
      least = std::min(least, a.reach_along(n) + b.reach_along(n) - apart);
    }
  }
  return least;
}

std::optional<double> growth(const Footprint& a, const Footprint& b, const Vec2& cells) {
  std::optional<double> least;
  for (const Footprint* shape : {&a, &b}) {
    for (const Vec2& axis : shape->axes) {
      const double length = std::sqrt(axis.x * axis.x + axis.y * axis.y);
      if (length < 1e-9) continue;
      Vec2 n = {-axis.y / length, axis.x / length};
      double step = cells.x * n.x + cells.y * n.y;
      if (step < 0) n = {-n.x, -n.y}, step = -step;
      if (step < 1e-6) continue;
      const double apart = (b.centre.x - a.centre.x) * n.x + (b.centre.y - a.centre.y) * n.y;
      const double missing = a.reach_along(n) + b.reach_along(n) - apart;
      least = std::min(least.value_or(1e9), 1 + missing / step);
    }
  }
  return least;
}

scene::Solid solid(const Object& object, const Mat3& turn, const Vec3& origin) {
  return moved(scene::upright_solid(Vec3(object.box_min.data()), Vec3(object.box_max.data())),
               {origin, Quat(turn)});
}

double lowest(const Object& object, const Mat3& turn) {
  // Along each of the world's axes every side of the box adds its own least: no corner is needed.
  const Vec3 rise = turn.row(2).transpose();
  const Vec3 low(object.box_min.data()), high(object.box_max.data());
  return rise.cwiseProduct(low).cwiseMin(rise.cwiseProduct(high)).sum();
}

double height(const Object& object, const Turn& turn) {
  const auto& [w, x, y, z] = turn.rotation;
  const double row[3] = {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += std::abs(row[i]) * (object.box_max[i] - object.box_min[i]);
  return sum;
}

}  // namespace probe::sema
