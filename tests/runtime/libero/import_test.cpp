// A small folder in the benchmark's form: what is written checks clean, says every start, and is
// the same bytes twice; what is missing is named.
#include "runtime/libero/import.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "compiler/diag/text.h"
#include "runtime/compile/files.h"
#include "runtime/plan/axes.h"
#include "runtime/plan/fixtures.h"
#include "runtime/plan/plan.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/skills.h"
#include "tests/hex.h"
#include "tests/runtime/libero/reference.h"
#include "tests/runtime/libero/small.h"
#include "tests/runtime/libero/small_folder.h"

namespace probe::libero {
namespace {

namespace fs = std::filesystem;

const char* const kTask = test::kSmallTask;
using LiberoFolder = test::SmallFolder;
using test::text_of;

// One grey pixel, PNG.
constexpr const char* kPixel =
    "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c494441"
    "54789c636898b00000034401b17ad736140000000049454e44ae426082";

// The kitchen's arena as the benchmark writes it, but for what stands in it.
void write_kitchen(const LiberoFolder& folder) {
  std::string table;
  for (const char* name :
       {"table_leg1_visual", "table_leg2_visual", "table_leg3_visual", "table_leg4_visual"})
    table += std::string(
                 "<geom type=\"cylinder\" size=\"0.05 0.1\" contype=\"0\" conaffinity=\"0\" "
                 "group=\"1\" name=\"") +
             name + "\"/>";
  folder.write("assets/scenes/libero_kitchen_tabletop_base_style.xml",
               R"(<mujoco model="arena"><asset>
      <texture name="texplane" type="2d" file="../textures/other.png"/>
      <texture name="tex-wall" type="2d" file="../textures/other.png"/>
      <material name="floorplane" texture="texplane" texrepeat="3 3" texuniform="true"/></asset>
      <worldbody><geom name="floor" type="plane" size="3 3 .125" material="floorplane" group="1"/>
      <body name="table" pos="0 0 0.4">
        <geom name="table_collision" type="box" size="0.4 0.4 0.4" group="0"/>
        <geom name="table_visual" type="box" size="0.4 0.4 0.4" contype="0" conaffinity="0" group="1"/>)" +
                   table + "</body></worldbody></mujoco>");
  const auto pixel = test::from_hex(kPixel);
  for (const char* name : {"gray_ceramic_tile", "yellow_linen_wall_texture"})
    folder.write(std::string("assets/textures/") + name + ".png",
                 {reinterpret_cast<const char*>(pixel.data()), pixel.size()});
}

std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      files[fs::relative(entry.path(), folder).string()] = text_of(entry.path());
  }
  return files;
}

std::string said_by(const ImportReport& report, std::string_view word) {
  std::string all;
  for (const ImportLine& line : report.lines) {
    if (line.word == word) all += line.text + "\n";
  }
  return all;
}

Compilation compiled(const fs::path& folder, const std::string& file) {
  compile::FilesRequest request;
  request.assets = folder.string();
  auto made = compile::compile_files({(folder / file).string()}, request);
  REQUIRE_MESSAGE(made.ok(), to_text(made.failure()));
  return std::move(made).value();
}

}  // namespace

TEST_CASE("a scene has its room where the arena is there, and a line where it is not") {
  const LiberoFolder folder;
  const auto bare = folder.import();
  REQUIRE_MESSAGE(bare.ok(), to_text(bare.failure()));
  CHECK(said_by(*bare, "missing").find("libero_kitchen has no room") != std::string::npos);
  CHECK(said_by(*bare, "missing").find("robots/panda/robot.xml: vlaprobe's own meshes") !=
        std::string::npos);
  CHECK(text_of(folder.root / "out/libero_90.probe").find("_room") == std::string::npos);
  write_kitchen(folder);
  const auto report = folder.import();
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  CHECK(said_by(*report, "room") ==
        "libero_kitchen: assets/scenes/libero_kitchen_tabletop_base_style.xml\n");
  CHECK(said_by(*report, "missing").find("no room") == std::string::npos);
  CHECK(text_of(folder.root / "out/things.probe")
            .find("scene libero_kitchen_room like libero_kitchen {") != std::string::npos);
  CHECK(text_of(folder.root / "out/libero_90.probe").find("like libero_kitchen_room") !=
        std::string::npos);
  const std::string seen = text_of(folder.root / "out/scenes/libero_kitchen/visual.glb");
  CHECK(seen.starts_with("glTF"));
  const Compilation built = compiled(folder.root / "out", "libero_90.probe");
  INFO(render_text(built.diagnostics, built.sources));
  CHECK(built.ok);
}

