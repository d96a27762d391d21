#include "runtime/expert/put_spot.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "runtime/base/trig.h"
#include "runtime/expert/path_planner.h"
#include "runtime/expert/solid_top.h"

namespace probe::expert {
namespace {

constexpr int kGrid = 9;             // spots along each side of a region
constexpr double kRoomiest = 0.025;  // m between outlines; more earns nothing
constexpr double kTightest = 0.002;  // m; rather none than less
constexpr double kWallsNear = 0.06;  // m: walls that it may stand along
constexpr double kLevel = 0.006;     // m: what is as high as the support
constexpr double kHandRoom = 0.01;   // m of clearance of the hand
constexpr double kHandAbove = 0.02;  // m of the tool centre point over the support
constexpr std::array kTurned = {0.0, 0.25, 0.5, 0.75};  // half turns of the source that are tried
constexpr double kFootOut = 0.6;                        // of its outline: where its feet are
constexpr double kOver = 0.08;                          // m, where the hand comes from
constexpr double kHeld = 0.03;                          // m that hang below the tool, about
constexpr double kNearby = 0.6, kStretchCost = 8;       // m from the base; what a m more costs
constexpr int kRing = 16;                               // directions around what it is put beside
constexpr std::array kApart = {0.015, 0.03, 0.05};      // m between outlines' circles
constexpr std::size_t kMostSpots = 20;                  // put to inverse kinematics
constexpr std::size_t kGiven = 8;                       // of those that are reached
constexpr double kHalfOut = 0.7;  // of half a region: where what comes first leaves room
constexpr std::array kFiner = {0.008, 0.004, 0.002, 0.001};  // m: steps to more room
constexpr std::size_t kFined = 6;                            // spots that are moved so
constexpr double kMostSlope = 0.08;   // m over a region, along its own normal: still on it
constexpr double kSlopeStep = 0.01;   // m
constexpr double kInRegion = 0.8;     // of half of it
constexpr double kSlopeCost = 10;     // of a m farther in
constexpr double kMark = 0.01;        // m, half of the square that stands for the spot
constexpr double kFloorBelow = 0.05;  // m: a region's floor may be as far below it
constexpr double kLevelAxis = 0.9;    // of an axis: it is level
constexpr double kProud = 0.03;       // m that what carries may stand out of the region it is on

// A place on a slope.
struct Slope {
  Vec3 at;
  double cost = 0;
};

// A place that is looked at.
struct Wanted {
  Vec3 at;          // z: the lowest that counts as the region
  double top = 0;   // the highest
  double away = 0;  // m from the middle
};

bool contains(const Outline& outline, const Vec2& p) {
  if (outline.size() < 3) return false;
  const Prism prism = make_prism(outline, -1, 1);
  return distance_to(prism, {p.x(), p.y(), 0}).value <= 0;
}

class Spots {
 public:
  Spots(const Scene& scene, const policy::Privileged& view, const policy::Skill& skill,
        bool leaves_room)
      : scene_(scene),
        view_(view),
        skill_(skill),
        leaves_room_(leaves_room),
        to_base_(view.base.inverse()) {
    if (skill.to_object >= 0 && skill.place != policy::Skill::Place::kBeside)
      carrier_ =
          footprint_of(view.objects[static_cast<std::size_t>(skill.to_object)].parts, owner());
  }

  std::vector<Wanted> wanted() const {
    if (skill_.place == policy::Skill::Place::kBeside) return ring();
    if (skill_.region) return grid(*skill_.region, owner(), is_on() ? kProud : 0);
    if (skill_.to_fixture >= 0) return grid(top_of_fixture(), owner(), 0);
    return around_source();
  }

  Pose owner() const {
    if (skill_.to_fixture >= 0)
      return to_base_ * view_.fixtures[static_cast<std::size_t>(skill_.to_fixture)].pose;
    if (skill_.to_object >= 0)
      return to_base_ * view_.objects[static_cast<std::size_t>(skill_.to_object)].pose;
    return to_base_;
  }

  // What a thing at `at` would stand on, at most `top` high. What goes on or in an object does not
  // stand on the others that lie there.
  double support(const Vec2& at, double top) const {
    double height = scene_.surface;
    const auto raise = [&](const Footprint& carrier) {
      for (std::size_t i = 0; i < carrier.parts.size(); ++i) {
        if (carrier.part_tops[i] > top || carrier.part_tops[i] < height) continue;
        if (contains(carrier.parts[i], at)) height = carrier.part_tops[i];
      }
    };
    if (carrier_) {
      raise(*carrier_);
    } else {
      for (const Footprint* other : others_of(scene_, true)) raise(*other);
    }
    return height;
  }

