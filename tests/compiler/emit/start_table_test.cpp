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
#include "runtime/inspect/fixture_json.h"
#include "runtime/inspect/svg.h"
#include "runtime/inspect/task_json.h"
#include "runtime/inspect/top_view.h"
#include "runtime/plan/axes.h"
#include "runtime/plan/fixtures.h"
#include "runtime/plan/plan.h"

using namespace probe;
namespace fs = std::filesystem;

namespace {

const fs::path kRoot(VLAPROBE_SOURCE_DIR);

// `placed` is a second table, placed.csv.
Compilation compile_with(const std::string& table, const std::string& text,
                         const std::string& placed = "") {
  const fs::path folder =
      fs::temp_directory_path() / ("probe_start_table_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "starts.csv", std::ios::binary) << table;
  std::ofstream(folder / "placed.csv", std::ios::binary) << placed;
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

plan::Plan plan_with(const std::string& table, const std::string& text,
                     const std::string& placed = "") {
  Compilation built = compile_with(table, text, placed);
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

TEST_CASE("what a table has deep in the table top or far above it is told with how far") {
  const auto with = [](const std::string& z) {
    return said("start,object,x_m,y_m,z_m\n0,source,-0.16,-0.1," + z + "\n0,target,-0.16,0.1,0.9\n",
                kTask);
  };
  CHECK(with("0.4").find("below the surface of") != std::string::npos);
  CHECK(with("3.5").find("above the surface of") != std::string::npos);
  CHECK(with("0.86").find("P0505") == std::string::npos);
  CHECK(with("1.4").find("P0505") == std::string::npos);
  CHECK(with("3.5").find("starts.csv:2:") != std::string::npos);
}

TEST_CASE("heights keep things apart that stand over one another") {
  const std::string over = "start,object,x_m,y_m,z_m\n0,source,-0.16,0,1.1\n0,target,-0.16,0,0.9\n";
  const std::string within =
      "start,object,x_m,y_m,z_m\n0,source,-0.16,0,0.9\n0,target,-0.16,0,0.9\n";
  CHECK(said(over, kTask).find("P0501") == std::string::npos);
  CHECK(said(within, kTask).find("warning[P0501]") != std::string::npos);
  CHECK(said(within, std::string(kLayout) +
                         "@allow(overlap, \"recorded so\")\n"
                         "task t like on_table { layout given; source carrot; target plate }\n")
            .empty());
  // Without heights they would be dropped into one another.
  CHECK(said("start,object,x_m,y_m\n0,source,-0.16,0\n0,target,-0.16,0\n", kTask)
            .find("error[P0501]") != std::string::npos);
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

namespace {

// Drawers and a Panda: the task has the carrot alone.
const std::string kDrawer = std::string("use \"suite/kitchen.probe\"\n") + kLayout +
                            "task t like open_the_top_drawer { layout given }\n";

struct Begun {
  std::vector<double> joints, arm;
};
Begun begun(const plan::Plan& plan, const char* name, std::size_t episode) {
  const plan::TaskRecord& task = plan.tasks()[plan.find_task(name).value()];
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  const plan::EpisodeRecord& record = plan.episodes(task)[episode];
  const auto arm = plan.joints(scene, record);
  return {plan::joint_starts_of(plan.tables(), scene, record), {arm.begin(), arm.end()}};
}

}  // namespace

TEST_CASE("joints of fixtures and of the robot begin where a table says, start by start") {
  const std::string header = "start,object,x_m,y_m,value\n";
  const plan::Plan plan = plan_with(header +
                                        "0,carrot,-0.15,-0.11,\n"
                                        "0,cabinet.middle,,,0.04\n"
                                        "0,panda.joint1,,,0.125\n"
                                        "1,carrot,-0.15,-0.11,\n"
                                        "1,panda.joint1,,,-0.25\n"
                                        "1,cabinet.middle,,,0.08\n",
                                    kDrawer + "task u like t { start cabinet.middle 1cm }\n");
  const Begun first = begun(plan, "t", 0), second = begun(plan, "t", 1);
  REQUIRE(first.joints.size() == 5);  // three drawers and two knobs
  CHECK(first.joints[1] == 0.04);
  CHECK(second.joints[1] == 0.08);
  CHECK(first.joints[0] == 0);
  REQUIRE(first.arm.size() == 9);
  CHECK(first.arm[0] == 0.125);
  CHECK(second.arm[0] == -0.25);
  CHECK(first.arm[1] == -0.161037389);  // as the scene says
  CHECK(second.arm[8] == 0.020833);
  const plan::TaskRecord& task = plan.tasks()[plan.find_task("t").value()];
  CHECK(plan.episodes(task)[0].start_id != plan.episodes(task)[1].start_id);
  // What the task says comes before the table.
  CHECK(begun(plan, "u", 0).joints[1] == 0.01);
  CHECK(begun(plan, "u", 1).joints[1] == 0.01);
}

TEST_CASE("a fixture on a lower surface has a record of its own, and regions and parts of that") {
  const plan::Plan plan =
      plan_with("start,object,x_m,y_m\n0,source,-0.15,-0.11\n",
                "use \"suite/kitchen.probe\"\n"
                "scene low like counter { surface 85cm area (-42cm, -26cm) .. (26cm, 30cm) }\n"
                "metrics away { success = at end stowed(source, target) }\n"
                "task u like carrot_in_the_drawer { metrics away }\n"
                "variant t of u { scene low }\n");
  const auto cabinet_of = [&](const char* name) -> const plan::FixtureRecord& {
    const plan::TaskRecord& task = plan.tasks()[plan.find_task(name).value()];
    const auto& scene = plan.scenes()[task.scene];
    const std::uint32_t index = plan::slice_of(plan.tables().list, scene.fixtures)[0];
    return plan.fixtures()[index];
  };
  CHECK(plan.text(cabinet_of("t").name) == "cabinet");
  CHECK(plan.text(cabinet_of("u").name) == "cabinet");
  CHECK(cabinet_of("u").position[2] == 0.9);
  CHECK(cabinet_of("t").position[2] == doctest::Approx(0.85));
  CHECK(cabinet_of("t").parts.first != cabinet_of("u").parts.first);
  CHECK(plan.tasks()[plan.find_task("t").value()].axes == plan::bit(plan::Axis::kSceneGeometry));
}

TEST_CASE("a task whose table says other joints moves that axis alone") {
  const std::string place = "start,object,x_m,y_m,value\n0,carrot,-0.15,-0.11,\n";
  // The baseline's table has the same place, and the joints of `given`.
  const auto axes = [&](const std::string& rows, const std::string& given = "") {
    const plan::Plan plan = plan_with(place + rows,
                                      "use \"suite/kitchen.probe\"\n" + std::string(kLayout) +
                                          "layout placed like given { starts \"placed.csv\" }\n"
                                          "task u like open_the_top_drawer { layout placed }\n"
                                          "variant t of u { layout given }\n",
                                      place + given);
    return plan.tasks()[plan.find_task("t").value()].axes;
  };
  using plan::Axis;
  const std::string drawer = "0,cabinet.middle,,,0.04\n", arm = "0,panda.joint1,,,0.125\n";
  CHECK(axes(drawer) == plan::bit(Axis::kFixture));
  CHECK(axes(arm) == plan::bit(Axis::kRobot));
  CHECK(axes(drawer + arm) == (plan::bit(Axis::kFixture) | plan::bit(Axis::kRobot)));
  CHECK(axes(drawer + arm, drawer) == plan::bit(Axis::kRobot));
  CHECK(axes(drawer + arm, arm) == plan::bit(Axis::kFixture));
  CHECK(axes(arm, "0,panda.joint1,,,0.25\n") == plan::bit(Axis::kRobot));
  CHECK(axes("0,panda.joint2,,,0.125\n", arm) == plan::bit(Axis::kRobot));
  // A row that repeats the scene says nothing.
  const std::string repeated = "0,panda.joint2,,,-0.161037389\n";
  CHECK(axes(drawer + repeated) == plan::bit(Axis::kFixture));
  CHECK(axes(drawer + arm + repeated, arm) == plan::bit(Axis::kFixture));
}

TEST_CASE("a table with fewer things around moves them alone; with another place the layout, too") {
  const std::string around =
      "start,object,x_m,y_m\n0,source,-0.15,0.1\n0,plate,-0.15,-0.1\n0,spoon,-0.22,0\n";
  const auto axes = [&](const std::string& alone) {
    const plan::Plan plan = plan_with(around,
                                      std::string(kLayout) +
                                          "layout placed like given { starts \"placed.csv\" }\n"
                                          "task u like on_table { layout given; source carrot; "
                                          "target plate; distractors spoon }\n"
                                          "variant t of u { layout placed; distractors none }\n",
                                      alone);
    return plan.tasks()[plan.find_task("t").value()].axes;
  };
  using plan::Axis;
  CHECK(axes("start,object,x_m,y_m\n0,source,-0.15,0.1\n0,plate,-0.15,-0.1\n") ==
        plan::bit(Axis::kDistractors));
  CHECK(axes("start,object,x_m,y_m\n0,source,-0.15,0.12\n0,plate,-0.15,-0.1\n") ==
        (plan::bit(Axis::kDistractors) | plan::bit(Axis::kLayout)));
}

TEST_CASE("what stands amiss in a table is said of the first task that begins so") {
  const std::string table =
      "start,object,x_m,y_m,z_m\n0,carrot,-0.15,0.1,0.9\n0,plate,-0.15,0.1,0.89\n";
  const std::string text =
      said(table, kTask +
                      "variant u of t { say \"please put {source} on {target}\" }\n"
                      "light dim { ambient 0.1 }\nvariant v of t { light dim }\n");
  CAPTURE(text);
  const std::size_t first = text.find("warning[P0501]");
  REQUIRE(first != text.npos);
  CHECK(text.find("warning[P0501]", first + 1) == text.npos);
  CHECK(text.find("more task") == text.npos);
}

TEST_CASE("what is wrong with a joint's row is told at its cell") {
  const auto at = [](const std::string& row, const std::string& header) {
    return said(
        header + "\n0,carrot,-0.15,-0.11" + (header.ends_with("value") ? "," : "") + "\n" + row,
        kDrawer);
  };
  const auto with = [&](const std::string& row) { return at(row, "start,object,x_m,y_m,value"); };
  CHECK(with("0,cabinet.top,,,0.9\n").find("starts.csv:3:17") != std::string::npos);
  CHECK(with("0,cabinet.top,,,0.9\n").find("beyond its limits of") != std::string::npos);
  CHECK(with("0,cabinet.tpo,,,0.1\n").find("did you mean `top`?") != std::string::npos);
  CHECK(with("0,panda.joint8,,,0.1\n").find("did you mean `joint") != std::string::npos);
  CHECK(with("0,chest.top,,,0.1\n").find("error[P0201]") != std::string::npos);
  CHECK(with("0,microwave.hinge,,,0.1\n")
            .find("fixture `microwave` is not in scene `counter` of `t`") != std::string::npos);
  CHECK(with("0,widowx.waist,,,0.1\n").find("robot `widowx` is not in scene `counter` of `t`") !=
        std::string::npos);
  CHECK(with("0,cabinet.top,0.1,,0.1\n")
            .find("a joint has no place: expected nothing under `x_m`, found `0.1`") !=
        std::string::npos);
  CHECK(with("0,cabinet.top,,,\n").find("expected a number under `value`, found nothing") !=
        std::string::npos);
  CHECK(
      with("0,cabinet.top,,,0.1\n0,cabinet.top,,,0.1\n").find("start 0 has `cabinet.top` twice") !=
      std::string::npos);
  CHECK(with("0,cabinet.top,,,0.1\n1,carrot,-0.15,-0.11,\n").find("start 1 has no `cabinet.top`") !=
        std::string::npos);
  CHECK(with("0,plate,-0.1,0.1,0.1\n").find("an object has no joint value") != std::string::npos);
  CHECK(at("0,cabinet.top,,\n", "start,object,x_m,y_m").find("the table has no column `value`") !=
        std::string::npos);
  CHECK(said("start,object,x_m,y_m,value\n0,carrot,-0.15,-0.11,\n0,cabinet.top,,,0.1\n",
             "use \"suite/kitchen.probe\"\n"
             "layout given { starts \"starts.csv\"; drop 2cm settle 0.5s; start cabinet.top 3cm }\n"
             "task t like open_the_top_drawer { layout given }\n")
            .find("error[P1503]") != std::string::npos);
}

TEST_CASE("a drawer that begins elsewhere in each start is shown by where it begins in all") {
  const plan::Plan plan =
      plan_with("start,object,x_m,y_m,value\n0,cabinet.top,,,0.04\n1,cabinet.top,,,0.14\n",
                "use \"suite/kitchen.probe\"\n"
                "layout given { starts \"starts.csv\"; drop 2cm settle 0.5s }\n"
                "task t like open_the_top_drawer { layout given }\n");
  const std::uint32_t task = plan.find_task("t").value();
  const Json fixtures = inspect::fixtures_of(plan, task);
  const std::string text = inspect::joint_starts_text(fixtures).dump();
  CHECK_MESSAGE(text.find("cabinet.top 4 to 14 cm") != std::string::npos, text);
  CHECK(text.find("cabinet.bottom 0 cm") != std::string::npos);
  const std::string shown = inspect::describe_text(inspect::describe(plan, task));
  CHECK_MESSAGE(shown.find("start id  cabinet.top") != std::string::npos, shown);
  CHECK(shown.find("         14cm") != std::string::npos);
  const auto view = inspect::top_view(plan, task, (kRoot / "assets").string());
  REQUIRE(view.ok());
  const std::string svg = inspect::to_svg(*view);
  for (const char* drawn :
       {"<title>cabinet.top_drawer: starts 0<", "<title>cabinet.top_drawer: starts 1<",
        "<title>cabinet.bottom_drawer<", "<title>cabinet.inside_top: starts 0<",
        "<title>cabinet.inside_top: starts 1<", "<title>cabinet.inside_middle<"})
    CHECK_MESSAGE(svg.find(drawn) != std::string::npos, drawn);
}

TEST_CASE("a sentence that is over at once in some starts is told with them") {
  const std::string text = said(
      "start,object,x_m,y_m,value\n0,cabinet.top,,,0.13\n1,cabinet.top,,,0\n2,cabinet.top,,,0.14\n",
      "use \"suite/kitchen.probe\"\n"
      "layout given { starts \"starts.csv\"; drop 2cm settle 0.5s }\n"
      "task t like close_the_top_drawer { layout given; start none; say \"open {the target}\"\n"
      "  then say \"close {the target}\" when pulled(cabinet.top_drawer, 10cm) }\n");
  CHECK_MESSAGE(text.find("warning[P0607]: what brings the next sentence of `t` holds before "
                          "anything moves in 2 of 3 starts: 0, 2") != std::string::npos,
                text);
}

TEST_CASE(
    "what brings the third sentence is waited for when joints have moved; copies say nothing") {
  const std::string text = said(
      "start,object,x_m,y_m,value\n0,cabinet.top,,,0.13\n1,cabinet.top,,,0\n2,cabinet.top,,,0.14\n",
      "use \"suite/kitchen.probe\"\n"
      "layout given { starts \"starts.csv\"; drop 2cm settle 0.5s }\n"
      "task t like close_the_top_drawer { layout given; start none; say \"open {the target}\"\n"
      "  then say \"close {the target}\" when pulled(cabinet.top_drawer, 10cm)\n"
      "  then say \"open {the target}\" when closed(cabinet.top_drawer) }\n"
      "variant u of t { horizon 950 steps }\n");
  CHECK(text.find("in 1 of 3 starts") == std::string::npos);
  CHECK_MESSAGE(text.find("in 2 of 3 starts") == text.rfind("in 2 of 3 starts"), text);
}

TEST_CASE("where fixtures stand, what is far above or below all of them is told at its cell") {
  const auto with = [](const std::string& z) {
    return said("start,object,x_m,y_m,z_m\n0,carrot,-0.09,0.26," + z + "\n", kDrawer);
  };
  const std::string high = with("30");
  CHECK_MESSAGE(high.find("starts.csv:2:21") != std::string::npos, high);
  CHECK(high.find("above the surface and all that stands in") != std::string::npos);
  CHECK(with("0.4").find("below the surface and all that stands in") != std::string::npos);
  // Falls onto the cabinet.
  CHECK(with("2.6").find("P0505") == std::string::npos);
}

TEST_CASE("what stands in a drawer in one start alone is found there") {
  const std::string text = said(
      "start,object,x_m,y_m,z_m,value\n"
      "0,carrot,-0.09,0.26,1.08,\n0,cabinet.top,,,,0\n"
      "1,carrot,-0.09,0.26,1.08,\n1,cabinet.top,,,,0.1\n",
      kDrawer);
  CHECK(text.find("stands in `cabinet.top_drawer` in `t`: they overlap by") != std::string::npos);
  CHECK(text.find("so in 1 of 2 starts") != std::string::npos);
  CHECK(text.find("episode 1:") != std::string::npos);
}

TEST_CASE("what a table puts well above the surface is not asked to be taken from there") {
  const std::string text =
      "scene wide like table { surface 87cm area (-60cm, -30cm) .. (4cm, 30cm) }\n" +
      std::string(kLayout) +
      "task t like on_table { scene wide; layout given; source carrot; target plate }\n";
  const auto table = [](const char* height) {
    return std::string("start,object,x_m,y_m,z_m\n0,carrot,-0.42,0,") + height +
           "\n0,plate,-0.16,-0.075,0.90\n";
  };
  CHECK(said(table("0.90"), text).find("cannot grasp `carrot`") != std::string::npos);
  CHECK(said(table("1.37"), text).find("cannot grasp `carrot`") == std::string::npos);
}

TEST_CASE("a row of the distractors is that of a task's only one, and of none where it has none") {
  const std::string table =
      "start,object,x_m,y_m\n0,source,-0.2,0.075\n0,target,-0.16,-0.1\n0,distractors,-0.05,0.1\n";
  const std::string more = "variant u of t { distractors none }\n";
  const plan::Plan plan =
      plan_with(table, std::string(kLayout) +
                           "task t like on_table { layout given; source carrot; target plate; "
                           "distractors spoon }\n" +
                           more);
  const auto t = plan.find_task("t"), u = plan.find_task("u");
  REQUIRE((t && u));
  CHECK(plan.tasks()[*u].axes == plan::bit(plan::Axis::kDistractors));
  const auto placed = [&](std::uint32_t task) {
    return plan::slice_of(plan.tables().placements, plan.episodes(plan.tasks()[task])[0].placements)
        .size();
  };
  CHECK(placed(*t) == 3);
  CHECK(placed(*u) == 2);
  const std::string two =
      said(table, std::string(kLayout) +
                      "task t like on_table { layout given; source carrot; target plate; "
                      "distractors spoon, eggplant }\n");
  CHECK_MESSAGE(two.find("P1502") != std::string::npos, two);
}

TEST_CASE("what a table puts into a drawer may be taken out of it") {
  const std::string table = "start,object,x_m,y_m\n0,source,-0.2,0.1\n0,target,-0.16,-0.075\n";
  const auto told = [&](const std::string& words) {
    return said(table, "use \"suite/kitchen.probe\"\n" + std::string(kLayout) +
                           "task t like put_there { layout given; source carrot; target plate; "
                           "say \"take {the source} " +
                           words + " and put it on {the target}\" }\n");
  };
  CHECK(told("out of the top drawer") == "");
  CHECK(told("off {the target}").find("does not begin there") != std::string::npos);
}
