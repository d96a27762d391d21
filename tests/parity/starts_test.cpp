// The suite against the published one: starts, prompts and the judged program, compared exactly.
#include <doctest/doctest.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/base/trig.h"
#include "runtime/plan/plan.h"

using namespace probe;
namespace fs = std::filesystem;

namespace {

const fs::path kSource = VLAPROBE_SOURCE_DIR;
const fs::path kReference = fs::path(VLAPROBE_SOURCE_DIR "/../shared/reference");

struct Row {
  int episode = 0;
  std::string object;
  double x = 0, y = 0, roll = 0, pitch = 0, yaw = 0;
};

double number(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// In the file's order: by episode, then source, target, distractors.
std::vector<Row> published_starts(const std::string& task) {
  std::ifstream in(kReference / "intact_starts.csv");
  std::vector<Row> rows;
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> cells;
    std::istringstream parts(line);
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    if (cells.size() != 8 || cells[0] != task) continue;
    rows.push_back({static_cast<int>(number(cells[1])), cells[2], number(cells[3]),
                    number(cells[4]), number(cells[5]), number(cells[6]), number(cells[7])});
  }
  return rows;
}

const plan::Plan& suite_plan() {
  static const plan::Plan plan = [] {
    const std::string file = (kSource / "suite/intact.probe").string();
    auto built = build(std::span<const std::string>(&file, 1), {(kSource / "assets").string(), ""});
    REQUIRE_MESSAGE(built.ok(), to_text(built.failure()));
    REQUIRE_MESSAGE(built->ok, render_text(built->diagnostics, built->sources));
    auto opened = plan::Plan::from_bytes(built->plan);
    REQUIRE_MESSAGE(opened.ok(), to_text(opened.failure()));
    return std::move(opened).value();
  }();
  return plan;
}

}  // namespace

TEST_CASE("every start equals the published one to the last bit") {
  if (!fs::exists(kReference / "intact_starts.csv")) {
    MESSAGE("skipped: the published starts are not on this machine");
    return;
  }
  const plan::Plan& plan = suite_plan();
  for (const plan::TaskRecord& task : plan.tasks()) {
    const std::string name(plan.text(task.name));
    CAPTURE(name);
    const std::vector<Row> rows = published_starts("widowx_" + name);
    REQUIRE(task.episodes.count == 24);
    std::size_t at = 0;
    for (std::uint32_t e = 0; e < task.episodes.count; ++e) {
      const plan::EpisodeRecord& episode = plan.episodes()[task.episodes.first + e];
      for (const plan::PlacementRecord& placement :
           plan::slice_of(plan.tables().placements, episode.placements)) {
        REQUIRE(at < rows.size());
        const Row& row = rows[at++];
        CAPTURE(e);
        CHECK(row.episode == static_cast<int>(e));
        CHECK(row.object == plan.text(plan.objects()[placement.object].name));
        CHECK(placement.position[0] == row.x);
        CHECK(placement.position[1] == row.y);
        CHECK(placement.position[2] == 0.87 + 0.5);
        REQUIRE(row.roll == 0);
        REQUIRE(row.pitch == 0);
        const SinCos half = portable_sincos_deg(row.yaw / 2);
        CHECK(placement.rotation == std::array<double, 4>{half.cos, 0, 0, half.sin});
      }
    }
    CHECK(at == rows.size());
  }
}

TEST_CASE("prompts, horizons, baselines and roles equal the published ones") {
  std::ifstream in(kReference / "intact_tasks.json");
  if (!in) {
    MESSAGE("skipped: the published task list is not on this machine");
    return;
  }
  const nlohmann::json published = nlohmann::json::parse(in);
  const plan::Plan& plan = suite_plan();
  for (const plan::TaskRecord& task : plan.tasks()) {
    const std::string name = "widowx_" + std::string(plan.text(task.name));
    CAPTURE(name);
    bool found = false;
    for (const auto& entry : published["tasks"]) {
      if (entry["name"] != name) continue;
      found = true;
      CHECK(plan.text(task.prompt) == entry["instruction"].get<std::string>());
      CHECK(task.horizon == entry["max_control_steps"].get<std::uint32_t>());
      CHECK(plan.text(plan.objects()[task.source].name) == entry["source"].get<std::string>());
      CHECK(plan.text(plan.objects()[task.target].name) == entry["target"].get<std::string>());
      const std::string baseline =
          task.baseline == plan::kNone
              ? name
              : "widowx_" + std::string(plan.text(plan.tasks()[task.baseline].name));
      CHECK(baseline == entry["canonical"].get<std::string>());
    }
    CHECK(found);
  }
  for (const plan::ObjectRecord& object : plan.objects()) {
    const auto& entry = published["objects"][std::string(plan.text(object.name))];
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(object.box_min[i] == entry["bbox_min"][i].get<double>());
      CHECK(object.box_max[i] == entry["bbox_max"][i].get<double>());
    }
    CHECK(object.density == entry["density_kg_m3"].get<double>());
  }
}

TEST_CASE("the first suite is the published canonical task with its three seeds") {
  const plan::Plan& plan = suite_plan();
  REQUIRE(plan.suites().size() == 2);
  const plan::SuiteRecord& suite = plan.suites()[0];
  CHECK(plan.text(suite.name) == "intact");
  CHECK(plan.text(suite.prefix) == "widowx_");
  CHECK(suite.members.count == 1);
  const auto seeds = plan::slice_of(plan.tables().list, suite.seeds);
  CHECK(std::vector<std::uint32_t>(seeds.begin(), seeds.end()) ==
        std::vector<std::uint32_t>{42, 7, 314});
  CHECK(plan.text(plan.metrics()[0].name) == "success");
  CHECK(plan.metrics().size() == 6);
  CHECK(plan.programs().size() == 1);
  CHECK(plan.programs()[0].code.count == 83);
}

TEST_CASE("the stage has the numbers of the published setup") {
  const plan::Plan& plan = suite_plan();
  const plan::SceneRecord& scene = plan.scenes()[0];
  CHECK(scene.base_position == std::array<double, 3>{0.147, 0.028, 0.87});
  CHECK(scene.base_rotation == std::array<double, 4>{0, 0, 0, 1});
  CHECK(scene.surface_z == 0.87);
  CHECK(scene.physics_hz == 500);
  CHECK(scene.friction == 1);
  const auto joints = plan::slice_of(plan.tables().reals, scene.joints);
  CHECK(std::vector<double>(joints.begin(), joints.end()) ==
        std::vector<double>{-0.01840777, 0.0398835, 0.22242722, -0.00460194, 1.36524296, 0.00153398,
                            0.037, 0.037});
  const plan::RobotRecord& robot = plan.robots()[0];
  CHECK(robot.control_hz == 5);
  CHECK(robot.grip_closed == 0.014);
  CHECK(robot.grip_open == 0.038);
  CHECK(robot.finger_friction == 2);
  CHECK(robot.link_friction == 1);
  CHECK(robot.finger_patch == 0.01);
  const auto drives = plan::slice_of(plan.tables().drives, robot.drives);
  REQUIRE(drives.size() == 8);
  CHECK(drives[0].stiffness == 1169.789);
  CHECK(drives[2].damping == 152.12);
  CHECK(drives[7].limit == 60);
  const plan::CameraRecord& camera = plan.cameras()[0];
  CHECK(camera.position == std::array<double, 3>{0, -0.16, 0.36});
  CHECK(camera.aim_values == std::array<double, 4>{1, 0.553, -1.085, 0});
  CHECK(camera.fx == 623.588);
  CHECK(camera.cy == 239.545);
  CHECK(plan.objects()[0].friction == 0.5);
}
