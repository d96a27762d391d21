#include "runtime/expert/put_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "runtime/base/trig.h"
#include "runtime/expert/around_solid.h"
#include "runtime/expert/free_way.h"
#include "runtime/expert/path_planner.h"
#include "runtime/expert/servo.h"
#include "runtime/robot/rotation.h"

namespace probe::expert {
namespace {

constexpr double kPutUpright = 0.3;  // cosine of 72 degrees between closing line and way down
constexpr std::array kPutBeside = {0.014, 0.009, 0.006};  // m between an open finger and the source
constexpr double kPutRoom = 0.0025;        // m between the hand and what it does not hold
constexpr double kSourceRoom = 0.002;      // m between the source and all but what it stands on
constexpr double kPutLooks = 0.005;        // m: a board that is as thin is seen
constexpr double kPutRoomyEnough = 0.012;  // m; more earns nothing
constexpr double kPutBefore = 0.07;        // m from the hold, where the hand comes from
constexpr double kPutLift = 0.004;         // m that it is carried above what it is put on
constexpr double kPutRise = 0.05;          // m straight up from where it lay, where that is free
constexpr double kMouth = 0.03;    // m between the source and the place's side before it goes in
constexpr double kLevelWay = 0.4;  // of the way down: less level is no way in from the side
constexpr std::array kOut = {0.06, 0.10, 0.14};  // m along the surface, from under something
constexpr int kOutWays = 8;
constexpr double kFromUnder = 0.25;  // m straight up that are free where it is out from under it
constexpr std::size_t kPutMostHolds = 60;
// Ways in; the latter where the former lead nowhere.
constexpr std::array<std::size_t, 2> kMostWays = {4, 40};
constexpr int kPutTurns = 8;  // of the source, where it comes from above
constexpr double kWidthCost = 10,
                 kLeverCost = 3;  // of a m between the fingers; of a m off the middle
// Of hands whose fingers turn, whose arms do not come to all from straight above.
constexpr double kPutLeantUpright = 0.52;          // 59 degrees between closing line and way down
constexpr std::array kPutLeans = {0.2, 0.4, 0.6};  // tangents of how far they point away
constexpr std::array kPutDeeper = {0.048, 0.042, 0.037, 0.032, 0.026,
                                   0.020, 0.014, 0.008, 0.0};  // m: farther down than others
constexpr double kPutPress = 0.004;  // m that fingers come into what they close on
constexpr double kDeepCost = 30;     // of a m that they do not come down
constexpr double kAslantCost =
    3;  // of the sine of their line's slope: of what they press it slides
constexpr std::array kLiftNearer = {0.0, 0.05, 0.10};  // m towards the base on the way up
constexpr double kPutNearBase = 0.6, kPutStretchCost = 8;

// A hold of the source, as it lies.
struct Held {
  Pose tool;  // base frame
  double open = 1;
  double cost = 0;
  double before = kPutBefore;  // m, from where the hand comes to it
};

// Where it goes, and from where it comes there.
struct WayIn {
  Pose source, mouth;  // of the source: where it is let go, and before it goes in
  double cost = 0;
};

class PutSearch {
 public:
  explicit PutSearch(const PutProblem& problem)
      : p_(problem), all_(surroundings_of(*problem.view)), rest_(all_) {
    const auto at = rest_.bodies.begin() +
                    static_cast<std::ptrdiff_t>(p_.view->fixtures.size() + std::size_t(p_.object));
    source_ = *at;
    rest_.bodies.erase(at);
  }

  std::optional<PutPlan> run() {
    const std::vector<Held> holds = find_holds();
    // Where none of the best ways in goes, others may: those are often the same place turned.
    for (const std::size_t most_ways : kMostWays) {
      for (std::size_t i = 0; i < std::min(holds.size(), kPutMostHolds); ++i) {
        if (auto plan = with(holds[i], most_ways)) return plan;
      }
      if (p_.lifts) break;
    }
    return std::nullopt;
  }

 private:
  const robot::HandShape& hand() const { return p_.scene->hand; }
  Pose in_source(const Pose& tool) const { return p_.scene->source_pose.inverse() * tool; }