TEST_CASE("a task is imported: its words, its goal, where things begin") {
  const LiberoFolder folder;
  const auto report = folder.import();
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  CHECK(report->tasks == 1);
  CHECK(report->starts == 2);
  CHECK(said_by(*report, "suite") == "libero_90: 1 tasks, 2 starts\n");
  CHECK(
      said_by(*report, "odd").find("libero_90 has 1 tasks, the released one 90: another version") !=
      std::string::npos);
  for (const char* const what : {"problems", "stored starts"}) {
    CHECK(said_by(*report, "odd").find("libero_90: the " + std::string(what) +
                                       " of 1 of 1 tasks are not the released ones") !=
          std::string::npos);
  }
  CHECK(said_by(*report, "odd").find("robosuite is not version 1.4.1 (base.xml): the arm is") !=
        std::string::npos);
  CHECK(said_by(*report, "missing").find("libero_goal: no task") != std::string::npos);
  CHECK(said_by(*report, "missing").find("probing.probe, which asks all 130 tasks: 1 are there") !=
        std::string::npos);
  const std::string text = text_of(folder.root / "out/libero_90.probe");
  CAPTURE(text);
  CHECK(text.find("say \"fill the drawer and close it\"") != std::string::npos);
  CHECK(text.find("metrics libero_90_00 like handling_one {") != std::string::npos);
  CHECK(text.find("in_site(source, target)") != std::string::npos);
  CHECK(text.find("  source cup_1; target chest_1.drawer; distractors cup_2, lid_1\n") !=
        std::string::npos);
  CHECK(text.find("solution { put source in target; close chest_1.drawer_part }") !=
        std::string::npos);
  CHECK(text.find("drawer_closed(chest_1.drawer_part)") != std::string::npos);
  CHECK(text.find("fixture chest_1 like chest { at (21cm, -29cm, 92cm) yaw 180deg }") !=
        std::string::npos);

  const Compilation built = compiled(folder.root / "out", "libero_90.probe");
  INFO(render_text(built.diagnostics, built.sources));
  CHECK(built.diagnostics.items().empty());
  REQUIRE(built.ok);
  const auto plan = plan::Plan::from_bytes(built.plan);
  REQUIRE(plan.ok());
  REQUIRE(plan->tasks().size() == 1);
  const plan::TaskRecord& task = plan->tasks()[0];
  CHECK(plan->text(task.prompt) == "fill the drawer and close it");
  CHECK(task.horizon == 400);
  CHECK(task.idle == 10);
  const auto episodes = plan->episodes(task);
  REQUIRE(episodes.size() == 2);
  const auto placed = plan->placements(episodes[0]);
  REQUIRE(placed.size() == 3);
  CHECK(plan::roles_of(plan->tables(), task).has_source());
  CHECK(plan::skills_of(plan->tables(), 0).size() == 2);
  CHECK(plan->text(plan->objects()[placed[0].object].name) == "cup_1");
  CHECK(placed[0].position == std::array<double, 3>{-0.07, 0.03, 0.97});
  CHECK(placed[0].rotation == std::array<double, 4>{0.6, 0, 0, 0.8});
  const plan::SceneRecord& scene = plan->scenes()[task.scene];
  CHECK(plan::joint_starts_of(plan->tables(), scene, episodes[0]) == std::vector<double>{-0.15});
  CHECK(plan::joint_starts_of(plan->tables(), scene, episodes[1]) == std::vector<double>{-0.145});
  const auto arm = plan->joints(scene, episodes[0]);
  REQUIRE(arm.size() == 9);
  CHECK(arm[0] == 0.035773);
  CHECK(arm[8] == 0.020833);
}

TEST_CASE("the same folder gives the same bytes") {
  const LiberoFolder folder;
  REQUIRE(folder.import("one").ok());
  REQUIRE(folder.import("two").ok());
  const auto one = files_in(folder.root / "one");
  CHECK(one == files_in(folder.root / "two"));
  CHECK(one.contains("starts/libero_90_00.csv"));
  CHECK(one.contains("things.probe"));
}

