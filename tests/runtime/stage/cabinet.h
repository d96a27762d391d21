// A cabinet with a tray and a button under the start of a task of the suite: the one fixture with
// joints that tests of the stage, of runs and of traces share.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/stage/stage.h"
#include "tests/parity/published.h"

namespace probe::test {

inline constexpr const char* kCabinetTask = "carrot_on_plate";
inline constexpr double kButtonStiffness = 50;  // N/m
inline constexpr double kButtonMass = 0.1;      // kg, of cabinet.urdf

// The tray lies 5 mm above the table, its middle under `middle` (m, world) at `open` (m).
inline stage::Fixture cabinet(const Vec3& middle, double open = 0.1) {
  stage::Fixture fixture;
  fixture.name = "cabinet";
  fixture.urdf = "../tests/runtime/stage/cabinet.urdf";
  fixture.base.position = middle + Vec3(-open, 0, 0.02);
  fixture.joints = {{.joint = "slide", .damping = 5, .friction = 1},
                    {.joint = "press", .stiffness = kButtonStiffness, .damping = 2}};
  fixture.positions = {open, 0};
  return fixture;
}

// On the surface, below the task's source in start 0 but as far from the target that it lies beside
// the tray.
inline Vec3 below_source(const plan::Plan& plan, std::uint32_t task) {
  const plan::TaskRecord& record = plan.tasks()[task];
  const auto placed = plan.placements(plan.episodes(record)[0]);
  const auto& source = placed[0].position;
  const auto& target = placed[1].position;
  const Eigen::Vector2d away(source[0] - target[0], source[1] - target[1]);
  const Eigen::Vector2d at = Eigen::Vector2d(source[0], source[1]) + 0.08 * away.normalized();
  return {at.x(), at.y(), plan.scenes()[record.scene].surface_z};
}

// A stage of kCabinetTask with `fixtures`.
inline std::unique_ptr<stage::Stage> open_furnished(const std::vector<stage::Fixture>& fixtures,
                                                    const stage::StageOptions& options = {}) {
  const plan::Plan& plan = suite_plan();
  const std::uint32_t tasks[] = {plan.find_task(kCabinetTask).value()};
  auto assets = stage::SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks, fixtures);
  REQUIRE_MESSAGE(assets.ok(), (assets.ok() ? "" : to_text(assets.failure())));
  auto made = stage::Stage::create(plan, tasks[0], *assets, options);
  REQUIRE_MESSAGE(made.ok(), (made.ok() ? "" : to_text(made.failure())));
  return std::move(*made);
}

// With the cabinet under the source.
inline std::unique_ptr<stage::Stage> open_with_cabinet(const stage::StageOptions& options = {},
                                                       double open = 0.1) {
  const plan::Plan& plan = suite_plan();
  const std::uint32_t task = plan.find_task(kCabinetTask).value();
  return open_furnished({cabinet(below_source(plan, task), open)}, options);
}

}  // namespace probe::test
