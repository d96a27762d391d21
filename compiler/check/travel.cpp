// P1302: what stands in a fixture with joints, or in the way of its parts. A joint's whole way is
// looked at, so that it does not matter where an episode leaves it.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <numbers>

#include "compiler/check/starts.h"
#include "compiler/define/fixture.h"
#include "compiler/geometry/footprint.h"
#include "compiler/geometry/pose.h"
#include "compiler/geometry/travel.h"
#include "runtime/robot/kinematics.h"
#include "runtime/scene/link_solids.h"

namespace probe::sema {
namespace {

constexpr double kRounding = 1e-6;  // m: boxes may touch
constexpr double kRubs = 1e-3;      // m that a part may be lower than the surface, as a foot is

bool may_overlap(const PartBox& box, const Vec3& centre, const Vec3& half) {
  const Vec3 apart = (box.solid.centre - centre).cwiseAbs();
  return (apart.array() < (box.half + half).array()).all();
}

std::string stands(const Fixture::Joint& joint, double position) {
  return joint.slides ? centimetres(position)
                      : fmt::format("{:.4g}deg", position * 180 / std::numbers::pi);
}

// The upright box around each part as a task begins.
struct Around {
  Vec3 low, high;

  bool holds(const Vec3& point) const {
    return (low.array() <= point.array()).all() && (point.array() <= high.array()).all();
  }
};
std::map<std::uint32_t, Around> around_parts(const std::vector<PartBox>& boxes) {
  std::map<std::uint32_t, Around> parts;
  for (const PartBox& box : boxes) {
    const Vec3 low = box.solid.centre - box.half, high = box.solid.centre + box.half;
    const auto [known, is_new] = parts.try_emplace(box.part, Around{low, high});
    if (is_new) continue;
    known->second.low = known->second.low.cwiseMin(low);
    known->second.high = known->second.high.cwiseMax(high);
  }
  return parts;
}

// The deepest of what was found for one thing and one fixture.
struct Found {
  std::size_t starts = 0, episode = 0;
  double depth = 0;
  const PartBox* box = nullptr;
  const Start::Placed* placed = nullptr;
};

// " when `cabinet.top` stands at 4cm": all joints that carry the part of a box of everywhere().
std::string when(const Fixture& fixture, const Travel& travel, const PartBox& box) {
  std::string text;
  const auto joints = travel.joints_of(box);
  for (const std::size_t i : travel.carriers(box.part)) {
    const Fixture::Joint& joint = fixture.joints[i];
    text += fmt::format("{} `{}.{}` stands at {}", text.empty() ? " when" : " and", fixture.name,
                        joint.name, stands(joint, joints[i]));
  }
  return text;
}

// Where a thing is looked for.
enum class Look {
  kStart,    // as it stands
  kFalling,  // on its way down to there
  kWay,      // as it stands, while parts go their whole way
};

struct TravelCheck {
  const TaskStarts& starts;
  const Fixture& fixture;
  const Travel& travel;

  std::string part_name(const PartBox& box) const {
    return fixture.body_name(fixture.parts[box.part]);
  }

  scene::Solid body_of(const Start::Placed& placed, Look look) const {
    const scene::Solid body = solid_of(starts, placed);
    if (look != Look::kFalling || placed.z) return body;
    const Vec3 half = body.half_extent(), fall(0, 0, starts.layout.drop);
    return scene::upright_solid(body.centre - half, body.centre + half + fall);
  }

  // The deepest overlap of each start with any of the boxes. What is put into a part, at a height
  // of its own, goes where the part goes: `carriers`, of a look at the whole way.
  Found deepest(const std::vector<PartBox>& boxes, Look look,
                const std::map<std::uint32_t, Around>& carriers = {}) const {
    Found found;
    for (std::size_t e = 0; e < starts.task.starts.size(); ++e) {
      bool here = false;
      for (const Start::Placed& placed : starts.task.starts[e].placed) {
        const scene::Solid body = body_of(placed, look);
        const Vec3 half = body.half_extent();
        for (const PartBox& box : boxes) {
          if (!may_overlap(box, body.centre, half)) continue;
          const auto carrier = carriers.find(box.part);
          if (placed.z && carrier != carriers.end() && carrier->second.holds(body.centre)) continue;
          const double depth = overlap(box.solid, body);
          if (depth <= kRounding) continue;
          here = true;
          if (depth <= found.depth) continue;
          found.depth = depth;
          found.episode = e;
          found.box = &box;
          found.placed = &placed;
        }
      }
      found.starts += here ? 1 : 0;
    }
    return found;
  }

  Diagnostic& report(const Found& found, const std::string& what, bool is_least) const {
    return starts.reporter
        .report(
            Code::P1302, starts.place({found.placed->object}),
            fmt::format("`{}` {}; so in {}{} of {} starts", starts.object(*found.placed).name, what,
                        is_least ? "at least " : "", found.starts, starts.task.starts.size()))
        .point(fmt::format("episode {}: {}", found.episode,
                           at(starts.object(*found.placed), *found.placed)))
        .label(fixture.span, "the fixture");
  }