TEST_CASE("what a task needs and does not have leaves it out, by name") {
  const LiberoFolder folder;
  folder.write("bddl_files/libero_90/KITCHEN_SCENE2_b.bddl", "(define (problem x)\n  (:goals))");
  folder.write("bddl_files/libero_90/KITCHEN_SCENE3_c.bddl", test::kSmallProblem);
  auto report = folder.import();
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  CHECK(report->tasks == 1);
  const std::string missing = said_by(*report, "missing");
  CAPTURE(missing);
  CHECK(
      missing.find("KITCHEN_SCENE2_b is left out: bddl_files/libero_90/KITCHEN_SCENE2_b.bddl:2:3: "
                   "unknown section `:goals`, did you mean `:goal`?") != std::string::npos);
  CHECK(missing.find("KITCHEN_SCENE3_c is left out: "
                     "init_files/libero_90/KITCHEN_SCENE3_c.pruned_init") != std::string::npos);
  fs::remove_all(folder.root / "assets/turbosquid_objects/lid");
  report = folder.import();
  REQUIRE_FALSE(report.ok());
  CHECK(report.failure().message.find("no task can be read") == 0);
  CHECK_FALSE(fs::exists(folder.root / "out"));
}

TEST_CASE("a folder that is none is refused with what is not there") {
  const LiberoFolder folder;
  fs::remove(folder.root / "robosuite/base.xml");
  CHECK(folder.import().failure().message.find("no robosuite: there is no") == 0);
  fs::remove_all(folder.root / "assets");
  CHECK(folder.import().failure().message == "there is no `assets` beside `bddl_files`");
  fs::remove_all(folder.root / "bddl_files");
  CHECK(folder.import().failure().message == "no LIBERO folder: there is no `bddl_files`");
}

TEST_CASE("a folder that is only read is not written into, and nothing stays of what was refused") {
  const LiberoFolder folder;
  ImportOptions options;
  options.from = folder.root.string();
  options.robosuite = (folder.root / "robosuite").string();
  options.own = VLAPROBE_SOURCE_DIR "/assets";
  for (const char* inside : {"bddl_files/out", "init_files/libero_90/out", "assets/out",
                             "robosuite/out", "bddl_files/../assets/out"}) {
    CAPTURE(inside);
    options.to = (folder.root / inside).string();
    const auto before = files_in(folder.root);
    const auto refused = import_libero(options);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.failure().message.find("which is only read") != std::string::npos);
    CHECK(files_in(folder.root) == before);
  }
}

TEST_CASE("what an import left that was killed is removed by the next one, another's is not") {
  const LiberoFolder folder;
  const pid_t dead = fork();
  if (dead == 0) _exit(0);
  REQUIRE(waitpid(dead, nullptr, 0) == dead);
  const std::string left = "out.tmp" + std::to_string(dead) + "/things.probe";
  const std::string living = "out.tmp" + std::to_string(getppid()) + "/things.probe";
  std::array<char, 256> here{};
  REQUIRE(gethostname(here.data(), here.size() - 1) == 0);
  const auto marked = [&](const std::string& path, const std::string& machine) {
    folder.write(path, "half");
    folder.write((fs::path(path).parent_path() / ".vlaprobe_writes").string(), machine + "\n");
  };
  marked(left, here.data());
  marked(living, here.data());
  folder.write("out.tmpl/mine", "kept");
  REQUIRE(folder.import().ok());
  CHECK_FALSE(fs::exists((folder.root / left).parent_path()));
  CHECK(fs::exists(folder.root / living));
  CHECK(fs::exists(folder.root / "out.tmpl/mine"));
  CHECK_FALSE(fs::exists(folder.root / "out/.vlaprobe_writes"));
  // A process of another machine on the same disk, and a folder that no import made.
  marked(left, "another-" + std::string(here.data()));
  REQUIRE(folder.import().ok());
  CHECK(fs::exists(folder.root / left));
  fs::remove((folder.root / left).parent_path() / ".vlaprobe_writes");
  REQUIRE(folder.import().ok());
  CHECK(fs::exists(folder.root / left));
}

TEST_CASE("two imports into one folder: one of them is whole, the other is told") {
  const LiberoFolder folder;
  ImportOptions options;
  options.from = folder.root.string();
  options.robosuite = (folder.root / "robosuite").string();
  options.own = VLAPROBE_SOURCE_DIR "/assets";
  options.to = (folder.root / "both").string();
  const pid_t other = fork();
  if (other == 0) {
    const auto made = import_libero(options);
    _exit(made.ok() ? 0 : made.failure().code == Fault::kIo ? 1 : 2);
  }
  const auto here = import_libero(options);
  int status = 0;
  REQUIRE(waitpid(other, &status, 0) == other);
  REQUIRE(WIFEXITED(status));
  const int there = WEXITSTATUS(status);
  // One after the other, or at once: never both, never half a folder.
  CHECK(there <= 1);
  CHECK((here.ok() ? 1 : 0) + (there == 0 ? 1 : 0) == 1);
  if (!here.ok()) CHECK(here.failure().code == Fault::kIo);
  REQUIRE(folder.import("alone").ok());
  CHECK(files_in(folder.root / "both") == files_in(folder.root / "alone"));
  for (const auto& entry : fs::directory_iterator(folder.root))
    CHECK(entry.path().filename().string().find(".tmp") == std::string::npos);
}