  std::vector<Held> find_holds() const {
    std::vector<Held> out;
    const std::vector<Vec3> ways = ways_to(source_.pose);
    const bool turns = !hand().turning.empty();
    for (std::size_t s = 0; s < source_.solids.size(); ++s) {
      for (const FingersAround& way : fingers_around(source_.solids[s], source_.pose, ways, hand(),
                                                     turns ? kPutLeantUpright : kPutUpright))
        turns ? add_turned(s, way, out) : add(s, way, out);
      if (turns) add_leant(s, out);
    }
    const auto was_tried = [&](const Held& held) {
      return std::ranges::any_of(p_.failed, [&](const Pose& old) {
        return is_near(p_.scene->source_pose * old, held.tool, 0.01, 0.3);
      });
    };
    std::stable_sort(out.begin(), out.end(),
                     [](const Held& a, const Held& b) { return a.cost < b.cost; });
    std::stable_partition(out.begin(), out.end(),
                          [&](const Held& held) { return !was_tried(held); });
    return out;
  }

  void add(std::size_t solid, const FingersAround& way, std::vector<Held>& out) const {
    Held held;
    held.tool = {way.at, tool_frame(way.down, way.closing)};
    for (const double beside : kPutBeside) {
      const double parted = way.half + beside;
      if (parted > hand().opening_half) continue;
      held.open = hand().openness_for(parted);
      const HandBalls balls = hand_balls(hand(), parted);
      double room = rest_.clearance(held.tool, balls.all(), kPutRoomyEnough);
      if (room < kPutRoom) continue;
      room = std::min(room, room_beside(solid, held.tool, balls));
      if (room < kPutRoom) continue;
      const double tilt = std::acos(std::clamp(-way.down.z(), -1.0, 1.0));
      const double turn =
          robot::to_rotation_vector(held.tool.rotation * p_.scene->tcp.rotation.conjugate()).norm();
      const Vec3 off = way.at - Vec3(p_.scene->source.center.x(), p_.scene->source.center.y(),
                                     0.5 * (p_.scene->source.bottom + p_.scene->source.top));
      const double lever = (off - off.dot(way.closing) * way.closing).norm();
      held.cost = 0.7 * tilt + 0.1 * turn + kWidthCost * way.half + kLeverCost * lever +
                  0.1 * std::abs(way.share) + 80 * (kPutRoomyEnough - room) +
                  kPutStretchCost * std::max(0.0, way.at.head<2>().norm() - kPutNearBase);
      out.push_back(held);
      return;
    }
  }

  // Away from the base, in fingers whose line is level.
  void add_leant(std::size_t solid, std::vector<Held>& out) const {
    const Vec2 off = p_.scene->source.center.normalized();
    Mat3 axes;
    axes << off.x(), -off.y(), 0, off.y(), off.x(), 0, 0, 0, 1;
    const Pose turned{source_.pose.position, Quat(axes)};
    const Pose into = turned.inverse() * source_.pose;
    std::vector<Vec3> vertices;
    for (const Vec3& v : p_.view->objects[std::size_t(p_.object)].parts[solid])
      vertices.push_back(into.apply(v));
    std::vector<Vec3> ways;
    for (const double lean : kPutLeans)
      ways.push_back(Vec3(lean * off.x(), lean * off.y(), -1).normalized());
    for (const FingersAround& way :
         fingers_around(Solid::around(vertices), turned, ways, hand(), kPutLeantUpright))
      add_turned(solid, way, out);
  }

  // Fingers that turn are aslant: as far down as they come, and where they close without pressing
  // anything but their ends into the source.
  void add_turned(std::size_t solid, const FingersAround& way, std::vector<Held>& out) const {
    const HandBalls closed = hand_balls(hand(), way.half);
    for (const double deeper : kPutDeeper) {
      FingersAround down = way;
      down.at += deeper * way.down;
      const Pose tool{down.at, tool_frame(way.down, way.closing)};
      if (rest_.clearance(tool, closed.all(), kPutRoom) < kPutRoom) continue;
      const Pose into = source_.pose.inverse() * tool;
      const bool fits = std::ranges::all_of(closed.fingers, [&](const Ball& ball) {
        return source_.solids[solid].distance(into.apply(ball.center)) > ball.radius - kPutPress;
      });
      if (!fits) continue;
      const std::size_t before = out.size();
      add(solid, down, out);
      if (out.size() == before) continue;
      out.back().cost +=
          kDeepCost * (kPutDeeper.front() - deeper) + kAslantCost * std::abs(way.closing.z());
      out.back().before += deeper;
      return;
    }
  }

