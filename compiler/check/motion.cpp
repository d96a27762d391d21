// P1511: what moves by itself and runs into something, or over the edge. Its way is looked at every
// 2 mm, in each start, the others where they stand; others that move are looked at all along their
// way.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "compiler/check/check.h"
#include "compiler/check/starts.h"
#include "compiler/define/motion.h"
#include "compiler/define/support.h"
#include "compiler/geometry/footprint.h"
#include "compiler/geometry/pose.h"
#include "runtime/plan/moves.h"

namespace probe::sema {
namespace {

constexpr double kStep = 2e-3;      // m
constexpr double kRounding = 1e-6;  // m: boxes may touch

// Places along a way, from where it begins on.
std::vector<std::array<double, 2>> places_on(const Motion& motion) {
  const std::vector<plan::MoveRecord> legs = legs_of(motion, 0);
  const auto corners = plan::corners_of(legs);
  std::vector<std::array<double, 2>> places = {corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const double x = corners[i][0] - corners[i - 1][0], y = corners[i][1] - corners[i - 1][1];
    const int steps = std::max(1, static_cast<int>(std::ceil(std::hypot(x, y) / kStep)));
    for (int k = 1; k <= steps; ++k)
      places.push_back({corners[i - 1][0] + x * k / steps, corners[i - 1][1] + y * k / steps});
  }
  return places;
}

struct Heights {
  double low, high;
};

class MotionCheck {
 public:
  MotionCheck(const TaskStarts& starts, Travels& travels)
      : starts_(starts),
        scene_(starts.model.scenes[starts.task.scene]),
        movers_(movers_of(starts.model, starts.task)),
        puts_(puts_of(starts.model, starts.task)) {
    if (movers_.empty()) return;
    for (const Mover& mover : movers_) ways_.push_back(places_on(*mover.motion));
    for (const BegunFixture& begun : begun_fixtures(starts, travels)) {
      // In some start it stands there.
      for (const std::vector<double>& joints : begun.joints) {
        for (const PartBox& box : begun.travel.at(joints))
          standing_.push_back({box, begun.fixture.body_name(begun.fixture.parts[box.part])});
      }
    }
  }

  void run() const {
    std::vector<std::pair<ObjectId, ObjectId>> crossed;  // each crossing is of two
    for (std::size_t m = 0; m < movers_.size(); ++m) {
      std::optional<Meeting> first;
      CountedStarts counted{0, starts_.task.starts.size()};
      for (std::size_t e = 0; e < starts_.task.starts.size(); ++e) {
        const std::optional<Meeting> met = meeting(m, e);
        if (!met) continue;
        counted.add(e);
        if (!first) first = met;
      }
      if (!first) continue;
      if (first->crosses) {
        const std::pair back{movers_[m].object, *first->crosses};
        if (std::ranges::find(crossed, back) != crossed.end()) continue;
        crossed.emplace_back(*first->crosses, movers_[m].object);
      }
      report(movers_[m], counted, *first);
    }
  }

 private:
  struct Standing {
    PartBox box;
    std::string name;
  };

  const Start::Placed& placed(std::size_t episode, ObjectId object) const {
    return *std::ranges::find(starts_.task.starts[episode].placed, object, &Start::Placed::object);
  }

  static Start::Placed moved(Start::Placed from, const std::array<double, 2>& by) {
    from.x += by[0];
    from.y += by[1];
    return from;
  }

  Heights heights(const Start::Placed& at) const {
    const Object& object = starts_.object(at);
    const Mat3 turn = axes_of(at.turn);
    const double bottom = at.z ? *at.z + lowest(object, turn) : scene_.surface_z;
    return {bottom, bottom + height(object, at.turn)};
  }

  bool meets(const Start::Placed& a, const Start::Placed& b) const {
    const Heights here = heights(a), there = heights(b);
    if (here.high <= there.low || there.high <= here.low) return false;
    return overlap(footprint(starts_.object(a), a), footprint(starts_.object(b), b)) > kRounding;
  }

  bool rides(ObjectId object, ObjectId on) const {
    return std::ranges::any_of(puts_, [&](const Put& put) {
      return put.object == object && where_of(starts_.model, starts_.task, *put.place) == on;
    });
  }

  // What comes first in one start.
  struct Meeting {
    std::string what;
    std::optional<ObjectId> crosses = std::nullopt;  // another that moves
  };
  std::optional<Meeting> meeting(std::size_t m, std::size_t episode) const {
    const Mover& mover = movers_[m];
    const Start::Placed begin = placed(episode, mover.object);
    for (const std::array<double, 2>& by : ways_[m]) {
      const Start::Placed at = moved(begin, by);
      if (is_over_edge(starts_, at)) return Meeting{"runs over the edge of `" + scene_.name + "`"};
      for (const Standing& other : standing_) {
        if (overlap(other.box.solid, solid_of(starts_, at)) > kRounding)
          return Meeting{"runs into `" + other.name + "`"};
      }
      for (const Start::Placed& other : starts_.task.starts[episode].placed) {
        if (other.object == mover.object || rides(other.object, mover.object)) continue;
        const auto moves = std::ranges::find(movers_, other.object, &Mover::object);
        const std::string name = "`" + starts_.object(other).name + "`";
        if (moves == movers_.end()) {
          if (meets(at, other)) return Meeting{"runs into " + name};
          continue;
        }
        const auto& way = ways_[static_cast<std::size_t>(moves - movers_.begin())];
        const bool crosses = std::ranges::any_of(way, [&](const std::array<double, 2>& there) {
          return meets(at, moved(other, there));
        });
        if (crosses) return Meeting{"crosses the way of " + name, other.object};
      }
    }
    return std::nullopt;
  }

  void report(const Mover& mover, const CountedStarts& counted, const Meeting& met) const {
    const Start::Placed begin = placed(counted.first, mover.object);
    const Object& object = starts_.model.objects[mover.object];
    report_of(starts_.reporter, Situation::kMoveMeets, starts_.task, mover.motion->span,
              "`" + object.name + "` " + met.what + " on its way " + counted.text() + " `" +
                  starts_.task.name + "`")
        .point(counted.first_words(at(object, begin)))
        .label(starts_.layout.span, "the layout")
        .cause = cause_of(mover.motion->span, {object.name, met.what});
  }

  const TaskStarts& starts_;
  const Scene& scene_;
  std::vector<Mover> movers_;
  std::vector<Put> puts_;
  std::vector<std::vector<std::array<double, 2>>> ways_;  // by mover
  std::vector<Standing> standing_;                        // parts of fixtures as they begin
};

}  // namespace

void check_motion(const TaskStarts& starts, Travels& travels) {
  MotionCheck(starts, travels).run();
}

}  // namespace probe::sema
