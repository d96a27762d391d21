// P1511: what moves by itself and runs into something, or over the edge. Its way is looked at every
// 2 mm, in each start, the others where they stand; others that move are looked at all along their
// way.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/check/starts.h"
#include "compiler/define/fixture.h"
#include "compiler/define/motion.h"
#include "compiler/define/support.h"
#include "compiler/geometry/camera_pose.h"
#include "compiler/geometry/footprint.h"
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
    const std::vector<double> all = joint_starts_of(starts.model, starts.task);
    std::span<const double> left = all;
    for (const FixtureId id : scene_.fixtures) {
      const Fixture& fixture = starts.model.fixtures[id];
      const auto joints = left.first(fixture.joints.size());
      left = left.subspan(fixture.joints.size());
      if (const auto& travel = travels.of(id)) {
        for (const PartBox& box : travel->at(joints))
          standing_.push_back({box, fixture.body_name(fixture.parts[box.part])});
      }
    }
  }

  void run() const {
    for (std::size_t m = 0; m < movers_.size(); ++m) {
      for (std::size_t e = 0; e < starts_.task.starts.size(); ++e) {
        if (!is_free(m, e)) break;
      }
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
    const double bottom = at.z ? *at.z + lowest(object, rotation(at)) : scene_.surface_z;
    return {bottom, bottom + height(object, at.turn)};
  }
  static Mat3 rotation(const Start::Placed& at) {
    return pose_of({}, at.turn.rotation).rotation.toRotationMatrix();
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

  // In one start; what was found is reported.
  bool is_free(std::size_t m, std::size_t episode) const {
    const Mover& mover = movers_[m];
    const Start::Placed begin = placed(episode, mover.object);
    for (const std::array<double, 2>& by : ways_[m]) {
      const Start::Placed at = moved(begin, by);
      if (over_edge(at))
        return report(mover, episode, "runs over the edge of `" + scene_.name + "`");
      for (const Standing& other : standing_) {
        const Object& object = starts_.object(at);
        const Mat3 turn = rotation(at);
        const double z = at.z.value_or(scene_.surface_z - lowest(object, turn));
        if (overlap(other.box.solid, solid(object, turn, {at.x, at.y, z})) > kRounding)
          return report(mover, episode, "runs into `" + other.name + "`");
      }
      for (const Start::Placed& other : starts_.task.starts[episode].placed) {
        if (other.object == mover.object || rides(other.object, mover.object)) continue;
        const auto moves = std::ranges::find(movers_, other.object, &Mover::object);
        const std::string name = "`" + starts_.object(other).name + "`";
        if (moves == movers_.end()) {
          if (meets(at, other)) return report(mover, episode, "runs into " + name);
          continue;
        }
        const auto& way = ways_[static_cast<std::size_t>(moves - movers_.begin())];
        const bool crosses = std::ranges::any_of(way, [&](const std::array<double, 2>& there) {
          return meets(at, moved(other, there));
        });
        if (crosses) return report(mover, episode, "crosses the way of " + name);
      }
    }
    return true;
  }

  bool over_edge(const Start::Placed& at) const {
    const Footprint shape = footprint(starts_.object(at), at);
    const double rx = shape.reach_along({1, 0}), ry = shape.reach_along({0, 1});
    return shape.centre.x - rx < scene_.area[0] || shape.centre.x + rx > scene_.area[2] ||
           shape.centre.y - ry < scene_.area[1] || shape.centre.y + ry > scene_.area[3];
  }

  bool report(const Mover& mover, std::size_t episode, const std::string& what) const {
    const Start::Placed begin = placed(episode, mover.object);
    starts_.reporter
        .report(Situation::kMoveMeets, mover.motion->span,
                "`" + starts_.model.objects[mover.object].name + "` " + what + " on its way in `" +
                    starts_.task.name + "`")
        .point(fmt::format("episode {}: {}", episode, at(starts_.object(begin), begin)))
        .label(starts_.layout.span, "the layout");
    return false;
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
