#include "runtime/libero/crowd.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <Eigen/Geometry>

#include "runtime/libero/goal.h"
#include "runtime/libero/scene_kinds.h"
#include "runtime/libero/start_rows.h"
#include "runtime/libero/words.h"

namespace probe::libero {
namespace {

constexpr std::size_t kMost = 2;
constexpr double kWidest = 0.06;   // m, radius of what is put beside
constexpr double kStep = 0.02;     // m, from one place that is tried to the next
constexpr double kBorder = 0.03;   // m, beyond where the task's own things stand
constexpr double kApart = 0.015;   // m
constexpr double kReach = 0.17;    // m, how far a drawer comes out
constexpr double kLetDown = 0.001; // m above the surface

// As it stands: how wide about its origin, which tables place, and how far below that its foot is.
struct Extent {
  double radius = 0, foot = 0;
};
Extent extent_of(const Thing& thing, const std::array<std::string, 4>& turn) {
  const Eigen::Quaterniond q(std::stod(turn[0]), std::stod(turn[1]), std::stod(turn[2]),
                             std::stod(turn[3]));
  Extent extent;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at((corner & 1) != 0 ? thing.high.x() : thing.low.x(),
                  (corner & 2) != 0 ? thing.high.y() : thing.low.y(),
                  (corner & 4) != 0 ? thing.high.z() : thing.low.z());
    const Vec3 turned = q.normalized() * at;
    extent.radius = std::max(extent.radius, std::hypot(turned.x(), turned.y()));
    extent.foot = std::min(extent.foot, turned.z());
  }
  return extent;
}
double radius_of(const Thing& thing) { return extent_of(thing, {"1", "0", "0", "0"}).radius; }

std::array<std::string, 4> turn_of(const std::vector<std::string>& cells) {
  return {cells[kTurnCell], cells[kTurnCell + 1], cells[kTurnCell + 2], cells[kTurnCell + 3]};
}

std::string last_word(std::string_view words) {
  return std::string(words.substr(words.rfind(' ') + 1));
}

struct Circle {
  double x = 0, y = 0, radius = 0;
};

class Crowd {
 public:
  Crowd(const BddlProblem& problem, const Things& things, const SceneKind& kind)
      : problem_(problem), things_(things), kind_(kind), roles_(roles_of(problem)) {}

  std::vector<Foreign> place(std::string_view table, const std::vector<Standing>& declared,
                             std::size_t turn) {
    std::vector<Foreign> put;
    if (!read(table)) return put;
    for (std::size_t i = 0; i < declared.size() && put.size() < kMost; ++i) {
      const Standing& what = declared[(turn + i) % declared.size()];
      const Thing* const thing = foreign(what.object);
      if (thing == nullptr) continue;
      const Extent extent = extent_of(*thing, what.turn);
      const auto at = extent.radius > kWidest ? std::nullopt : free_place(extent.radius);
      if (!at) continue;
      put.push_back({what, at->x, at->y, kind_.surface - extent.foot + kLetDown});
      taken_.push_back(*at);
      nouns_.insert(last_word(name_of(thing->category)));
    }
    return put;
  }

 private:
  const Thing* thing_of(std::string_view category) const {
    const auto at = things_.find(category);
    return at == things_.end() ? nullptr : &at->second;
  }

  // The object that a row of the table is about; none of joints.
  const BddlThing* object_of(const std::string& what) const {
    const std::string* name = &what;
    if (what == "source") name = &roles_.source;
    if (what == "target") name = &roles_.target;
    if (what == "helper") name = &roles_.helper;
    if (what == "helper_target") name = &roles_.helper_target;
    return problem_.find_object(*name);
  }