  // Between the hand and the source, of which the fingers may touch the solid that they hold.
  double room_beside(std::size_t solid, const Pose& tool, const HandBalls& balls) const {
    double least = kPutRoomyEnough;
    const Pose into = source_.pose.inverse() * tool;
    for (std::size_t s = 0; s < source_.solids.size(); ++s) {
      const auto near = [&](std::span<const Ball> some) {
        for (const Ball& ball : some)
          least =
              std::min(least, source_.solids[s].distance(into.apply(ball.center)) - ball.radius);
      };
      near(balls.rest);
      if (s != solid) near(balls.fingers);
    }
    return least;
  }

  // Ways in with this hold, best first: the hand points the way that the source goes.
  std::vector<WayIn> ways_in(const Held& held, std::span<const Ball> carried) const {
    std::vector<WayIn> out;
    const Vec3 down = held.tool.rotation * Vec3::UnitX();
    const Vec2 flat = down.head<2>();
    const Pose own = in_source(held.tool);
    for (const PutPlace& place : p_.places) {
      const auto add = [&](double turn, const Vec3& way, double deep) {
        WayIn in;
        in.source = turned_to(place.at, turn);
        in.mouth = in.source;
        in.mouth.position -= deep * way;
        in.cost = place.cost + 0.1 * std::abs(turn);
        const Pose tool = in.source * own;
        const double stretched = tool.position.head<2>().norm() - kPutNearBase;
        in.cost += kPutStretchCost * std::max(0.0, stretched);
        for (const Pose& end : {tool, in.mouth * own}) {
          if (rest_.clearance(end, carried, kPutRoom) < kSourceRoom) return;
        }
        if (!FreeLine{&rest_, carried, kSourceRoom, kPutLooks}.is_free(in.mouth * own, tool))
          return;
        out.push_back(in);
      };
      if (flat.norm() > kLevelWay) {
        for (const Vec2& way : place.ways) {
          const double cross = flat.x() * way.y() - flat.y() * way.x();
          const double turn = portable_atan2(cross, flat.dot(way));
          add(turn, {way.x(), way.y(), 0},
              place.depth_along(way) + kMouth + front_along(turn, way));
        }
      }
      const double rise = std::max(kPutRise, place.top - place.at.z() + kMouth);
      for (int i = 0; i < kPutTurns; ++i) {
        const double turn =
            std::numbers::pi / (kPutTurns / 2) * (i <= kPutTurns / 2 ? i : i - kPutTurns);
        add(turn, -Vec3::UnitZ(), rise);
      }
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const WayIn& a, const WayIn& b) { return a.cost < b.cost; });
    return out;
  }

  // The source, turned about the vertical, over a place.
  Pose turned_to(const Vec3& at, double turn) const {
    const Quat by = robot::from_rotation_vector({0, 0, turn});
    const Vec3 middle(p_.scene->source.center.x(), p_.scene->source.center.y(),
                      p_.scene->source.bottom);
    const Vec3 to = at + Vec3(0, 0, kPutLift);
    return {to + by * (p_.scene->source_pose.position - middle),
            (by * p_.scene->source_pose.rotation).normalized()};
  }
  // How far it reaches before its middle, turned so.
  double front_along(double turn, const Vec2& way) const {
    const SinCos t = portable_sincos(-turn);
    const Vec2 own(t.cos * way.x() - t.sin * way.y(), t.sin * way.x() + t.cos * way.y());
    double most = 0;
    for (const Vec2& p : p_.scene->source.whole)
      most = std::max(most, own.dot(p - p_.scene->source.center));
    return most;
  }