  // The least gap to what stands higher than the support, of the source turned so; what hangs over
  // it counts.
  double room(const Vec2& at, double height, const Eigen::Matrix2d& turn) const {
    Outline moved = scene_.source.whole;
    for (Vec2& p : moved) p = at + turn * (p - scene_.source.center);
    double least = kRoomiest;
    for (const Footprint* other : others_of(scene_, true)) {
      for (std::size_t i = 0; i < other->parts.size(); ++i) {
        if (other->part_tops[i] < height + kLevel || other->parts[i].size() < 3) continue;
        least = std::min(least, separation(moved, other->parts[i]));
      }
    }
    return least;
  }

  // On parts of a fixture that lie aslant: where the source, upright as it is, first touches them,
  // over the region along the region's own normal.
  std::vector<Slope> slopes() const {
    std::vector<Slope> out;
    if (skill_.to_fixture < 0 || !skill_.region || !is_on()) return out;
    const policy::Skill::Box& box = *skill_.region;
    const Pose pose = owner() * box.turned;
    const Vec3 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
    if ((pose.rotation * Vec3::UnitZ()).z() < 0) return out;
    std::vector<std::vector<Vec3>> solids =
        view_.fixtures[static_cast<std::size_t>(skill_.to_fixture)].parts;
    for (std::vector<Vec3>& solid : solids) {
      for (Vec3& v : solid) v = owner().apply(v);
    }
    for (int i = 0; i < kGrid; ++i) {
      const double u = kInRegion * (2.0 * i / (kGrid - 1) - 1);
      for (double up = 0; up < kMostSlope; up += kSlopeStep) {
        const Vec2 at = pose.apply(middle + Vec3(u * half.x(), 0, half.z() + up)).head<2>();
        const std::optional<double> height = first_touch(solids, at);
        if (!height) continue;
        const Vec3 there = pose.inverse().apply(Vec3(at.x(), at.y(), *height)) - middle;
        if (std::abs(there.x()) > kInRegion * half.x() || there.z() < half.z() + kSlopeStep ||
            std::abs(there.y()) > kInRegion * half.y() || there.z() > kMostSlope)
          continue;
        out.push_back({{at.x(), at.y(), *height}, 4 * std::abs(u) * half.x() + kSlopeCost * up});
      }
    }
    return out;
  }

  double share_supported(const Vec2& at, double height, double top,
                         const Eigen::Matrix2d& turn) const {
    int held = 0;
    for (const Vec2& p : scene_.source.whole) {
      // Half way out: what stands needs no more.
      const Vec2 point = at + kFootOut * (turn * (p - scene_.source.center));
      held += support(point, top) > height - kLevel;
    }
    const auto all = static_cast<double>(scene_.source.whole.size());
    return all > 0 ? held / all : 1;
  }

 private:
  // The height at which the source, let down over `at`, meets the first of the solids.
  std::optional<double> first_touch(const std::vector<std::vector<Vec3>>& solids,
                                    const Vec2& at) const {
    std::optional<double> highest;
    for (const Vec2& p : scene_.source.whole) {
      for (const double share : {0.0, 0.5, 1.0}) {
        const Vec2 under = at + share * (p - scene_.source.center);
        for (const std::vector<Vec3>& solid : solids) {
          const std::optional<double> top = top_over(solid, under);
          if (top) highest = std::max(highest.value_or(*top), *top);
        }
      }
    }
    return highest;
  }

  bool is_on() const { return skill_.place == policy::Skill::Place::kOn; }