  // Where things stand. False: of one it is not known how wide it is, or nobody is the source.
  bool read(std::string_view table) {
    bool is_known = true;
    double sum_x = 0, sum_y = 0;
    std::size_t sources = 0;
    for_each_row(table, [&](std::string_view row) {
      const std::vector<std::string> cells = cells_of(row);
      const BddlThing* const object = object_of(cells[kWhatCell]);
      if (object == nullptr) return;
      const Thing* const thing = thing_of(object->category);
      is_known = is_known && thing != nullptr;
      if (thing == nullptr) return;
      const double x = std::stod(cells[kXCell]), y = std::stod(cells[kYCell]);
      taken_.push_back({x, y, extent_of(*thing, turn_of(cells)).radius});
      low_x_ = std::min(low_x_, x), high_x_ = std::max(high_x_, x);
      low_y_ = std::min(low_y_, y), high_y_ = std::max(high_y_, y);
      nouns_.insert(last_word(name_of(object->category)));
      if (cells[kWhatCell] != "source") return;
      sum_x += x, sum_y += y;
      ++sources;
    });
    for (const BddlThing& fixture : problem_.fixtures) {
      const Thing* const thing = thing_of(fixture.category);
      if (thing == nullptr) continue;  // the workspace
      const auto middle = middle_of(fixture);
      if (!middle) return false;
      const double reach = thing->joints.empty() ? 0 : kReach;
      taken_.push_back({middle->x, middle->y, radius_of(*thing) + reach});
    }
    if (sources == 0) return false;
    near_ = {sum_x / static_cast<double>(sources), sum_y / static_cast<double>(sources), 0};
    return is_known;
  }

  std::optional<Circle> middle_of(const BddlThing& fixture) const {
    for (const BddlFact& fact : problem_.init) {
      if (fact.predicate != "on" || fact.arguments[0] != fixture.name) continue;
      const BddlRegion* const region = problem_.find_region(fact.arguments[1]);
      if (region == nullptr || region->ranges.empty()) return std::nullopt;
      const auto& [x0, y0, x1, y1] = region->ranges.front();
      return Circle{(x0 + x1) / 2 + kind_.x, (y0 + y1) / 2 + kind_.y, 0};
    }
    return std::nullopt;
  }

  // Nothing of the task is called so.
  const Thing* foreign(const std::string& object) const {
    const std::string category = object.substr(0, object.rfind('_'));
    const Thing* const thing = thing_of(category);
    if (thing == nullptr || thing->is_fixture) return nullptr;
    const std::string_view name = name_of(category);
    return name.empty() || nouns_.contains(last_word(name)) ? nullptr : thing;
  }

  std::optional<Circle> free_place(double radius) const {
    std::optional<Circle> best;
    double least = 0;
    for (double x = low_x_ - kBorder; x <= high_x_ + kBorder; x += kStep) {
      for (double y = low_y_ - kBorder; y <= high_y_ + kBorder; y += kStep) {
        const bool is_free = std::ranges::all_of(taken_, [&](const Circle& other) {
          return std::hypot(x - other.x, y - other.y) > radius + other.radius + kApart;
        });
        const double away = std::hypot(x - near_.x, y - near_.y);
        if (!is_free || (best && away >= least)) continue;
        best = Circle{x, y, radius};
        least = away;
      }
    }
    return best;
  }

  const BddlProblem& problem_;
  const Things& things_;
  const SceneKind& kind_;
  const GoalRoles roles_;
  std::vector<Circle> taken_;
  std::set<std::string> nouns_;
  Circle near_;
  double low_x_ = 1e9, low_y_ = 1e9, high_x_ = -1e9, high_y_ = -1e9;
};

}  // namespace

std::optional<Standing> standing_in(std::string_view table, const std::string& object) {
  std::optional<Standing> found;
  for_each_row(table, [&](std::string_view row) {
    const std::vector<std::string> cells = cells_of(row);
    if (!found && cells[kWhatCell] == object) found = Standing{object, turn_of(cells)};
  });
  return found;
}

std::vector<Foreign> crowd(const BddlProblem& problem, const Things& things, std::string_view table,
                           const std::vector<Standing>& declared, std::size_t turn) {
  const SceneKind* const kind = scene_kind(problem);
  return kind == nullptr ? std::vector<Foreign>()
                         : Crowd(problem, things, *kind).place(table, declared, turn);
}

}  // namespace probe::libero
