#include "compiler/define/support.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/define/fixture.h"
#include "compiler/define/role.h"
#include "compiler/geometry/footprint.h"
#include "compiler/geometry/part_place.h"
#include "compiler/geometry/pose.h"
#include "runtime/plan/regions.h"

namespace probe::sema {
namespace {

constexpr double kGap = 1e-3;       // m, above what carries it: it comes to rest from there
constexpr double kRounding = 1e-6;  // m
constexpr double kUpright = 1e-9;   // of the cosine between an axis and the vertical

Vec3 half_of(const Object& object) {
  return (Vec3(object.box_max.data()) - Vec3(object.box_min.data())) / 2;
}
Vec3 centre_of(const Object& object) {
  return (Vec3(object.box_max.data()) + Vec3(object.box_min.data())) / 2;
}

// The two columns that lie flattest, the one of the longer side first.
std::array<int, 2> flat_axes(const Mat3& turn, const Vec3& half) {
  int up = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(turn(2, axis)) > std::abs(turn(2, up))) up = axis;
  }
  const int a = up == 0 ? 1 : 0, b = up == 2 ? 1 : 2;
  return half[a] >= half[b] ? std::array<int, 2>{a, b} : std::array<int, 2>{b, a};
}

Mat3 matrix_of(const plan::TurnedBox& box) {
  const auto rows = plan::axes_of(box);
  Mat3 axes;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      axes(row, column) = rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
  }
  return axes;
}

// How far a box goes straight up from its middle, along the way to the face of axis `up` or to one
// that is met before.
double above_middle(const Mat3& turn, const Vec3& half, int up) {
  if (std::abs(turn(2, up)) > 1 - kUpright) return half[up];
  double above = half.norm();
  for (int axis = 0; axis < 3; ++axis) {
    const double rise = std::abs(turn(2, axis));
    if (rise > 0) above = std::min(above, half[axis] / rise);
  }
  return above;
}

std::string sides(double a, double b) {
  return fmt::format("{:.3g}cm x {:.3g}cm", 200 * a, 200 * b);
}

}  // namespace

// Where something can stand: a middle, two directions with how far it goes along each, and how high
// its floor is.
struct Supports::Area {
  Vec3 middle;
  std::array<Vec3, 2> along;
  std::array<double, 2> half{};
  double low = 0, high = 0;  // m, world: of a region its own bounds
  bool is_region = false;
  std::vector<PartBox> boxes;  // that may be its floor
};

std::optional<ObjectId> where_of(const Model& model, const Task& task, const Place& place) {
  if (const auto role = find_role(model, place.where.text)) {
    const std::vector<ObjectId> filled = task.objects_in(*role);
    return filled.size() == 1 ? std::optional(filled.front()) : std::nullopt;
  }
  for (std::size_t i = 0; i < model.objects.size(); ++i) {
    const ObjectId id = model.objects.id(i);
    if (model.objects[id].name != place.where.text) continue;
    const std::vector<ObjectId> here = task.objects();
    const bool is_here = model.objects[id].of || std::ranges::find(here, id) != here.end();
    return is_here ? std::optional(id) : std::nullopt;
  }
  return std::nullopt;
}

std::vector<Put> puts_of(const Model& model, const Task& task) {
  std::vector<Put> puts;
  if (std::ranges::none_of(model.layouts[task.layout].places, &Place::is_put)) return puts;
  std::vector<ObjectId> placed;
  const auto is_own = [&](ObjectId id) {
    return std::ranges::any_of(model.layouts[task.layout].places, [&](const Place& place) {
      return std::ranges::any_of(place.what, [&](const Spelled& word) {
        return word.text == model.objects[id].name && !find_role(model, word.text);
      });
    });
  };
  for (const Place& place : model.layouts[task.layout].places) {
    for (const Spelled& word : place.what) {
      const auto role = find_role(model, word.text);
      for (const ObjectId id : task.objects()) {
        const bool by_name = !role && model.objects[id].name == word.text;
        const bool is_distractor =
            !role && word.text == "distractors" &&
            std::ranges::find(task.distractors, id) != task.distractors.end();
        if (!by_name && !is_distractor && !(role && task.role_of(id) == *role)) continue;
        if (std::ranges::find(placed, id) != placed.end() || (!by_name && is_own(id))) continue;
        placed.push_back(id);
        if (place.is_put()) puts.push_back({id, &place});
      }
    }
  }
  return puts;
}

const std::optional<Travel>& Supports::travel(const Scene& scene, FixtureId id) {
  const auto [known, is_new] = travels_.try_emplace({id, scene.fixtures_lift});
  if (is_new) known->second = Travel::of(scene, model_.fixtures[id], asset_root_);
  return known->second;
}

std::optional<Supports::Area> Supports::on_object(const Task& task, Start::Placed& base) const {
  const Object& object = model_.objects[base.object];
  const Mat3 turn = axes_of(base.turn);
  const double lowest_corner = lowest(object, turn);
  if (!base.z) base.z = model_.scenes[task.scene].surface_z - lowest_corner + kGap;
  const Vec3 half = half_of(object);
  Area area;
  area.middle = Vec3(base.x, base.y, *base.z) + turn * centre_of(object);
  const auto axes = flat_axes(turn, half);
  for (std::size_t i = 0; i < 2; ++i) {
    area.along[i] = turn.col(axes[i]);
    area.half[i] = half[axes[i]];
  }
  area.low = area.high = *base.z + lowest_corner + height(object, base.turn);
  return area;
}

