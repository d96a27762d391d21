// P1302 of a task: what begins in a fixture with joints, or in the way of its parts. A joint's
// whole way is looked at, so that it does not matter where an episode leaves it.
#include <fmt/format.h>

#include <map>

#include "compiler/check/joint_text.h"
#include "compiler/check/starts.h"
#include "compiler/geometry/footprint.h"

namespace probe::sema {
namespace {

constexpr double kRounding = 1e-6;  // m: boxes may touch

// The upright box around each part as a task begins.
struct Around {
  Vec3 low, high;

  bool holds(const Vec3& point) const {
    return (low.array() <= point.array()).all() && (point.array() <= high.array()).all();
  }
};
std::map<std::uint32_t, Around> around_parts(const PartBoxes& boxes) {
  std::map<std::uint32_t, Around> parts;
  for (const PartBox& box : boxes.all()) {
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

  // One of all starts, or one for each.
  template <typename T>
  static const T& in_start(const std::vector<T>& all, std::size_t e) {
    return all.size() == 1 ? all.front() : all[e];
  }

  // The deepest overlap of each start with any of the boxes as they stand there. What is put into a
  // part, at a height of its own, goes where the part goes: `carriers`, of a look at the whole way.
  Found deepest(const std::vector<PartBoxes>& begun, Look look) const {
    std::vector<std::map<std::uint32_t, Around>> carried_by;
    if (look == Look::kWay) {
      for (const PartBoxes& boxes : begun) carried_by.push_back(around_parts(boxes));
    } else {
      carried_by.resize(1);
    }
    Found found;
    for (std::size_t e = 0; e < starts.task.starts.size(); ++e) {
      bool here = false;
      const PartBoxes& boxes = look == Look::kWay ? travel.everywhere() : in_start(begun, e);
      const std::map<std::uint32_t, Around>& carriers = in_start(carried_by, e);
      for (const Start::Placed& placed : starts.task.starts[e].placed) {
        const scene::Solid body = body_of(placed, look);
        boxes.each_near(body.centre, body.half_extent(), [&](const PartBox& box) {
          const auto carrier = carriers.find(box.part);
          if (placed.z && carrier != carriers.end() && carrier->second.holds(body.centre)) return;
          const double depth = overlap(box.solid, body);
          if (depth <= kRounding) return;
          here = true;
          if (depth <= found.depth) return;
          found.depth = depth;
          found.episode = e;
          found.box = &box;
          found.placed = &placed;
        });
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

  void check(const std::vector<std::vector<double>>& joints) const {
    std::vector<PartBoxes> begun;
    for (const std::vector<double>& here : joints) begun.emplace_back(travel.at(here));
    const std::string in_task = "` in `" + starts.task.name + "`";
    if (const Found found = deepest(begun, Look::kStart); found.box != nullptr) {
      Diagnostic& said = report(found,
                                "stands in `" + part_name(*found.box) + in_task +
                                    ": they overlap by " + centimetres(found.depth),
                                false);
      // Its height was chosen or recorded.
      if (!found.placed->z) return;
      said.severity = Severity::kWarning;
      said.help("if it is to begin so, say why: `@allow(in_the_way, \"...\")`");
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
    const Found found = deepest(begun, Look::kWay);
    if (found.box == nullptr) return;
    const bool is_chain = travel.carriers(found.box->part).size() > 1;
    Diagnostic& said =
        report(found,
               "is in the way of `" + part_name(*found.box) + in_task + ": they overlap by " +
                   (is_chain ? "at least " : "") + centimetres(found.depth) +
                   when_joints_stand(fixture, travel, *found.box),
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

}  // namespace

void check_travel(const TaskStarts& starts, Travels& travels) {
  for (const BegunFixture& begun : begun_fixtures(starts, travels)) {
    const TravelCheck check{starts, begun.fixture, begun.travel};
    check.check(begun.joints);
    check.check_arm(begun.joints.front(), travels.arm(starts.task.scene));
  }
}

}  // namespace probe::sema
