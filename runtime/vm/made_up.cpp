#include "runtime/vm/made_up.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "runtime/base/trig.h"
#include "runtime/plan/fixtures.h"
#include "runtime/plan/moves.h"
#include "runtime/plan/roles.h"
#include "runtime/vm/judge.h"

namespace probe::vm {
namespace {

constexpr int kSteps = 8;
constexpr double kMostGap = 2e-3;  // m: above what carries it, where a layout puts it
constexpr double kFloor = 5e-3;    // m: of a hollow thing
constexpr double kFar = 0.5;       // m: where objects stand that do not matter
constexpr double kLow = 0.05;      // m: over the surface, of parts that are low (kBack)
constexpr double kGap = 0.01;      // m: between what stands in the ring and its middle (kNear)
constexpr std::size_t kMostNear = 8;  // objects in the ring
constexpr double kAlike = 0.01;    // m, rad: joints that begin alike, as far as one asks

// Half extents with z the axis that is nearest the vertical in the pose, as a world gives them.
Vec3 half_extents(const plan::ObjectRecord& object, const std::array<double, 4>& rotation) {
  std::array<double, 3> half{};
  for (std::size_t i = 0; i < 3; ++i) half[i] = (object.box_max[i] - object.box_min[i]) / 2;
  const auto& [w, x, y, z] = rotation;
  const std::array<double, 3> upright = {std::abs(2 * (x * z - w * y)),
                                         std::abs(2 * (y * z + w * x)),
                                         std::abs(1 - 2 * (x * x + y * y))};
  const auto up =
      static_cast<std::size_t>(std::max_element(upright.begin(), upright.end()) - upright.begin());
  return {half[up == 0 ? 2 : 0], half[up == 1 ? 2 : 1], half[up]};
}

// Turned about the vertical alone.
bool is_upright(const std::array<double, 4>& rotation) {
  constexpr double kRounding = 1e-9;
  return std::abs(rotation[1]) < kRounding && std::abs(rotation[2]) < kRounding;
}

// From the model's origin, of an object that stands upright; of others 0.
Vec3 middle_of(const plan::ObjectRecord& object, const std::array<double, 4>& rotation) {
  if (!is_upright(rotation)) return Vec3::Zero();
  return (Vec3(object.box_min.data()) + Vec3(object.box_max.data())) / 2;
}

// An object as it is placed, before it comes to rest.
struct PlacedObject {
  std::uint16_t body = 0;
  Vec3 centre, half;  // of its box along the world's axes
  Quat rotation;
  double rest = 0;            // m: of the centre, when it lies
  Vec3 shift = Vec3::Zero();  // m: from where it is placed to where it is made up