  std::vector<Wanted> grid(const policy::Skill::Box& box, const Pose& owner, double proud) const {
    std::vector<Wanted> out;
    const Pose pose = owner * box.turned;
    // Spots lie in the plane of the two axes that are flattest; z is up where none is more so.
    const Mat3 axes = pose.rotation.toRotationMatrix();
    int up = 2;
    for (int axis = 0; axis < 2; ++axis) {
      if (std::abs(axes(2, axis)) > std::abs(axes(2, up))) up = axis;
    }
    const int first = up == 0 ? 1 : 0, second = up == 2 ? 1 : 2;
    const Vec3 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 at = pose.apply({corner & 1 ? box.low.x() : box.high.x(),
                                  corner & 2 ? box.low.y() : box.high.y(),
                                  corner & 4 ? box.low.z() : box.high.z()});
      low = std::min(low, at.z());
      high = std::max(high, at.z());
    }
    for (int i = 0; i < kGrid; ++i) {
      for (int j = 0; j < kGrid; ++j) {
        const double u = 0.9 * (2.0 * i / (kGrid - 1) - 1), v = 0.9 * (2.0 * j / (kGrid - 1) - 1);
        Vec3 aside = Vec3::Zero();
        aside[first] = u * half[first];
        aside[second] = v * half[second];
        const Vec3 at = pose.apply(middle + aside);
        const double off = aside.norm();
        const double best = leaves_room_ ? kHalfOut * std::min(half[first], half[second]) : 0;
        out.push_back({{at.x(), at.y(), low}, high + proud, std::abs(off - best)});
      }
    }
    return out;
  }

  // The face of its highest solid, with the air above.
  policy::Skill::Box top_of_fixture() const {
    const auto& fixture = view_.fixtures[static_cast<std::size_t>(skill_.to_fixture)];
    policy::Skill::Box best{Vec3::Zero(), Vec3::Zero(), {}};
    double highest = -std::numeric_limits<double>::infinity();
    for (const std::vector<Vec3>& part : fixture.parts) {
      Vec3 low = part.front(), high = low;
      for (const Vec3& v : part) low = low.cwiseMin(v), high = high.cwiseMax(v);
      const double top =
          (to_base_ * fixture.pose).apply(0.5 * (low + high)).z() + 0.5 * (high - low).z();
      const double area = (high - low).head<2>().prod();
      // A rim is no place to stand.
      if (area < 1e-3 || top < highest + 1e-9) continue;
      highest = top;
      best = {{low.x(), low.y(), high.z() - 0.002}, {high.x(), high.y(), high.z() + 0.005}, {}};
    }
    return best;
  }

  std::vector<Wanted> ring() const {
    std::vector<Wanted> out;
    const Footprint beside =
        skill_.to_object >= 0
            ? footprint_of(view_.objects[static_cast<std::size_t>(skill_.to_object)].parts, owner())
            : footprint_of(view_.fixtures[static_cast<std::size_t>(skill_.to_fixture)].parts,
                           owner());
    for (const double apart : kApart) {
      const double radius = beside.radius + scene_.source.radius + apart;
      for (int i = 0; i < kRing; ++i) {
        const SinCos t = portable_sincos(2 * std::numbers::pi * i / kRing);
        const Vec2 at = beside.center + radius * Vec2(t.cos, t.sin);
        out.push_back({{at.x(), at.y(), scene_.surface},
                       scene_.surface + kLevel,
                       apart + 0.1 * (at - scene_.source.center).norm()});
      }
    }
    return out;
  }

  // Free surface, a hand's breadth from where it is.
  std::vector<Wanted> around_source() const {
    std::vector<Wanted> out;
    for (const double radius : {0.10, 0.14, 0.18}) {
      for (int i = 0; i < kRing; ++i) {
        const SinCos t = portable_sincos(2 * std::numbers::pi * i / kRing);
        const Vec2 at = scene_.source.center + radius * Vec2(t.cos, t.sin);
        out.push_back({{at.x(), at.y(), scene_.surface}, scene_.surface + kLevel, radius});
      }
    }
    return out;
  }

  const Scene& scene_;
  const policy::Privileged& view_;
  const policy::Skill& skill_;
  bool leaves_room_;
  Pose to_base_;
  std::optional<Footprint> carrier_;  // the object that it is put on or in
};

// A spot that is no spot of the grid: where there is just room enough.
struct Tight {
  Vec3 at;
  double room = 0, away = 0;
};

// The spots of `all` that lack least room, moved to where there is more, step by finer step.
using Roomiest =
    std::function<void(const Vec2& at, double height, double* room, double* share, double top)>;

std::vector<Tight> tightest(const Spots& spots, const std::vector<Wanted>& all,
                            const Roomiest& roomiest) {
  constexpr double kNone = -1;
  const auto room_at = [&](const Wanted& wanted, const Vec2& at, double* height) {
    *height = spots.support(at, wanted.top);
    double room = kNone;
    if (*height >= wanted.at.z() - kFloorBelow) roomiest(at, *height, &room, nullptr, wanted.top);
    return room;
  };
  struct From {
    const Wanted* wanted;
    double room;
  };
  std::vector<From> from;
  for (const Wanted& wanted : all) {
    double height = 0;
    const double room = room_at(wanted, wanted.at.head<2>(), &height);
    if (room > kNone) from.push_back({&wanted, room});
  }
  std::stable_sort(from.begin(), from.end(),
                   [](const From& a, const From& b) { return a.room > b.room; });
  from.resize(std::min(from.size(), kFined));
  std::vector<Tight> out;
  for (const From& one : from) {
    Vec2 at = one.wanted->at.head<2>();
    double height = 0, room = room_at(*one.wanted, at, &height);
    for (const double step : kFiner) {
      for (bool moved = true; moved;) {
        moved = false;
        for (const Vec2& way : {Vec2(step, 0), Vec2(-step, 0), Vec2(0, step), Vec2(0, -step)}) {
          double there = 0;
          const double here = room_at(*one.wanted, at + way, &there);
          if (here < room + 1e-6 || std::abs(there - height) > kLevel) continue;
          at += way, room = here, height = there, moved = true;
        }
      }
    }
    if (room >= kTightest) out.push_back({{at.x(), at.y(), height}, room, one.wanted->away});
  }
  return out;
}

}  // namespace