TEST_CASE(
    "where fixtures stand can be said in a table, and what is wrong in it is told by its line") {
  const LiberoFolder folder;
  ImportOptions options;
  options.from = folder.root.string();
  options.robosuite = (folder.root / "robosuite").string();
  options.own = VLAPROBE_SOURCE_DIR "/assets";
  options.to = (folder.root / "posed").string();
  options.poses = (folder.root / "poses.csv").string();
  const std::string header = "suite,task,fixture,x_m,y_m,z_m,qw,qx,qy,qz\n";
  const std::string place = "libero_90," + std::string(kTask) + ",chest_1,";
  folder.write("poses.csv", header + place + "0.215,-0.285,0.92,0,0,0,1\n");
  const auto report = import_libero(options);
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  CHECK(text_of(folder.root / "posed/libero_90.probe")
            .find("fixture chest_1 like chest { at (21.5cm, -28.5cm, 92cm) yaw 180deg }") !=
        std::string::npos);
  CHECK(said_by(*report, "odd").find("where fixtures stand") == std::string::npos);
  const auto refused = [&](const std::string& text) {
    folder.write("poses.csv", text);
    fs::remove_all(folder.root / "posed");
    const auto made = import_libero(options);
    return made.ok() ? std::string() : to_text(made.failure());
  };
  CHECK(refused("suite,task\n").find("poses.csv:1: expected the header") != std::string::npos);
  CHECK(refused(header + place + "1,2\n").find("poses.csv:2: expected 10 cells, found 5") !=
        std::string::npos);
  CHECK(refused(header + place + "1,2,x,1,0,0,0\n")
            .find("poses.csv:2: expected a number, found "
                  "`x`") != std::string::npos);
  CHECK(refused(header + place + "1,2,3,1,1,0,0\n").find("poses.csv:2: a quaternion") !=
        std::string::npos);
  CHECK(refused(header + place + "0.2,-0.3,0.92,0.8,0.6,0,0\n").find("is tilted") !=
        std::string::npos);
  // What is of nothing here would be left out silently, and the fixture stand elsewhere.
  const std::string pose = "0.215,-0.285,0.92,0,0,0,1\n";
  CHECK(refused(header + "libero_gaol," + kTask + ",chest_1," + pose)
            .find("poses.csv:2: there is no suite `libero_gaol`") != std::string::npos);
  CHECK(refused(header + "libero_90,put_it_away,chest_1," + pose)
            .find("poses.csv:2: `libero_90` has no task `put_it_away`") != std::string::npos);
  CHECK(refused(header + "libero_90," + kTask + ",chest_9," + pose)
            .find("poses.csv:2: the task has no fixture `chest_9`") != std::string::npos);
  CHECK(refused(header + place + pose + place + pose).find("poses.csv:3: says once more") !=
        std::string::npos);
}

TEST_CASE("a disk that is full is told with the file, and nothing stays") {
  const LiberoFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    // No file may be larger than this: writing fails as on a full disk.
    const rlimit small{4096, 4096};
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    const auto made = folder.import("full");
    const bool is_told = !made.ok() && made.failure().code == Fault::kIo &&
                         made.failure().message == "cannot write the file" &&
                         made.failure().where.find("full.tmp") != std::string::npos;
    _exit(is_told ? 0 : 1);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  for (const auto& entry : fs::directory_iterator(folder.root))
    CHECK(entry.path().filename().string().find("full") == std::string::npos);
}