std::optional<Supports::Area> Supports::in_region(const Task& task, const OfFixture& of) {
  const Fixture& fixture = model_.fixtures[of.fixture];
  const Scene& scene = model_.scenes[task.scene];
  const auto& way = travel(scene, of.fixture);
  const auto tree = tree_of(fixture);
  if (!tree || !way) return std::nullopt;
  const std::vector<double> all = joint_starts_of(model_, task);
  const auto joints = joints_of(model_, scene, of.fixture, all);
  const Pose pose = part_pose(place_of(scene, fixture), fixture, *tree, joints, of.part);
  const Region& region = fixture.regions[*of.region].region;
  const plan::TurnedBox box = plan::box_of(region.low, region.high, region.turned);
  const Vec3 half = to_vec(box.half);
  const Mat3 turn = pose.rotation.toRotationMatrix() * matrix_of(box);
  Area area;
  area.middle = pose.apply(to_vec(box.middle));
  const auto axes = flat_axes(turn, half);
  for (std::size_t i = 0; i < 2; ++i) {
    area.along[i] = turn.col(axes[i]);
    area.half[i] = half[axes[i]];
  }
  const int up = 3 - axes[0] - axes[1];
  const double above = above_middle(turn, half, up);
  area.low = area.middle.z() - above;
  area.high = area.middle.z() + above;
  area.is_region = true;
  area.boxes = way->at(joints);
  return area;
}

// A region may begin below the floor that is in it: the object stands on what it would meet.
double Supports::height_in(const Area& area, const Object& object,
                           const Start::Placed& member) const {
  const Mat3 turn = axes_of(member.turn);
  const double below = lowest(object, turn);
  double floor = area.low;
  while (true) {
    const scene::Solid body = solid(object, turn, {member.x, member.y, floor + kGap - below});
    double higher = floor;
    for (const PartBox& box : area.boxes) {
      const double top = box.solid.centre.z() + box.half.z();
      if (top <= area.high && top > higher && overlap(box.solid, body) > kRounding) higher = top;
    }
    if (higher <= floor) return floor + kGap - below;
    floor = higher;
  }
}

std::optional<LayoutProblem> Supports::stack(const Layout& layout, const Task& task,
                                             const std::vector<Put>& puts, Start& start) {
  const auto placed = [&](ObjectId id) {
    return std::ranges::find(start.placed, id, &Start::Placed::object);
  };
  const auto problem = [&](const Place& place, std::string message) {
    return LayoutProblem{Situation::kPutNowhere, std::move(message), place.where.span, "put here"};
  };
  std::vector<const Place*> lines;
  for (const Put& put : puts) {
    if (std::ranges::find(lines, put.place) == lines.end()) lines.push_back(put.place);
  }
  while (!lines.empty()) {
    // The first of which the carrier has its own place.
    const auto next = std::ranges::find_if(lines, [&](const Place* line) {
      const auto where = where_of(model_, task, *line);
      return std::ranges::none_of(puts, [&](const Put& put) {
        return put.object == where && std::ranges::find(lines, put.place) != lines.end();
      });
    });
    const Place& line = next == lines.end() ? *lines.front() : **next;
    const std::string name = "layout `" + layout.name + "` puts `" + line.what.front().text +
                             (line.how == Place::kIn ? "` in `" : "` on `") + line.where.text + "`";
    if (next == lines.end()) return problem(line, name + ", and that on or in it,");
    lines.erase(next);
    const auto where = where_of(model_, task, line);
    if (!where) return problem(line, name + ", which is not there");
    const Object& carrier = model_.objects[*where];
    const auto& scene_fixtures = model_.scenes[task.scene].fixtures;
    if (carrier.of &&
        std::ranges::find(scene_fixtures, carrier.of->fixture) == scene_fixtures.end())
      return problem(line, name + ", which is not in the scene");
    if (carrier.of && carrier.of->is_part())
      return problem(line, name + ", a part: only a region says where in it,");
    auto area = carrier.of ? in_region(task, *carrier.of) : on_object(task, *placed(*where));
    if (!area) return std::nullopt;  // what its files lack has been reported
    std::vector<ObjectId> members;
    for (const Put& put : puts) {
      if (put.place == &line) members.push_back(put.object);
    }
    const double share = 1.0 / static_cast<double>(members.size());
    for (std::size_t i = 0; i < members.size(); ++i) {
      const Object& object = model_.objects[members[i]];
      Start::Placed& member = *placed(members[i]);
      const double at = (2 * static_cast<double>(i) + 1) * share - 1;
      const Vec3 slot = area->middle + area->along[0] * (area->half[0] * at);
      const Mat3 turn = axes_of(member.turn);
      const Vec3 offset = turn * centre_of(object);
      member.x = slot.x() - offset.x();
      member.y = slot.y() - offset.y();
      const Vec3 half = half_of(object);
      const auto extent = [&](const Vec3& axis) {
        return (turn.transpose() * axis).cwiseAbs().dot(half);
      };
      const double a = extent(area->along[0]), b = extent(area->along[1]);
      if (area->is_region &&
          (a > area->half[0] * share + kRounding || b > area->half[1] + kRounding))
        return LayoutProblem{Situation::kPutTooLarge,
                             "`" + object.name + "` does not fit into `" + carrier.name +
                                 "`: it is " + sides(a, b) + ", there is " +
                                 sides(area->half[0] * share, area->half[1]) + ",",
                             line.where.span, "put here"};
      member.z = height_in(*area, object, member);
      const double surface = model_.scenes[task.scene].surface_z;
      const double below = surface - (*member.z + lowest(object, turn));
      if (area->is_region && below > kRounding)
        return LayoutProblem{
            Situation::kPutNowhere,
            fmt::format("`{}` would lie in `{}` {:.3g}cm below the surface, which nothing passes,",
                        object.name, carrier.name, 100 * below),
            line.where.span, "put here"};
    }
  }
  return std::nullopt;
}

}  // namespace probe::sema
