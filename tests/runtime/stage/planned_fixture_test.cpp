// A fixture with joints from its text to an episode: its parts are bodies that are judged, its
// joints begin where the start says.
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/stage/stage.h"
#include "tests/plan/other_link.h"

namespace probe::stage {
namespace {

const std::string kRoot = VLAPROBE_SOURCE_DIR;

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("probe_planned_fixture_" + std::to_string(getpid()) + ".probe");
  std::ofstream(file) << text;
  const std::vector<std::string> files = {file.string()};
  auto made = build(
      files,
      {.asset_root = kRoot + "/assets", .suite = "", .library_folders = {kRoot + "/dsl", kRoot}});
  std::filesystem::remove(file);
  REQUIRE_MESSAGE(made.ok(), (made.ok() ? "" : to_text(made.failure())));
  REQUIRE_MESSAGE(!made->diagnostics.has_errors(), render_text(made->diagnostics, made->sources));
  return std::move(made->plan);
}

plan::Plan compiled(const std::string& text) {
  auto plan = plan::Plan::from_bytes(bytes_of(text));
  REQUIRE_MESSAGE(plan.ok(), (plan.ok() ? "" : to_text(plan.failure())));
  return std::move(*plan);
}

// The drawer's rails lean, so it slides open by itself, braked by its damping.
const char* const kText = R"(
use "suite/intact.probe"
use "std/fixtures.probe"
fixture cabinet {
  urdf "fixtures/cabinet/cabinet.urdf"; at (-27cm, 30cm, 97cm) pitch 20deg
  joint top damping 10Ns/m
  joint middle friction 50N start 3cm
  joint bottom friction 50N
  part top_drawer link top_drawer name "top drawer"
  region inside_top of top_drawer box (-8cm, -12cm, -3cm) .. (10cm, 12cm, 2cm)
}
scene furnished like table { fixture cabinet }
metrics opening {
  success = at end opened(cabinet.top_drawer)
  far     = final travel(cabinet.top)
  middle  = final travel(cabinet.middle)
  stored  = at end lies_in(source, cabinet.inside_top)
  touched = once impulse(cabinet.top_drawer, source) > 1e-6Ns
}
task open_drawer like carrot_on_plate { scene furnished; metrics opening }
variant ajar of open_drawer { start cabinet.top 14cm }
)";

double value(const Stage& stage, const char* metric) {
  const auto index = stage.judge().find_metric(metric);
  REQUIRE(index);
  return stage.judge().values()[*index];
}

TEST_CASE("a cabinet of a text stands in the world, is judged and begins where the start says") {
  const plan::Plan plan = compiled(kText);
  const std::uint32_t tasks[] = {*plan.find_task("open_drawer"), *plan.find_task("ajar")};
  auto assets = SharedAssets::load(plan, kRoot + "/assets", tasks);
  REQUIRE_MESSAGE(assets.ok(), (assets.ok() ? "" : to_text(assets.failure())));
  for (const std::uint32_t task : tasks) {
    auto made = Stage::create(plan, task, *assets, {.pictures = false});
    REQUIRE_MESSAGE(made.ok(), (made.ok() ? "" : to_text(made.failure())));
    Stage& stage = **made;
    const auto bodies = plan.bodies(plan.tasks()[task]);
    REQUIRE(stage.body_names().size() == bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i)
      CHECK(stage.body_names()[i] == plan.text(bodies[i].name));
    CHECK(stage.body_names()[bodies.size() - 4] == "cabinet");
    CHECK(std::ranges::find(stage.body_names(), "cabinet.top_drawer") != stage.body_names().end());
    const auto started = stage.reset(0);
    REQUIRE_MESSAGE(started.ok(), (started.ok() ? "" : to_text(started.failure())));
    const auto joints = stage.joint_names();
    REQUIRE(joints.size() == 11);
    CHECK(joints[8] == "cabinet.top");
    // Friction holds it where the text puts it.
    CHECK(stage.q()[9] == doctest::Approx(0.03));
    for (int i = 0; i < 3; ++i) REQUIRE(stage.step({0, 0, 0, 0, 0, 0, 1}).ok());
    CHECK(value(stage, "far") == stage.sample().joints[8].position);
    CHECK(value(stage, "middle") == stage.q()[9]);
    CHECK(value(stage, "stored") == 0);
    // It slid while objects fell, and the other was open from the beginning.
    CHECK(value(stage, "far") > 0.05);
    CHECK((value(stage, "success") != 0) == (value(stage, "far") >= 0.8 * 0.14));
    // Bit for bit from a saved state.
    auto fresh = Stage::create(plan, task, *assets, {.pictures = false});
    REQUIRE(fresh.ok());
    REQUIRE((*fresh)->restore(stage.save()).ok());
    REQUIRE(stage.step({0, 0, 0, 0, 0, 0, 1}).ok());
    REQUIRE((*fresh)->step({0, 0, 0, 0, 0, 0, 1}).ok());
    CHECK(stage.state_hash() == (*fresh)->state_hash());
  }
}

TEST_CASE("starts with other joints are other starts") {
  const plan::Plan plan = compiled(kText);
  const auto& first = plan.tasks()[*plan.find_task("open_drawer")];
  const auto& second = plan.tasks()[*plan.find_task("ajar")];
  CHECK(second.axes == static_cast<std::uint32_t>(plan::Axis::kFixture));
  CHECK(plan.episodes(first)[0].start_id != plan.episodes(second)[0].start_id);
  CHECK(first.judge_id == second.judge_id);
}

TEST_CASE("a plan whose parts are not the description's links is refused before an episode") {
  const plan::Plan whole = compiled(kText);
  const auto parts = whole.parts(whole.fixtures()[0]);
  REQUIRE(whole.text(parts[1].name) == "cabinet.top_drawer");
  const std::uint32_t tasks[] = {*whole.find_task("open_drawer")};
  const auto refusal = [&](plan::StringRef link) {
    const plan::Plan plan = plan::with_link(bytes_of(kText), 1, link);
    const auto assets = SharedAssets::load(plan, kRoot + "/assets", tasks);
    return assets.ok() ? std::string() : to_text(assets.failure());
  };
  const std::string lacking = refusal(parts[1].name);
  CHECK_MESSAGE(lacking.find("no link `cabinet.top_drawer` for part `cabinet.top_drawer`") !=
                    std::string::npos,
                lacking);
  CHECK(lacking.find("fixtures/cabinet/cabinet.urdf") != std::string::npos);
  const std::string twice = refusal(parts[0].link);
  CHECK_MESSAGE(twice.find("for part `cabinet.top_drawer` is part `cabinet`") != std::string::npos,
                twice);
}

}  // namespace
}  // namespace probe::stage
