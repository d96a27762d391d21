// What stands in suite/libero/stage.probe and again in the importer's tables is the same.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "compiler/diag/text.h"
#include "runtime/compile/files.h"
#include "runtime/libero/suites.h"
#include "runtime/plan/plan.h"

namespace probe::libero {
namespace {

namespace fs = std::filesystem;

struct SceneRow {
  const char *scene, *robot;
  double surface;
};
constexpr SceneRow kScenes[] = {
#define LIBERO_SCENE(problem, scene, robot, x, y, z, surface, regions) {#scene, #robot, surface},
#include "runtime/libero/scenes.def"
};

Compilation compiled(const std::string& file) {
  compile::FilesRequest request;
  request.assets = VLAPROBE_SOURCE_DIR "/assets";
  request.library = VLAPROBE_SOURCE_DIR "/dsl";
  auto made = compile::compile_files({file}, request);
  REQUIRE_MESSAGE(made.ok(), to_text(made.failure()));
  return std::move(made).value();
}

// Of tasks that are written in a file of this process.
plan::Plan plan_of(const std::string& tasks) {
  const fs::path file =
      fs::temp_directory_path() / ("vlaprobe_libero_stage_" + std::to_string(getpid()) + ".probe");
  std::ofstream(file)
      << "use \"suite/libero/stage.probe\"\nuse \"suite/catalog.probe\"\n"
         "layout one { place source at (0cm, 0cm); orient source yaw 0deg; drop 2cm settle 0.5s }\n"
         "metrics lifted { success = at end height(source) > 2m }\n"
      << tasks;
  const Compilation built = compiled(file.string());
  fs::remove(file);
  INFO(render_text(built.diagnostics, built.sources));
  CHECK(built.diagnostics.items().empty());
  REQUIRE(built.ok);
  auto plan = plan::Plan::from_bytes(built.plan);
  REQUIRE_MESSAGE(plan.ok(), to_text(plan.failure()));
  return std::move(plan).value();
}

std::string task_text(std::string_view name, std::string_view like, std::string_view scene) {
  return fmt::format(
      "task {} like {} {{ scene {}; layout one; metrics lifted; source green_cube; say \"pick up "
      "{{the source}}\" }}\n",
      name, like, scene);
}

}  // namespace

TEST_CASE("the stage and the rules check clean as they are") {
  for (const char* name : {"stage", "predicates"}) {
    const Compilation built =
        compiled(fmt::format("{}/suite/libero/{}.probe", VLAPROBE_SOURCE_DIR, name));
    INFO(render_text(built.diagnostics, built.sources));
    CHECK(built.diagnostics.items().empty());
  }
}

TEST_CASE("a suite's abstract task waits and lasts as the importer's table of suites says") {
  std::string tasks;
  for (const Suite& suite : suites())
    tasks += task_text(suite.folder, fmt::format("{}_task", suite.folder), "libero_tabletop");
  const plan::Plan plan = plan_of(tasks);
  CHECK(plan.tasks().size() == suites().size());
  for (const Suite& suite : suites()) {
    CAPTURE(suite.folder);
    const auto found = plan.find_task(suite.folder);
    REQUIRE(found.has_value());
    CHECK(plan.tasks()[*found].horizon == suite.horizon);
    CHECK(plan.tasks()[*found].idle == kWaiting);
  }
}

TEST_CASE("a scene has the robot and the height that the importer's table of scenes says") {
  std::string tasks;
  for (const SceneRow& row : kScenes)
    tasks += task_text(fmt::format("in_{}", row.scene), "libero_90_task", row.scene);
  const plan::Plan plan = plan_of(tasks);
  CHECK(plan.tasks().size() == std::size(kScenes));
  for (const SceneRow& row : kScenes) {
    CAPTURE(row.scene);
    const auto found = plan.find_task(fmt::format("in_{}", row.scene));
    REQUIRE(found.has_value());
    const plan::SceneRecord& scene = plan.scenes()[plan.tasks()[*found].scene];
    CHECK(scene.surface_z == doctest::Approx(row.surface).epsilon(1e-12));
    CHECK(plan.text(plan.robots()[scene.robot].name) == row.robot);
  }
}

}  // namespace probe::libero
