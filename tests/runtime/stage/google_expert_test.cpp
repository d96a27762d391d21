// The scripted expert and SimplerEnv's Google robot, whose fingers turn: a can, a drawer that is
// drawn by its edge, and one that has a handle and is filled.
#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/stage/stage.h"
#include "tests/runtime/stage/solves.h"

namespace probe::stage {
namespace {

const std::string kRoot = VLAPROBE_SOURCE_DIR;

plan::Plan tried() {
  const auto file = std::filesystem::temp_directory_path() /
                    ("probe_google_expert_" + std::to_string(getpid()) + ".probe");
  std::ofstream(file) << "use \"suite/google_clean.probe\"\n"
                         "suite tried { tasks { pick_standing, open_middle, place_apple_clean }; "
                         "seeds 0 }\n";
  const std::vector<std::string> files = {file.string()};
  auto made = build(files, {.asset_root = kRoot + "/assets",
                            .suite = "tried",
                            .library_folders = {kRoot + "/dsl", kRoot}});
  std::filesystem::remove(file);
  REQUIRE_MESSAGE(made.ok(), (made.ok() ? "" : to_text(made.failure())));
  REQUIRE_MESSAGE(made->ok, render_text(made->diagnostics, made->sources));
  auto plan = plan::Plan::from_bytes(std::move(made->plan));
  REQUIRE_MESSAGE(plan.ok(), (plan.ok() ? "" : to_text(plan.failure())));
  return std::move(*plan);
}

}  // namespace

TEST_CASE("the expert lifts a can, opens a drawer and fills one with the Google robot") {
  const plan::Plan plan = tried();
  // The last comes to the handle, draws it near its base, and has to come back to the apple.
  for (const auto& [name, start] :
       {std::pair{"pick_standing", 12u}, {"open_middle", 0u}, {"place_apple_clean", 4u}}) {
    CAPTURE(name);
    const std::uint32_t tasks[] = {plan.find_task(name).value()};
    const auto assets = SharedAssets::load(plan, kRoot + "/assets", tasks);
    REQUIRE_MESSAGE(assets.ok(), (assets.ok() ? "" : to_text(assets.failure())));
    const auto stage = Stage::create(plan, tasks[0], *assets, {{}, false});
    REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : to_text(stage.failure())));
    CHECK(solves(**stage, plan, start));
  }
}

}  // namespace probe::stage