TEST_CASE("damaged meshes leave their things out, by name") {
  const LiberoFolder folder;
  const std::string model =
      "<mujoco model=\"cup\"><asset><mesh name=\"m\" file=\"cup.msh\"/></asset><worldbody><body>"
      "<body name=\"object\"><geom type=\"mesh\" mesh=\"m\" group=\"1\" contype=\"0\" "
      "conaffinity=\"0\"/><geom type=\"box\" size=\"0.03 0.03 0.04\" group=\"0\" "
      "density=\"100\"/></body><site name=\"bottom_site\" pos=\"0 0 -0.06\" size=\"0.005\"/>"
      "</body></worldbody></mujoco>";
  folder.write("assets/stable_scanned_objects/cup/cup.xml", model);
  const auto said = [&](std::string_view bytes) {
    folder.write("assets/stable_scanned_objects/cup/cup.msh", bytes);
    const auto made = folder.import();
    REQUIRE_FALSE(made.ok());
    return made.failure().message;
  };
  using namespace std::string_view_literals;
  for (const std::string_view bytes : {""sv, "\3\0\0"sv, "\3\0\0\0\0\0\0\0\0\0\0\0\1\0\0\0"sv,
                                       "\xff\xff\xff\x7f\0\0\0\0\0\0\0\0\xff\xff\xff\x7f"sv,
                                       "\xff\xff\xff\xff\0\0\0\0\0\0\0\0\1\0\0\0"sv}) {
    CAPTURE(bytes.size());
    const std::string message = said(bytes);
    CAPTURE(message);
    CHECK(message.find("no task can be read: cup: ") == 0);
    CHECK(message.find("cup.msh") != std::string::npos);
  }
  CHECK_FALSE(fs::exists(folder.root / "out"));
}

TEST_CASE("the reference: 130 tasks, 6,500 starts, nothing left to say by a check") {
  if (!test::has_reference()) {
    MESSAGE("skipped: no ../shared/reference/libero");
    return;
  }
  const fs::path to =
      fs::temp_directory_path() / ("vlaprobe_libero_all_" + std::to_string(getpid()));
  fs::remove_all(to);
  ImportOptions options;
  options.from = test::reference();
  options.to = to.string();
  options.own = VLAPROBE_SOURCE_DIR "/assets";
  const auto report = import_libero(options);
  REQUIRE_MESSAGE(report.ok(), to_text(report.failure()));
  CHECK(report->tasks == 130);
  CHECK(report->starts == 6500);
  CHECK(said_by(*report, "odd").find("released ones") == std::string::npos);
  CHECK(said_by(*report, "odd").find("robosuite") == std::string::npos);
  for (const char* const suite :
       {"libero_spatial", "libero_object", "libero_goal", "libero_10", "libero_90"}) {
    const Compilation built = compiled(to, std::string(suite) + ".probe");
    CAPTURE(suite);
    CHECK_MESSAGE(built.diagnostics.items().empty(),
                  render_text(built.diagnostics, built.sources).substr(0, 2000));
  }
  // All of them, asked properly: every diagnostic is mended or allowed.
  const Compilation asked = compiled(to, "probing.probe");
  CHECK_MESSAGE(asked.diagnostics.items().empty(),
                render_text(asked.diagnostics, asked.sources).substr(0, 2000));
  const auto plan = plan::Plan::from_bytes(asked.plan);
  REQUIRE(plan.ok());
  std::map<std::string_view, int> moved;  // by axis
  int crowded = 0;                        // where there is room for more
  for (const plan::TaskRecord& task : plan->tasks()) {
    if (task.baseline == plan::kNone) continue;
    const auto names = plan::axis_names(task.axes);
    // Where the released words say which by a place, the proved phrase is other words as well.
    if (names.size() > 1) CHECK(plan->text(task.name).find("_where_") != std::string_view::npos);
    for (const std::string_view name : names) ++moved[name];
    if (!plan->text(task.name).ends_with("_crowded")) continue;
    CHECK(task.axes == plan::bit(plan::Axis::kDistractors));
    ++crowded;
  }
  CHECK(crowded > 40);
  for (const char* const axis :
       {"language.action", "language.paraphrase", "language.appearance", "language.commonsense",
        "language.spatial", "language.negation", "object.source", "distractors", "layout", "light",
        "camera", "sensor", "robot", "latency", "scene"}) {
    CHECK_MESSAGE(moved[axis] > 20, axis, " ", moved[axis]);
  }
  CHECK(plan->tasks().size() > 3000);
  // The repaired ones differ from the released in what is judged alone.
  const Compilation repaired = compiled(to, "clean.probe");
  CHECK_MESSAGE(repaired.diagnostics.items().empty(),
                render_text(repaired.diagnostics, repaired.sources).substr(0, 2000));
  const auto clean = plan::Plan::from_bytes(repaired.plan);
  REQUIRE(clean.ok());
  std::size_t mended = 0;
  for (const plan::TaskRecord& task : clean->tasks()) {
    if (task.baseline == plan::kNone) continue;
    CHECK(task.axes == plan::bit(plan::Axis::kGoal));
    ++mended;
  }
  CHECK(mended == 127);  // all but those that turn a knob on
  fs::remove_all(to);
}

}  // namespace probe::libero