bool goes_to_spot(const policy::Skill& skill) {
  return skill.to_object < 0 || skill.region || skill.place == policy::Skill::Place::kBeside;
}

std::vector<PutSpot> find_put_spots(const Scene& scene, const policy::Privileged& view,
                                    const policy::Skill& skill, const Reach& reach,
                                    bool leaves_room) {
  struct Found {
    Vec3 at;
    double cost;
  };
  const Spots spots(scene, view, skill, leaves_room);
  const std::vector<Ball> balls = gripper_balls(scene.hand, scene.hand.opening_half);
  const Obstacles obstacles = obstacles_of(scene, true);
  const double yaw_now = yaw_of(scene.tcp.rotation);
  std::vector<Found> found;
  // The turn of the source with most room there.
  const auto roomiest = [&](const Vec2& at, double height, double* room, double* share,
                            double top) {
    std::vector<double> turns;
    for (const double turned : kTurned) turns.push_back(turned * std::numbers::pi);
    const std::vector<double> square =
        turns_square_to(scene.source.whole, others_of(scene, true), at, kWallsNear);
    for (const double turn : square) turns.push_back(turn);
    for (const double turned : turns) {
      const SinCos t = portable_sincos(turned);
      Eigen::Matrix2d turn;
      turn << t.cos, -t.sin, t.sin, t.cos;
      const double here = spots.room(at, height, turn);
      if (here < *room + 1e-9) continue;
      *room = here;
      if (share != nullptr) *share = spots.share_supported(at, height, top, turn);
    }
  };
  const auto add = [&](const Vec3& at, double room, double more) {
    double hand = -1;
    for (const double turn : {0.0, 0.5}) {
      const Pose there = top_down({at.x(), at.y(), at.z() + scene.hand.tip_below + kHandAbove},
                                  yaw_now + turn * std::numbers::pi);
      hand = std::max(hand, least_clearance(there, balls, obstacles, kHandRoom));
    }
    const double stretched = std::max(0.0, at.head<2>().norm() - kNearby);
    found.push_back(
        {at, 30 * (kRoomiest - room) + 60 * (kHandRoom - hand) + more + kStretchCost * stretched});
  };
  const std::vector<Wanted> all = spots.wanted();
  for (const Wanted& wanted : all) {
    const Vec2 at = wanted.at.head<2>();
    const double height = spots.support(at, wanted.top);
    // Under the region there may be its floor, or none of it.
    if (height < wanted.at.z() - kFloorBelow) continue;
    double room = 0, share = 0;
    roomiest(at, height, &room, &share, wanted.top);
    if (room < kTightest) continue;
    add({at.x(), at.y(), height}, room, 4 * wanted.away + 3 * (1 - share));
  }
  // Between spots that are looked at there may be one with just room enough.
  if (found.empty()) {
    for (const Tight& tight : tightest(spots, all, roomiest))
      add(tight.at, tight.room, 4 * tight.away);
  }
  if (found.empty()) {
    for (const Slope& slope : spots.slopes()) add(slope.at, kTightest, slope.cost);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& a, const Found& b) { return a.cost < b.cost; });
  found.resize(std::min(found.size(), kMostSpots));
  std::vector<PutSpot> out;
  for (const Found& one : found) {
    if (out.size() >= kGiven) break;
    for (const double turn : {0.0, 0.5, 1.0, 1.5}) {
      const double low = one.at.z() + scene.hand.tip_below + kHandAbove;
      const double yaw = yaw_now + turn * std::numbers::pi;
      // What is carried comes over everything.
      const double over = travel_height(scene, scene.hand.tip_below, scene.tcp.position, one.at);
      const double high = std::max(low + kOver, over + kHeld);
      const Pose above = top_down({one.at.x(), one.at.y(), high}, yaw);
      const Pose there = top_down({one.at.x(), one.at.y(), low}, yaw);
      if (!reach.follow(scene.joints, std::array{above, there})) continue;
      PutSpot spot{skill.to_object, skill.to_fixture, {}, one.cost};
      if (skill.place == policy::Skill::Place::kBeside) spot.object = spot.fixture = -1;
      const Pose own = spot.object < 0 && spot.fixture < 0 ? Pose{} : spots.owner();
      spot.at = own.inverse().apply(one.at);
      out.push_back(spot);
      break;
    }
  }
  return out;
}