  void check(std::span<const double> joints) const {
    const std::vector<PartBox> begun = travel.at(joints);
    const std::string in_task = "` in `" + starts.task.name + "`";
    if (const Found found = deepest(begun, Look::kStart); found.box != nullptr) {
      report(found,
             "stands in `" + part_name(*found.box) + in_task + ": they overlap by " +
                 centimetres(found.depth),
             false);
      return;
    }
    if (const Found found = deepest(begun, Look::kFalling); found.box != nullptr) {
      Diagnostic& said = report(
          found, "falls onto `" + part_name(*found.box) + in_task + ", not to the surface", false);
      said.severity = Severity::kWarning;
      said.help(
          "give its height in a table of starts (`starts \"file.csv\"`), or `@allow(in_the_way, "
          "\"...\")`");
      return;
    }
    const Found found = deepest(travel.everywhere(), Look::kWay, around_parts(begun));
    if (found.box == nullptr) return;
    const bool is_chain = travel.carriers(found.box->part).size() > 1;
    Diagnostic& said = report(found,
                              "is in the way of `" + part_name(*found.box) + in_task +
                                  ": they overlap by " + (is_chain ? "at least " : "") +
                                  centimetres(found.depth) + when(fixture, travel, *found.box),
                              is_chain);
    said.severity = Severity::kWarning;
    said.help(
        "move the fixture or the cells; if it is to be pushed away, say so: "
        "`@allow(in_the_way, \"...\")`");
  }

  // The arm as an episode begins. Its links are known by boxes around their meshes, which are
  // larger than they are.
  void check_arm(std::span<const double> joints, const std::vector<ArmLink>& arm) const {
    constexpr double kRoomy = 1e-2;  // m
    const std::vector<PartBox> begun = travel.at(joints);
    const PartBox* deepest = nullptr;
    const ArmLink* link = nullptr;
    double depth = kRoomy;
    for (const ArmLink& one : arm) {
      for (const PartBox& box : begun) {
        if (!may_overlap(box, one.solid.centre, one.solid.half_extent())) continue;
        const double now = overlap(box.solid, one.solid);
        if (now <= depth) continue;
        depth = now;
        deepest = &box;
        link = &one;
      }
    }
    if (deepest == nullptr) return;
    Diagnostic& said = starts.reporter.report(
        Code::P1302, starts.task.span,
        fmt::format("the arm begins in `{}` in `{}`: the boxes around them and around link `{}` "
                    "overlap by {}",
                    part_name(*deepest), starts.task.name, link->name, centimetres(depth)));
    said.severity = Severity::kWarning;
    said.label(fixture.span, "the fixture").help("move the fixture, or write other `joints`");
  }
};

std::vector<ArmLink> arm_of(const Model& model, const Scene& scene, const std::string& asset_root) {
  std::vector<ArmLink> links;
  if (scene.robot == RobotId::kNone) return links;
  const Robot& robot = model.robots[scene.robot];
  if (!robot.model || scene.joints.size() != robot.drives.size()) return links;
  std::vector<std::string> names;
  std::vector<double> joints;
  for (std::size_t i = 0; i < robot.drives.size(); ++i) {
    names.push_back(robot.drives[i].joint.text);
    joints.push_back(scene.joints[i].si());
  }
  const auto tree = robot::Tree::create(*robot.model, names);
  if (!tree.ok()) return links;
  std::vector<Pose> poses(tree->link_count());
  tree->link_poses(joints, poses);
  const Pose base = pose_of(scene.base_position, scene.base_turn.rotation);
  const std::string folder =
      (std::filesystem::path(asset_root) / robot.urdf.text).parent_path().string();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (const scene::Solid& solid : scene::link_solids(robot.model->links[i], folder))
      links.push_back({robot.model->links[i].name, moved(solid, base * poses[i])});
  }
  return links;
}

}  // namespace

const std::optional<Travel>& Travels::of(FixtureId id) {
  const auto [known, is_new] = known_.try_emplace(id);
  if (is_new) known->second = Travel::of(model_.fixtures[id], asset_root_);
  return known->second;
}

const std::vector<ArmLink>& Travels::arm(SceneId id) {
  const auto [known, is_new] = arms_.try_emplace(id);
  if (is_new) known->second = arm_of(model_, model_.scenes[id], asset_root_);
  return known->second;
}

std::vector<BegunFixture> begun_fixtures(const TaskStarts& starts, Travels& travels) {
  const std::vector<double> all = joint_starts_of(starts.model, starts.task);
  std::span<const double> left = all;
  std::vector<BegunFixture> begun;
  for (const FixtureId id : starts.model.scenes[starts.task.scene].fixtures) {
    const Fixture& fixture = starts.model.fixtures[id];
    const auto joints = left.first(fixture.joints.size());
    left = left.subspan(fixture.joints.size());
    if (const auto& travel = travels.of(id))
      begun.push_back({fixture, *travel, {joints.begin(), joints.end()}});
  }
  return begun;
}

