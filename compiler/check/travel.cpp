// P1302: what stands in a fixture with joints, or in the way of its parts. A joint's whole way is
// looked at, so that it does not matter where an episode leaves it.
#include <fmt/format.h>

#include <map>

#include "compiler/check/starts.h"
#include "compiler/define/fixture.h"
#include "compiler/geometry/camera_pose.h"
#include "compiler/geometry/footprint.h"
#include "compiler/geometry/travel.h"

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
                      : fmt::format("{:.4g}deg", position * 180 / 3.14159265358979323846);
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

struct TravelCheck {
  const TaskStarts& starts;
  const Fixture& fixture;

  std::string part_name(const PartBox& box) const {
    return fixture.body_name(fixture.parts[box.part]);
  }
  std::string when(const PartBox& box) const {
    const auto joint = fixture.parts[box.part].joint;
    if (!joint) return "";
    const Fixture::Joint& by = fixture.joints[*joint];
    return " when `" + fixture.name + "." + by.name + "` stands at " + stands(by, box.position);
  }

  // The deepest overlap of each start with any of the boxes. What is put into a part, at a height
  // of its own, goes where the part goes: `carriers`, of a look at the whole way.
  Found deepest(const std::vector<PartBox>& boxes,
                const std::map<std::uint32_t, Around>& carriers) const {
    Found found;
    const Scene& scene = starts.model.scenes[starts.task.scene];
    for (std::size_t e = 0; e < starts.task.starts.size(); ++e) {
      bool here = false;
      for (const Start::Placed& placed : starts.task.starts[e].placed) {
        const Object& object = starts.object(placed);
        const Mat3 turn = pose_of({}, placed.turn.rotation).rotation.toRotationMatrix();
        const double z = placed.z.value_or(scene.surface_z - lowest(object, turn));
        const scene::Solid body = solid(object, turn, {placed.x, placed.y, z});
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

  Diagnostic& report(const Found& found, const char* how, const std::string& at_joint) const {
    const Object& object = starts.object(*found.placed);
    return starts.reporter
        .report(Code::P1302, starts.place({found.placed->object}),
                fmt::format("`{}` {} `{}` in `{}`: they overlap by {}{}; so in {} of {} starts",
                            object.name, how, part_name(*found.box), starts.task.name,
                            centimetres(found.depth), at_joint, found.starts,
                            starts.task.starts.size()))
        .point(fmt::format("episode {}: {}", found.episode, at(object, *found.placed)))
        .label(fixture.span, "the fixture");
  }

  void check(const Travel& travel, std::span<const double> joints) const {
    const std::vector<PartBox> begun = travel.at(joints);
    if (const Found found = deepest(begun, {}); found.box != nullptr) {
      report(found, "stands in", "");
      return;
    }
    const Found found = deepest(travel.everywhere(), around_parts(begun));
    if (found.box == nullptr) return;
    Diagnostic& said = report(found, "is in the way of", when(*found.box));
    said.severity = Severity::kWarning;
    said.help(
        "move the fixture or the cells; if it is to be pushed away, say so: "
        "`@allow(in_the_way, \"...\")`");
  }
};

}  // namespace

const std::optional<Travel>& Travels::of(FixtureId id) {
  const auto [known, is_new] = known_.try_emplace(id);
  if (is_new) known->second = Travel::of(model_.fixtures[id], asset_root_);
  return known->second;
}

void check_travel(const TaskStarts& starts, Travels& travels) {
  const Scene& scene = starts.model.scenes[starts.task.scene];
  const std::vector<double> all = joint_starts_of(starts.model, starts.task);
  std::span<const double> left = all;
  for (const FixtureId id : scene.fixtures) {
    const Fixture& fixture = starts.model.fixtures[id];
    const auto joints = left.first(fixture.joints.size());
    left = left.subspan(fixture.joints.size());
    if (const auto& travel = travels.of(id)) TravelCheck{starts, fixture}.check(*travel, joints);
  }
}

// Once for a scene: what its fixtures meet that does not depend on starts.
void check_fixture_places(const Model& model, Travels& travels, Reporter& reporter) {
  for (const Scene& scene : model.scenes) {
    for (const FixtureId id : scene.fixtures) {
      const Fixture& fixture = model.fixtures[id];
      const auto& travel = travels.of(id);
      if (!travel || scene.broken) continue;
      const PartBox* lowest_box = nullptr;
      double depth = kRubs;
      for (const PartBox& box : travel->everywhere()) {
        if (!fixture.parts[box.part].joint) continue;  // what stands still meets no surface
        const double below = scene.surface_z - (box.solid.centre.z() - box.half.z());
        if (below <= depth) continue;
        depth = below;
        lowest_box = &box;
      }
      if (lowest_box == nullptr) continue;
      const About about(reporter, fixture.span);
      const Fixture::Part& part = fixture.parts[lowest_box->part];
      const Fixture::Joint& joint = fixture.joints[*part.joint];
      reporter
          .report(Code::P1302, fixture.span,
                  fmt::format("`{}` runs {} into the surface of `{}` when `{}.{}` stands at {}",
                              fixture.body_name(part), centimetres(depth), scene.name, fixture.name,
                              joint.name, stands(joint, lowest_box->position)))
          .label(scene.span, "the scene")
          .help("put the fixture higher");
    }
  }
}

}  // namespace probe::sema