double PutPlace::depth_along(const Vec2& way) const {
  double most = 0;
  for (const Vec2& p : outline) most = std::max(most, way.dot(at.head<2>() - p));
  return most;
}

std::vector<PutPlace> find_put_places(const Scene& scene, const policy::Privileged& view,
                                      const policy::Skill& skill) {
  std::vector<PutPlace> out;
  const Spots spots(scene, view, skill, false);
  if (skill.place == policy::Skill::Place::kBeside) {
    for (const Wanted& wanted : spots.wanted()) {
      const Vec2 at = wanted.at.head<2>();
      PutPlace place;
      place.top = spots.support(at, wanted.top);
      place.at = {at.x(), at.y(), place.top};
      const double room = spots.room(at, place.top, Eigen::Matrix2d::Identity());
      if (room < kTightest) continue;
      place.cost = 4 * wanted.away + 30 * (kRoomiest - room);
      out.push_back(place);
    }
    return out;
  }
  if (!skill.region) return out;
  const policy::Skill::Box& box = *skill.region;
  const Pose pose = spots.owner() * box.turned;
  PutPlace place;
  std::vector<Vec2> corners;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at = pose.apply({corner & 1 ? box.low.x() : box.high.x(),
                                corner & 2 ? box.low.y() : box.high.y(),
                                corner & 4 ? box.low.z() : box.high.z()});
    corners.push_back(at.head<2>());
    place.top = std::max(place.top, at.z());
  }
  place.outline = convex_outline(std::move(corners));
  for (int axis = 0; axis < 3; ++axis) {
    const Vec2 way = (pose.rotation * Vec3::Unit(axis)).head<2>();
    if (way.norm() < kLevelAxis) continue;
    place.ways.push_back(way.normalized());
    place.ways.push_back(-way.normalized());
  }
  for (const Wanted& wanted : spots.wanted()) {
    const Vec2 at = wanted.at.head<2>();
    const double height = spots.support(at, wanted.top);
    if (height < wanted.at.z() - kFloorBelow) continue;
    place.at = {at.x(), at.y(), height};
    place.cost = 4 * wanted.away + 3 * (1 - spots.share_supported(at, height, wanted.top,
                                                                  Eigen::Matrix2d::Identity()));
    out.push_back(place);
  }
  return out;
}

Vec3 spot_now(const PutSpot& spot, const policy::Privileged& view) {
  if (spot.object < 0 && spot.fixture < 0) return spot.at;
  const Pose to_base = view.base.inverse();
  const Pose& pose = spot.fixture >= 0 ? view.fixtures[static_cast<std::size_t>(spot.fixture)].pose
                                       : view.objects[static_cast<std::size_t>(spot.object)].pose;
  return (to_base * pose).apply(spot.at);
}

Scene with_target_at(Scene scene, const Vec3& spot) {
  Footprint mark;
  const Vec2 at = spot.head<2>();
  mark.whole = {at + Vec2(-kMark, -kMark), at + Vec2(kMark, -kMark), at + Vec2(kMark, kMark),
                at + Vec2(-kMark, kMark)};
  mark.parts = {mark.whole};
  mark.part_tops = {spot.z()};
  mark.center = at;
  mark.radius = kMark * std::numbers::sqrt2;
  mark.bottom = mark.top = spot.z();
  if (!scene.target.whole.empty()) scene.others.push_back(std::move(scene.target));
  scene.target = std::move(mark);
  return scene;
}

}  // namespace probe::expert
