// The small plan with a cabinet in its scene: a drawer that slides and a wheel that turns without
// end.
#pragma once

#include "tests/runtime/plan/small_plan.h"

namespace probe::plan {

inline constexpr std::uint32_t kCabinetBody = 6, kDrawerBody = 7;

inline Writer fixture_writer() {
  Writer w = small_writer();
  Records& r = w.records;
  FixtureRecord fixture;
  fixture.name = w.text("cabinet");
  fixture.urdf = add_asset(w, "fixtures/cabinet.urdf", AssetKind::kUrdf);
  fixture.position = {0.1, 0.2, 0.87};
  fixture.rotation = {1, 0, 0, 0};
  fixture.friction = 1;
  std::vector<FixtureJointRecord> joints(2);
  joints[0].joint = w.text("top");
  joints[0].motion = static_cast<std::uint32_t>(JointMotion::kSlides);
  joints[0].upper = 0.2;
  joints[0].friction = 2;
  joints[0].damping = 5;
  joints[1].joint = w.text("wheel");
  joints[1].motion = static_cast<std::uint32_t>(JointMotion::kTurns);
  joints[1].start = 9;
  fixture.joints = append<FixtureJointRecord>(r.fixture_joints, joints);
  std::vector<PartRecord> parts(2);
  parts[0].name = w.text("cabinet");
  parts[0].link = w.text("body");
  parts[1].name = w.text("cabinet.top_drawer");
  parts[1].link = w.text("drawer");
  parts[1].text = w.text("top drawer");
  parts[1].joint = 0;
  parts[1].declared = 1;
  fixture.parts = append<PartRecord>(r.parts, parts);
  fixture.meshes = w.list(
      std::vector<std::uint32_t>{add_asset(w, "fixtures/drawer.glb", AssetKind::kVisualMesh)});
  r.fixtures.push_back(fixture);
  r.scenes[0].fixtures = w.list(std::vector<std::uint32_t>{0});
  r.regions.push_back({w.text("cabinet.inside_top"),
                       static_cast<std::uint32_t>(BodyKind::kPart),
                       1,
                       {-0.1, -0.1, 0},
                       {0.1, 0.1, 0.06}});
  // Its parts behind the links of both tasks.
  std::vector<BodyRecord> bodies;
  for (TaskRecord& task : r.tasks) {
    const auto own = slice_of(std::span<const BodyRecord>(r.bodies), task.bodies);
    task.bodies = {static_cast<std::uint32_t>(bodies.size()), task.bodies.count + 2};
    bodies.insert(bodies.end(), own.begin(), own.end());
    for (std::uint32_t i = 0; i < 2; ++i)
      bodies.push_back({static_cast<std::uint32_t>(BodyKind::kPart), i, parts[i].name});
  }
  r.bodies = bodies;
  // Measured, for nothing but being there.
  r.code.pop_back();
  for (const Instruction& in :
       {make_instruction(Op::kSLIDE, 15, 0), make_instruction(Op::kTURN, 16, 1),
        make_instruction(Op::kLOCAL, 17, kDrawerBody, 0), make_instruction(Op::kSLIDING, 18, 0),
        make_instruction(Op::kTURNING, 19, 1), make_instruction(Op::kEND, 20)})
    r.code.push_back(in);
  r.programs[0].code.count = static_cast<std::uint32_t>(r.code.size());
  return w;
}

}  // namespace probe::plan