  double bottom() const { return centre.z() - half.z(); }
  // Whether a layout puts `above` on this: it begins a millimetre over it.
  bool carries(const PlacedObject& above) const {
    const Vec3 apart = (above.centre - centre).cwiseAbs();
    const double gap = above.bottom() - (centre.z() + half.z());
    return apart.x() < half.x() && apart.y() < half.y() && gap > 0 && gap < kMostGap;
  }
};

PlacedObject placed_object(std::uint16_t body, const plan::ObjectRecord& object,
                           const plan::PlacementRecord& at) {
  const Vec3 low(object.box_min.data()), high(object.box_max.data());
  PlacedObject out;
  out.body = body;
  out.rotation = Quat(at.rotation[0], at.rotation[1], at.rotation[2], at.rotation[3]);
  const Mat3 turn = out.rotation.toRotationMatrix();
  out.centre = Vec3(at.position.data()) + turn * ((low + high) / 2);
  out.half = turn.cwiseAbs() * ((high - low) / 2);
  return out;
}

// Of its box's shadow: with middles as far apart as two of these, boxes do not meet.
double half_diagonal(const BodyStart& body) { return body.half.head<2>().norm(); }

// Where objects stand in a ring about `middle`, off it by kGap; the side along +y is left free.
std::vector<std::pair<std::size_t, Vec3>> ring_about(std::size_t middle,
                                                     std::span<const std::size_t> objects,
                                                     const MadeUpWorld& world) {
  std::vector<std::pair<std::size_t, Vec3>> ring;
  const std::size_t count = std::min(objects.size() - 1, kMostNear);
  for (const std::size_t object : objects) {
    if (object == middle || ring.size() == count) continue;
    const double turn = 2 * std::numbers::pi * static_cast<double>(ring.size() + 1) /
                        static_cast<double>(count + 1);
    const SinCos t = portable_sincos(turn);
    const double far =
        half_diagonal(world.starts[middle]) + half_diagonal(world.starts[object]) + kGap;
    ring.emplace_back(object, Vec3(-far * t.sin, far * t.cos, 0));
  }
  return ring;
}

// The first objects stand about the target, or about the source, or else about the first of them.
void stand_near(const plan::TaskRoles& roles, std::span<const std::size_t> objects, double table,
                MadeUpWorld* world) {
  const auto put = [&](std::size_t object, Vec3 at) {
    at.z() = table + world->starts[object].half.z();
    world->starts[object].position = at;
    world->put(object, at);
  };
  std::size_t middle = objects.front();
  if (roles.has_source() && roles.source < roles.objects) middle = roles.source;
  if (roles.has_target() && roles.target < roles.objects) middle = roles.target;
  put(middle, Vec3::Zero());
  for (const auto& [object, at] : ring_about(middle, objects, *world)) put(object, at);
}

}  // namespace

Vec3 MadeUpWorld::free_side() const {
  const double far = half_diagonal(starts[target]) + half_diagonal(starts[source]) + kGap;
  const Vec3& about = sample.bodies[target].position;
  return {about.x(), about.y() + far, sample.bodies[source].position.z()};
}

MadeUpWorld make_up_world(const plan::Plan& plan, std::uint32_t task, std::uint32_t start,
                          Spread spread) {
  const plan::TaskRecord& record = plan.tasks()[task];
  const double table = plan.scenes()[record.scene].surface_z;
  const plan::RobotRecord& robot = plan.robots()[plan.scenes()[record.scene].robot];
  const std::size_t fingers = plan::finger_count(robot);  // the first of the links
  const auto bodies = plan.bodies(record);
  const auto episodes = plan.episodes(record);
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), record);
  MadeUpWorld world;
  world.spread = spread;
  if (roles.has_source()) world.source = static_cast<std::uint16_t>(roles.source);
  if (roles.has_target()) world.target = static_cast<std::uint16_t>(roles.target);
  world.starts.resize(bodies.size());
  world.sample.bodies.resize(bodies.size());
  world.middles.assign(bodies.size(), Vec3::Zero());
  world.sample.tcp = {0, 0, table + kFar};
  world.sample.joints.resize(robot.drives.count);
  if (!episodes.empty()) {
    for (const double position :
         plan::joint_starts_of(plan.tables(), plan.scenes()[record.scene], episodes[start]))
      world.sample.joints.push_back({position, 0});
  }
  std::vector<std::size_t> objects;
  std::size_t parts = 0;  // so far
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto kind = static_cast<plan::BodyKind>(bodies[i].kind);
    Vec3 at = {0, 0, table + kFar};
    if (kind == plan::BodyKind::kSurface) {
      world.surface = static_cast<std::uint16_t>(i);
      at = {0, 0, table};
    } else if (kind == plan::BodyKind::kObject) {
      std::array<double, 4> rotation = {1, 0, 0, 0};
      if (!episodes.empty()) rotation = plan.placements(episodes[start])[i].rotation;
      const plan::ObjectRecord& object = plan.objects()[bodies[i].index];
      world.starts[i].half = half_extents(object, rotation);
      world.middles[i] = middle_of(object, rotation);
      at = world.mirrored({kFar * static_cast<double>(i), 0, table + world.starts[i].half.z()});
      objects.push_back(i);
    } else if (kind == plan::BodyKind::kLink) {
      world.starts[i].opening = {0, 1, 0};
      if (bodies[i].index < fingers) world.fingers.push_back(static_cast<std::uint16_t>(i));
    } else if (kind == plan::BodyKind::kFixture) {
      world.fixture = static_cast<std::uint16_t>(i);
    } else if (kind == plan::BodyKind::kPart) {
      // Apart, as regions of two parts may be one box in the parts' own frames.
      at = world.mirrored({0, -kFar * static_cast<double>(i), table + kFar});
      if (spread == Spread::kBack) at.z() = table + kLow;
      if (spread == Spread::kNear) at = {0, 0, table + kFar * static_cast<double>(++parts)};
    }
    world.starts[i].position = at;
    world.put(i, at);
  }
  if (spread == Spread::kNear && !objects.empty()) stand_near(roles, objects, table, &world);
  for (const auto legs : plan::moves_of(plan.tables(), record)) {
    const auto body = static_cast<std::uint16_t>(legs.front().body);
    world.sample.own.push_back({body, world.starts[body].position});
  }
  return world;
}

std::vector<double> begins_as(const plan::Plan& plan, std::uint32_t task, std::uint32_t start,
                              double joint_step) {
  const plan::TaskRecord& record = plan.tasks()[task];
  const plan::EpisodeRecord& episode = plan.episodes(record)[start];
  std::vector<double> all =
      plan::joint_starts_of(plan.tables(), plan.scenes()[record.scene], episode);
  if (joint_step > 0)
    for (double& joint : all) joint = std::round(joint / joint_step);
  const auto bodies = plan.bodies(record);
  const auto placements = plan.placements(episode);
  for (std::size_t i = 0; i < bodies.size() && i < placements.size(); ++i) {
    if (static_cast<plan::BodyKind>(bodies[i].kind) != plan::BodyKind::kObject) continue;
    const plan::ObjectRecord& object = plan.objects()[bodies[i].index];
    for (const Vec3& size :
         {half_extents(object, placements[i].rotation), middle_of(object, placements[i].rotation)})
      all.insert(all.end(), size.begin(), size.end());
  }
  return all;
}

