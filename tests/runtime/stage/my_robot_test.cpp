// A robot that is not shipped works from its description and Probe text alone.
#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/plan/plan.h"
#include "runtime/stage/stage.h"
#include "tests/runtime/stage/gantry.h"
#include "tests/runtime/stage/solves.h"

namespace probe::stage {
namespace {

Result<Compilation> built_with(const OwnAssets& assets, const std::string& file) {
  return build(std::span<const std::string>(&file, 1),
               {assets.folder(), "", {VLAPROBE_SOURCE_DIR "/dsl", VLAPROBE_SOURCE_DIR}});
}

TEST_CASE("a hand that points along another axis than said cannot grasp from above") {
  const OwnAssets assets;
  std::ifstream in(VLAPROBE_SOURCE_DIR "/examples/my_robot.probe");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  for (const auto& [part, instead] :
       {std::pair{"\"../suite/intact.probe\"", "\"suite/intact.probe\""}, {" points +z", ""}}) {
    const std::size_t at = text.find(part);
    REQUIRE(at != std::string::npos);
    text.replace(at, std::string_view(part).size(), instead);
  }
  const std::string file = assets.folder() + "/sideways.probe";
  std::ofstream(file) << text;
  const auto built = built_with(assets, file);
  REQUIRE_MESSAGE(built.ok(), to_text(built.failure()));
  const std::string said = render_text(built->diagnostics, built->sources);
  CHECK_MESSAGE(said.find("error[P0502]: `gantry` cannot grasp") == 0, said);
  CHECK_MESSAGE(said.find("`tcp tool points +z` says otherwise") != std::string::npos, said);
}

TEST_CASE("the example's own robot is checked, its hand measured, and the expert works with it") {
  const OwnAssets assets;
  auto built = built_with(assets, VLAPROBE_SOURCE_DIR "/examples/my_robot.probe");
  REQUIRE_MESSAGE(built.ok(), to_text(built.failure()));
  CHECK_MESSAGE(built->diagnostics.empty(), render_text(built->diagnostics, built->sources));
  REQUIRE(built->ok);
  const auto plan = plan::Plan::from_bytes(std::move(built->plan));
  REQUIRE_MESSAGE(plan.ok(), to_text(plan.failure()));

  const std::uint32_t tasks[] = {plan->find_task("carrot_by_gantry").value()};
  const auto loaded = SharedAssets::load(*plan, assets.folder(), tasks);
  REQUIRE_MESSAGE(loaded.ok(), (loaded.ok() ? "" : to_text(loaded.failure())));
  const auto& record = plan->robots()[plan->scenes()[plan->tasks()[tasks[0]].scene].robot];
  CHECK((*loaded)->robot(record.urdf)->visuals.size() == 3);  // the boxes of hand and fingers
  const auto stage = Stage::create(*plan, tasks[0], *loaded, {{}, false});
  REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : to_text(stage.failure())));
  const std::uint32_t starts = plan->tasks()[tasks[0]].episodes.count;
  int solved = 0;
  for (std::uint32_t start = 0; start < starts; ++start)
    solved += solves(**stage, *plan, start) ? 1 : 0;
  MESSAGE("the gantry: " << solved << " of " << starts);
  CHECK(solved == static_cast<int>(starts));
}

}  // namespace
}  // namespace probe::stage
