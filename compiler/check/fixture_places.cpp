// P1302 of a scene: parts of its fixtures that run into the surface, or into one another.
#include <fmt/format.h>

#include "compiler/check/joint_text.h"
#include "compiler/check/starts.h"

namespace probe::sema {
namespace {

constexpr double kRubs = 1e-3;  // m that a part may be lower than the surface, as a foot is

// A part anywhere on its way, and the surface.
void check_surface_below(const Scene& scene, const Fixture& fixture, const Travel& travel,
                         Reporter& reporter) {
  const PartBox* lowest_box = nullptr;
  double depth = kRubs;
  for (const PartBox& box : travel.everywhere().all()) {
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
                          scene.name, when_joints_stand(fixture, travel, *lowest_box)))
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
  const auto [found, depth] = worst(at_start ? begun : travel.everywhere().all(), &against);
  if (found == nullptr || (at_start && !is_first)) return;
  const std::string names =
      fmt::format("`{}` and `{}` in `{}`", fixture.body_name(fixture.parts[found->part]),
                  other.body_name(other.parts[against->part]), scene.name);
  Diagnostic& said = reporter.report(
      Code::P1302, fixture.span,
      at_start ? fmt::format("{} stand in one another by {}", names, centimetres(depth))
               : fmt::format("{} meet: they overlap by {}{}", names, centimetres(depth),
                             when_joints_stand(fixture, travel, *found)));
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
      const auto& travel = travels.of(scene, id);
      if (!travel) continue;
      const About about(reporter, fixture.span);
      check_surface_below(scene, fixture, *travel, reporter);
      bool is_first = false;  // behind itself in the list
      for (const FixtureId other : scene.fixtures) {
        const auto& other_travel = travels.of(scene, other);
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