std::vector<std::uint32_t> kinds_of_starts(const plan::Plan& plan, std::uint32_t task) {
  std::set<std::vector<double>> known;
  std::vector<std::uint32_t> firsts;
  const auto count = static_cast<std::uint32_t>(plan.episodes(plan.tasks()[task]).size());
  for (std::uint32_t start = 0; start < count; ++start) {
    if (known.insert(begins_as(plan, task, start, kAlike)).second) firsts.push_back(start);
  }
  if (firsts.empty()) firsts.push_back(0);
  return firsts;
}

std::optional<MadeUpWorld> make_up_start(const plan::Plan& plan, std::uint32_t task,
                                         std::uint32_t start, Lies lies,
                                         std::span<const BegunIn> in) {
  const plan::TaskRecord& record = plan.tasks()[task];
  const auto bodies = plan.bodies(record);
  const auto placements = plan.placements(plan.episodes(record)[start]);
  const double table = plan.scenes()[record.scene].surface_z;
  MadeUpWorld world = make_up_world(plan, task, start);
  std::vector<PlacedObject> placed;
  for (std::size_t i = 0; i < bodies.size() && i < placements.size(); ++i) {
    if (static_cast<plan::BodyKind>(bodies[i].kind) != plan::BodyKind::kObject) continue;
    placed.push_back(placed_object(static_cast<std::uint16_t>(i), plan.objects()[bodies[i].index],
                                   placements[i]));
    world.starts[i].half = half_extents(plan.objects()[bodies[i].index], placements[i].rotation);
  }
  // What carries comes before what it carries.
  std::ranges::sort(placed, {},
                    [](const PlacedObject& one) { return std::pair(one.bottom(), one.body); });
  bool carried = false;
  for (PlacedObject& one : placed) {
    const PlacedObject* carrier = nullptr;
    for (const PlacedObject& other : placed) {
      if (&other == &one) break;
      if (other.carries(one)) carrier = &other;
    }
    const auto begun = std::ranges::find(in, one.body, &BegunIn::object);
    std::uint16_t below = world.surface;
    Vec3 at = one.centre;
    if (carrier != nullptr) {
      below = carrier->body;
      one.shift = carrier->shift;
      at += one.shift;
      at.z() = one.half.z() + (lies == Lies::kOn ? carrier->rest + carrier->half.z()
                                                 : carrier->rest - carrier->half.z() + kFloor);
    } else if (begun != in.end()) {
      below = begun->owner;
      at = world.sample.bodies[below].origin + begun->at;
      one.shift = at - one.centre;
    } else {
      at.z() = table + one.half.z();
    }
    one.rest = at.z();
    carried = carried || below != world.surface;
    const plan::ObjectRecord& object = plan.objects()[bodies[one.body].index];
    world.sample.bodies[one.body].rotation = one.rotation;
    world.middles[one.body] =
        one.rotation * Vec3((Vec3(object.box_min.data()) + Vec3(object.box_max.data())) / 2);
    world.put(one.body, at);
    world.starts[one.body].position = at;
    // What is above presses down, whichever of the two has the lower number.
    const double down = one.body < below ? -kMadeUpContact : kMadeUpContact;
    world.sample.contacts.push_back(
        {std::min(one.body, below), std::max(one.body, below), {0, 0, down}});
  }
  if (!carried) return std::nullopt;
  for (OwnPlace& place : world.sample.own) place.position = world.starts[place.body].position;
  std::ranges::sort(world.sample.contacts, {},
                    [](const ContactSample& pair) { return std::pair(pair.a, pair.b); });
  return world;
}

Result<bool> judge_world(const plan::Plan& plan, std::uint32_t task, std::uint32_t metric,
                         MadeUpWorld world) {
  std::vector<MadeUpWorld> worlds;
  worlds.push_back(std::move(world));
  return judge_worlds(plan, task, metric, std::move(worlds));
}

Result<bool> judge_worlds(const plan::Plan& plan, std::uint32_t task, std::uint32_t metric,
                          std::vector<MadeUpWorld> worlds) {
  Judge judge(plan, task);
  PROBE_TRY(judge.begin(worlds.front().starts));
  int step = 0;
  for (MadeUpWorld& world : worlds) {
    for (int k = 0; k < kSteps; ++k) {
      world.sample.step = ++step;
      world.sample.time = step / 5.0;
      PROBE_TRY(judge.step(world.sample));
    }
  }
  return judge.truth(metric);
}

}  // namespace probe::vm