scene::Solid solid_of(const TaskStarts& starts, const Start::Placed& placed) {
  const Object& object = starts.object(placed);
  const Mat3 turn = axes_of(placed.turn);
  const double surface = starts.model.scenes[starts.task.scene].surface_z;
  return solid(object, turn,
               {placed.x, placed.y, placed.z.value_or(surface - lowest(object, turn))});
}

void check_travel(const TaskStarts& starts, Travels& travels) {
  for (const BegunFixture& begun : begun_fixtures(starts, travels)) {
    const TravelCheck check{starts, begun.fixture, begun.travel};
    check.check(begun.joints);
    check.check_arm(begun.joints, travels.arm(starts.task.scene));
  }
}

namespace {

// A part anywhere on its way, and the surface.
void check_surface_below(const Scene& scene, const Fixture& fixture, const Travel& travel,
                         Reporter& reporter) {
  const PartBox* lowest_box = nullptr;
  double depth = kRubs;
  for (const PartBox& box : travel.everywhere()) {
    if (travel.carriers(box.part).empty()) continue;  // what stands still meets no surface
    const double below = scene.surface_z - (box.solid.centre.z() - box.half.z());
    if (below <= depth) continue;
    depth = below;
    lowest_box = &box;
  }
  if (lowest_box == nullptr) return;
  reporter
      .report(Code::P1302, fixture.span,
              fmt::format("`{}` runs {} into the surface of `{}`{}",
                          fixture.body_name(fixture.parts[lowest_box->part]), centimetres(depth),
                          scene.name, when(fixture, travel, *lowest_box)))
      .label(scene.span, "the scene")
      .help("put the fixture higher");
}

// A part anywhere on its way, and another fixture as it begins. `is_first`: of the pair, so that
// two that stand in one another are told of once.
void check_neighbour(const Scene& scene, const Fixture& fixture, const Travel& travel,
                     const Fixture& other, const Travel& other_travel, bool is_first,
                     Reporter& reporter) {
  std::vector<double> begin, other_begin;
  for (const Fixture::Joint& joint : fixture.joints) begin.push_back(joint.start);
  for (const Fixture::Joint& joint : other.joints) other_begin.push_back(joint.start);
  const std::vector<PartBox> still = other_travel.at(other_begin), begun = travel.at(begin);
  const auto worst = [&](const std::vector<PartBox>& boxes, const PartBox** against) {
    const PartBox* found = nullptr;
    double depth = kRubs;
    for (const PartBox& box : boxes) {
      for (const PartBox& one : still) {
        if (!may_overlap(box, one.solid.centre, one.half)) continue;
        const double now = overlap(box.solid, one.solid);
        if (now <= depth) continue;
        depth = now;
        found = &box;
        *against = &one;
      }
    }
    return std::pair(found, depth);
  };
  const PartBox* against = nullptr;
  const bool at_start = worst(begun, &against).first != nullptr;
  const auto [found, depth] = worst(at_start ? begun : travel.everywhere(), &against);
  if (found == nullptr || (at_start && !is_first)) return;
  const std::string names =
      fmt::format("`{}` and `{}` in `{}`", fixture.body_name(fixture.parts[found->part]),
                  other.body_name(other.parts[against->part]), scene.name);
  Diagnostic& said = reporter.report(
      Code::P1302, fixture.span,
      at_start ? fmt::format("{} stand in one another by {}", names, centimetres(depth))
               : fmt::format("{} meet: they overlap by {}{}", names, centimetres(depth),
                             when(fixture, travel, *found)));
  if (!at_start) said.severity = Severity::kWarning;
  said.label(other.span, "the other fixture").help("move one of them");
}

}  // namespace

// Once for a scene: what its fixtures meet that does not depend on starts.
void check_fixture_places(const Model& model, Travels& travels, Reporter& reporter) {
  for (const Scene& scene : model.scenes) {
    if (scene.broken) continue;
    for (const FixtureId id : scene.fixtures) {
      const Fixture& fixture = model.fixtures[id];
      const auto& travel = travels.of(id);
      if (!travel) continue;
      const About about(reporter, fixture.span);
      check_surface_below(scene, fixture, *travel, reporter);
      bool is_first = false;  // behind itself in the list
      for (const FixtureId other : scene.fixtures) {
        const auto& other_travel = travels.of(other);
        if (other == id) {
          is_first = true;
        } else if (other_travel) {
          check_neighbour(scene, fixture, *travel, model.fixtures[other], *other_travel, is_first,
                          reporter);
        }
      }
    }
  }
}

}  // namespace probe::sema