  // From where it lies: up, or out along what it lies on and then up. Each a first part of the way.
  std::vector<std::vector<Pose>> ways_out(const Held& held, std::span<const Ball> carried) const {
    std::vector<std::vector<Pose>> out;
    // A line may end as near as its end is: here that must have room, too.
    const auto is_free = [&](const Pose& from, const Pose& to) {
      return rest_.clearance(to, carried, kPutRoom) >= kSourceRoom &&
             FreeLine{&rest_, carried, kSourceRoom, kPutLooks}.is_free(from, to);
    };
    Pose up = held.tool;
    up.position.z() += kPutRise;
    if (is_free(held.tool, up)) out.push_back({up});
    for (const double nearer : kLiftNearer) {
      if (nearer == 0 || hand().turning.empty()) continue;
      Pose back = up;
      const double far = up.position.head<2>().norm();
      back.position.head<2>() *= std::max(0.0, 1 - nearer / std::max(far, 1e-9));
      if (is_free(held.tool, back)) out.push_back({back});
    }
    if (!is_covered(*p_.scene)) return out;
    const std::size_t straight = out.size();
    Pose off = held.tool;
    off.position.z() += kPutLift;
    for (const double far : kOut) {
      for (int i = 0; i < kOutWays; ++i) {
        const SinCos t = portable_sincos(2 * std::numbers::pi * i / kOutWays);
        Pose aside = off;
        aside.position += far * Vec3(t.cos, t.sin, 0);
        Pose high = aside;
        high.position.z() += kFromUnder;
        if (is_free(off, aside) && is_free(aside, high)) out.push_back({aside});
      }
      if (out.size() > straight) break;
    }
    return out;
  }

  std::optional<PutPlan> with(const Held& held, std::size_t most_ways) const {
    const robot::HandShape& shape = hand();
    std::vector<Ball> carried = hand_balls(shape, shape.gap_at(held.open)).all();
    const std::vector<Ball> hand_only = carried;
    const std::vector<Ball> source = held_balls(*p_.scene, held.tool);
    carried.insert(carried.end(), source.begin(), source.end());
    Pose before = held.tool;
    before.position -= held.before * (held.tool.rotation * Vec3::UnitX());
    if (!FreeLine{&rest_, hand_only}.is_free(before, held.tool)) return std::nullopt;
    const double widest = shape.widest_on_way(p_.scene->openness, held.open);
    const auto to = free_way(all_, p_.scene->tcp, before, hand_balls(shape, widest).all());
    if (!to) return std::nullopt;
    PutPlan plan;
    plan.to_hold = *to;
    plan.sets_first = is_set_first(all_, p_.scene->tcp, *to, shape, p_.scene->openness, held.open);
    plan.to_hold.push_back(held.tool);
    plan.open = held.open;
    plan.hold = in_source(held.tool);
    const auto there = p_.reach->follow(p_.scene->joints, plan.to_hold);
    if (!there) return std::nullopt;
    const auto outs = ways_out(held, carried);
    if (outs.empty()) return std::nullopt;
    if (p_.lifts) return lifted(plan, outs, there->back());
    const std::vector<WayIn> ins = ways_in(held, carried);
    for (std::size_t i = 0; i < std::min(ins.size(), most_ways); ++i) {
      const Pose mouth = ins[i].mouth * plan.hold, end = ins[i].source * plan.hold;
      for (const std::vector<Pose>& out : outs) {
        const auto between = free_way(rest_, out.back(), mouth, carried);
        if (!between) continue;
        plan.carry = out;
        plan.carry.insert(plan.carry.end(), between->begin(), between->end());
        plan.carry.push_back(end);
        Pose back = end;
        back.position -= kPutBefore * (end.rotation * Vec3::UnitX());
        if (!FreeLine{&rest_, hand_only}.is_free(end, back)) {
          back = end;
          back.position += mouth.position - end.position;
        }
        plan.leave = {back};
        std::vector<Pose> whole = plan.carry;
        whole.push_back(back);
        const JointVector& q = there->back();
        if (!p_.reach->follow(std::span(q.data(), std::size_t(q.size())), whole)) continue;
        plan.put = ins[i].source;
        return plan;
      }
    }
    return std::nullopt;
  }

  std::optional<PutPlan> lifted(PutPlan plan, const std::vector<std::vector<Pose>>& outs,
                                const JointVector& q) const {
    for (const std::vector<Pose>& out : outs) {
      if (!p_.reach->follow(std::span(q.data(), std::size_t(q.size())), out)) continue;
      plan.carry = out;
      plan.put = p_.scene->source_pose;
      return plan;
    }
    return std::nullopt;
  }

  const PutProblem& p_;
  Surroundings all_, rest_;  // with the source and without it
  Surroundings::Body source_;
};

}  // namespace

std::optional<PutPlan> plan_put(const PutProblem& problem) { return PutSearch(problem).run(); }

bool is_covered(const Scene& scene) {
  return std::ranges::any_of(scene.fixtures, [&](const Footprint& part) {
    return part.bottom > scene.source.top - kPutRoom &&
           separation(part.whole, scene.source.whole) < 0;
  });
}

}  // namespace probe::expert
