// Starts from a table: the numbers of the file are those of the plan, for every task that takes
// them.
#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/plan/plan.h"

using namespace probe;
namespace fs = std::filesystem;

namespace {

const fs::path kRoot(VLAPROBE_SOURCE_DIR);

Compilation compile_with(const std::string& table, const std::string& text) {
  const fs::path folder =
      fs::temp_directory_path() / ("probe_start_table_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "starts.csv", std::ios::binary) << table;
  const std::string name = (folder / "text.probe").string();
  std::ofstream(name) << "use \"suite/intact.probe\"\n" << text;
  CompileOptions options;
  options.asset_root = (kRoot / "assets").string();
  options.library_folders = {(kRoot / "dsl").string(), kRoot.string()};
  options.wants_task = [](std::string_view task) { return task == "t" || task == "u"; };
  auto built = build(std::span<const std::string>(&name, 1), options);
  fs::remove_all(folder);
  REQUIRE_MESSAGE(built.ok(), to_text(built.failure()));
  return std::move(built).value();
}

plan::Plan plan_with(const std::string& table, const std::string& text) {
  Compilation built = compile_with(table, text);
  REQUIRE_MESSAGE(built.ok, render_text(built.diagnostics, built.sources));
  auto plan = plan::Plan::from_bytes(std::move(built.plan));
  REQUIRE_MESSAGE(plan.ok(), to_text(plan.failure()));
  return std::move(plan).value();
}

std::string said(const std::string& table, const std::string& text) {
  const Compilation built = compile_with(table, text);
  return render_text(built.diagnostics, built.sources);
}

const char* const kLayout = "layout given { starts \"starts.csv\"; drop 2cm settle 0.5s }\n";
const std::string kTask =
    std::string(kLayout) + "task t like on_table { layout given; source carrot; target plate }\n";

}  // namespace

TEST_CASE(
    "a table's numbers are the plan's, by role and by name, in any order of columns and rows") {
  const plan::Plan plan = plan_with(
      "\xef\xbb\xbf"
      "object , start,x_m,y_m,qz,qw,qx,qy,z_m\r\n"
      "# a comment, and an empty line\r\n\r\n"
      "plate,0,-0.16,-0.075,0,1,0,0,0.95\r\n"
      "source,0,-0.2,0.075,0.7071068,0.7071068,0,0,1.05\r\n"
      "\"source\",1,-0.16,0.05,0,1,0,0,0.9\r\n"
      "plate,1,-0.1,-0.1,0,1,0,0,0.9",
      kTask + "task u like t { source spoon }\n");
  for (const char* name : {"t", "u"}) {
    CAPTURE(name);
    const plan::TaskRecord& task = plan.tasks()[plan.find_task(name).value()];
    const auto episodes = plan.episodes(task);
    REQUIRE(episodes.size() == 2);
    const auto first = plan.placements(episodes[0]);
    CHECK(first[0].position == std::array<double, 3>{-0.2, 0.075, 1.05});
    CHECK(first[0].rotation[0] == doctest::Approx(std::sqrt(0.5)).epsilon(1e-12));
    CHECK(first[0].rotation[3] == first[0].rotation[0]);
    CHECK(first[1].position == std::array<double, 3>{-0.16, -0.075, 0.95});
    CHECK(plan.placements(episodes[1])[1].position == std::array<double, 3>{-0.1, -0.1, 0.9});
  }
}

TEST_CASE("without heights and turns objects are dropped as the layout says, lying as they rest") {
  const std::string table = "start,object,x_m,y_m\n0,source,-0.2,0.075\n0,target,-0.16,-0.075\n";
  const plan::Plan plan = plan_with(table, kTask + "task u like t { pose carrot yaw 90deg }\n");
  const plan::TaskRecord& task = plan.tasks()[plan.find_task("t").value()];
  const auto placed = plan.placements(plan.episodes(task)[0]);
  CHECK(placed[0].position[2] ==
        doctest::Approx(plan.scenes()[task.scene].surface_z + 0.02).epsilon(1e-12));
  CHECK(std::abs(placed[0].rotation[3]) == 1);  // its first rest: yaw 180deg
  const plan::TaskRecord& posed = plan.tasks()[plan.find_task("u").value()];
  CHECK(plan.placements(plan.episodes(posed)[0])[0].rotation[3] ==
        doctest::Approx(std::sqrt(0.5)).epsilon(1e-12));
}

TEST_CASE("another number in the table is another start") {
  const auto id = [](const char* x) {
    const plan::Plan plan = plan_with(
        std::string("start,object,x_m,y_m\n0,source,") + x + ",0.075\n0,target,-0.16,-0.075\n",
        kTask);
    return plan.episodes()[0].start_id;
  };
  CHECK(id("-0.2") == id("-0.20"));
  CHECK(id("-0.2") != id("-0.2000001"));
}

TEST_CASE("what a table names by name is in the scene of its tasks") {
  const plan::Plan plan = plan_with(
      "start,object,x_m,y_m\n0,source,-0.2,0.075\n0,target,-0.2,-0.075\n0,orange,-0.1,0\n", kTask);
  CHECK(plan.placements(plan.episodes()[0]).size() == 3);
}

TEST_CASE("heights keep things apart that stand over one another") {
  const std::string over = "start,object,x_m,y_m,z_m\n0,source,-0.16,0,1.1\n0,target,-0.16,0,0.9\n";
  const std::string within =
      "start,object,x_m,y_m,z_m\n0,source,-0.16,0,0.9\n0,target,-0.16,0,0.9\n";
  CHECK(said(over, kTask).find("P0501") == std::string::npos);
  CHECK(said(within, kTask).find("P0501") != std::string::npos);
}

TEST_CASE("a mistake in a table is told at its line and cell") {
  const auto at = [](const std::string& row) {
    return said("start,object,x_m,y_m\n0,source,-0.2,0.075\n" + row, kTask);
  };
  CHECK(at("0,target,-0.16,inf\n").find("starts.csv:3:16") != std::string::npos);
  CHECK(at("0,target,-0.16,2e9\n").find("error[P0304]") != std::string::npos);
  CHECK(at("0,plaet,-0.16,0\n").find("did you mean `plate`?") != std::string::npos);
  CHECK(at("0,target,\"-0,16\",0\n").find("this row has 5 cells, the header 4") !=
        std::string::npos);
  CHECK(at("2,target,-0.16,0\n").find("expected start 0 or 1, found `2`") != std::string::npos);
  CHECK(at("-1,target,-0.16,0\n").find("expected start 0 or 1, found `-1`") != std::string::npos);
  CHECK(said("", kTask).find("the file of starts is empty") != std::string::npos);
  CHECK(said("start,object,x_m,y_m\n", kTask).find("there are no starts below this line") !=
        std::string::npos);
}
