#include "compiler/emit/compile.h"

#include <doctest/doctest.h>

#include <cstring>

#include "runtime/plan/plan.h"
#include "tests/compiler/small_suite.h"

using namespace probe;
namespace fs = std::filesystem;

namespace {

// A folder of its own for one test.
struct Folder {
  fs::path path;
  explicit Folder(const std::string& name)
      : path(fs::temp_directory_path() /
             ("probe_compile_" + std::to_string(getpid()) + "_" + name)) {
    fs::create_directories(path);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  std::string write(const std::string& name, const std::string& text) const {
    test::write_text(path / name, text);
    return (path / name).string();
  }
};

const std::string kVariants = R"(
variants of red_on_tray { take_it { say take }
 new { source blue } }
set worded = tasks where uses action
suite one trained on lab { tasks { red_on_tray }; prefix "lab_"; seeds 42, 7; expect 1 tasks, 24 episodes }
suite all trained on lab { tasks tasks; seeds 1 }
)";

Compilation build_ok(const std::string& file, const std::string& suite = "") {
  auto result = build(std::span<const std::string>(&file, 1), {test::asset_root(), suite});
  REQUIRE_MESSAGE(result.ok(), to_text(result.failure()));
  Compilation compilation = std::move(result).value();
  REQUIRE_MESSAGE(compilation.ok, render_text(compilation.diagnostics, compilation.sources));
  REQUIRE_FALSE(compilation.plan.empty());
  return compilation;
}

std::string codes(const std::string& text, const std::string& root = test::asset_root()) {
  const Folder folder("codes");
  const std::string file = folder.write("x.probe", text);
  const auto result = build(std::span<const std::string>(&file, 1), {root, ""});
  REQUIRE(result.ok());
  std::string said;
  for (const Diagnostic& item : result->diagnostics.items())
    said += std::string(info(item.code).text) + " ";
  CHECK(result->plan.empty() == !result->ok);
  return said;
}

}  // namespace

TEST_CASE("a plan holds what the text says") {
  const Folder folder("plan");
  const Compilation compilation = build_ok(folder.write("x.probe", test::kSmallSuite + kVariants));
  const auto plan = plan::Plan::from_bytes(compilation.plan);
  REQUIRE_MESSAGE(plan.ok(), to_text(plan.failure()));
  REQUIRE(plan->tasks().size() == 3);
  const plan::TaskRecord& task = plan->tasks()[0];
  CHECK(plan->text(task.name) == "red_on_tray");
  CHECK(plan->text(task.prompt) == "put red block on the tray");
  CHECK(task.horizon == 60);
  CHECK(task.bodies.count == 7);
  CHECK(task.baseline == plan::kNone);
  CHECK(plan->tasks()[1].axes == static_cast<std::uint32_t>(plan::Axis::kLanguageAction));
  CHECK(plan->tasks()[2].ood == 4);
  CHECK(plan->episodes().size() == 72);
  CHECK(plan->programs().size() == 1);
  REQUIRE(plan->suites().size() == 2);
  CHECK(plan->text(plan->suites()[0].prefix) == "lab_");
  CHECK(plan->suites()[0].seeds.count == 2);
  CHECK(plan->sets()[0].members.count == 1);
  CHECK(plan->scenes()[0].base_position == std::array<double, 3>{0.5, 0, 0.8});
  CHECK(plan->scenes()[0].base_rotation == std::array<double, 4>{0, 0, 0, 1});
  CHECK(plan->robots()[0].finger_friction == 2);
  const auto& placement = plan->tables().placements[plan->episodes()[0].placements.first];
  CHECK(placement.position == std::array<double, 3>{-0.1, -0.1, 0.8 + 0.1});
}

TEST_CASE("a variant that changes only words shares every start and the judge with its baseline") {
  const Folder folder("language");
  const Compilation compilation = build_ok(folder.write("x.probe", test::kSmallSuite + kVariants));
  const auto plan = plan::Plan::from_bytes(compilation.plan);
  REQUIRE(plan.ok());
  CHECK(plan->tasks()[1].judge_id == plan->tasks()[0].judge_id);
  for (std::size_t e = 0; e < 24; ++e) {
    CHECK(plan->episodes()[24 + e].start_id == plan->episodes()[e].start_id);
    CHECK(plan->episodes()[24 + e].episode_id != plan->episodes()[e].episode_id);
  }
  CHECK(plan->tables().placements.size() == 2 * 48);
}

TEST_CASE("the same text gives the same bytes twice and from any folder") {
  const Folder here("here"), there("there/deeper");
  const std::string used = std::string(test::kSmallSuite);
  const std::string root = "use \"parts/world.probe\"\n" + kVariants;
  here.write("parts/world.probe", used);
  there.write("parts/world.probe", used);
  const Compilation a = build_ok(here.write("x.probe", root));
  const Compilation b = build_ok(here.write("x.probe", root));
  const Compilation c = build_ok(there.write("x.probe", root));
  CHECK(a.plan == b.plan);
  CHECK(a.plan == c.plan);
  const fs::path before = fs::current_path();
  fs::current_path(here.path);
  const Compilation d = build_ok("x.probe");
  const Compilation e = build_ok("./parts/../x.probe");
  fs::current_path(before);
  CHECK(a.plan == d.plan);
  CHECK(a.plan == e.plan);
  const auto plan = plan::Plan::from_bytes(a.plan);
  REQUIRE(plan.ok());
  CHECK(plan->tables().path(plan->texts()[0]) == "parts/world.probe");
  CHECK(plan->tables().path(plan->texts()[1]) == "x.probe");
}

TEST_CASE("one suite keeps its tasks and the baselines they are compared with") {
  const Folder folder("suite");
  const std::string file = folder.write(
      "x.probe", test::kSmallSuite + kVariants + "suite late { tasks { new }; seeds 1 }\n");
  const auto one = plan::Plan::from_bytes(build_ok(file, "one").plan);
  REQUIRE(one.ok());
  CHECK(one->tasks().size() == 1);
  CHECK(one->suites().size() == 1);
  const auto late = plan::Plan::from_bytes(build_ok(file, "late").plan);
  REQUIRE(late.ok());
  CHECK(late->tasks().size() == 2);
  CHECK(late->tasks()[1].baseline == 0);
  CHECK(late->suites()[0].members.count == 1);
  const auto unknown = build(std::span<const std::string>(&file, 1), {test::asset_root(), "lat"});
  REQUIRE_FALSE(unknown.ok());
  CHECK(to_text(unknown.failure()) == "unknown suite `lat`, did you mean `late`?");
}

TEST_CASE("a missing asset is reported at its name in the text, once") {
  const Folder assets("assets");
  fs::copy(test::asset_root(), assets.path,
           fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  fs::remove(assets.path / "objects/tray/visual.glb");
  CHECK(codes(test::kSmallSuite + kVariants, assets.path.string()) == "P0202 ");
  fs::remove(assets.path / "arm/part.obj");
  CHECK(codes(test::kSmallSuite + kVariants, assets.path.string()) == "P0202 P0202 ");
  CHECK(codes(test::kSmallSuite +
              std::string(
                  "object o like red { mesh \"../x\" }\ntask t like red_on_tray { source o }")) ==
        "P0202 ");
}

TEST_CASE("a check says the same as a build and writes nothing") {
  const Folder folder("check");
  const std::string file = folder.write(
      "x.probe", test::kSmallSuite + std::string("variant v of red_on_tray { source bleu }"));
  const auto result = check(std::span<const std::string>(&file, 1), {test::asset_root(), ""});
  REQUIRE(result.ok());
  CHECK_FALSE(result->ok);
  CHECK(result->plan.empty());
  CHECK(result->diagnostics.size() == 1);
}

TEST_CASE("a file that is not there is a failure of the outside that names it") {
  const std::string file = "/nowhere/x.probe";
  const auto result = check(std::span<const std::string>(&file, 1), {test::asset_root(), ""});
  REQUIRE_FALSE(result.ok());
  CHECK(to_text(result.failure()).find("/nowhere/x.probe") != std::string::npos);
}

TEST_CASE("files that two roots share are read once") {
  const Folder folder("roots");
  folder.write("world.probe", test::kSmallSuite);
  const std::string files[] = {
      folder.write("a.probe", "use \"world.probe\"\nvariant va of red_on_tray { source blue }"),
      folder.write("b.probe", "use \"world.probe\"\nvariant vb of red_on_tray { say take }")};
  const auto result = build(files, {test::asset_root(), ""});
  REQUIRE(result.ok());
  REQUIRE_MESSAGE(result->ok, render_text(result->diagnostics, result->sources));
  const auto plan = plan::Plan::from_bytes(result->plan);
  REQUIRE(plan.ok());
  CHECK(plan->tasks().size() == 3);
  CHECK(plan->texts().size() == 3);
}

TEST_CASE(
    "two programs checked in one command may declare the same names, and what they share is said "
    "once") {
  const Folder folder("programs");
  folder.write("base.probe", test::kSmallSuite);
  const std::string text = "use \"base.probe\"\nvariant mine of red_on_tray { say no_such }\n";
  const std::vector<std::string> files = {folder.write("one.probe", text),
                                          folder.write("two.probe", text),
                                          (folder.path / "base.probe").string()};
  const auto checked = check(files, {test::asset_root(), ""});
  REQUIRE(checked.ok());
  REQUIRE(checked->diagnostics.size() == 2);
  CHECK(info(checked->diagnostics.items()[0].code).text ==
        info(checked->diagnostics.items()[1].code).text);
  CHECK(checked->diagnostics.items()[0].primary.file !=
        checked->diagnostics.items()[1].primary.file);
}

TEST_CASE("a file that uses another does not change the suites of that other") {
  const Folder folder("grows");
  folder.write("base.probe", std::string(test::kSmallSuite) + R"(
variant worded of red_on_tray { say take }
suite mine trained on lab { tasks { red_on_tray } | variants of { red_on_tray }; seeds 42; expect 2 tasks, 48 episodes }
)");
  const std::string more = folder.write("more.probe", R"(use "base.probe"
variant other of red_on_tray { source blue }
suite all trained on lab { tasks variants of { red_on_tray }; seeds 42; expect 2 tasks, 48 episodes }
)");
  const auto built = build_ok(more);
  const auto plan = plan::Plan::from_bytes(built.plan);
  REQUIRE(plan.ok());
  CHECK(plan->tasks().size() == 3);
}

TEST_CASE("a backdrop's photo is of the surface of the scene that names it") {
  const Folder assets("photos");
  fs::copy(test::asset_root(), assets.path, fs::copy_options::recursive);
  test::write_text(assets.path / "scenes/wall/photo.png", "photo");
  const std::string scenes =
      "scene pictured like bench { backdrop \"wall\" }\n"
      "scene low like pictured { surface 72cm area (-50cm, -50cm) .. (50cm, 50cm)";
  const std::string task = " }\nvariant low_one of red_on_tray { scene low }\n";
  const std::string small = test::kSmallSuite;
  CHECK(codes(small + scenes + task, assets.path.string()) == "P0304 ");
  CHECK(codes(small + scenes + "; backdrop \"wall\"" + task, assets.path.string()) == "");
}

TEST_CASE("what the verifier would refuse is said of its place in the text, by check as by build") {
  const std::string small = test::kSmallSuite;
  const auto refused = [&](const std::string& more) {
    const Folder folder("refused");
    const std::string file = folder.write("x.probe", small + more);
    const auto checked = check(std::span<const std::string>(&file, 1), {test::asset_root(), ""});
    REQUIRE(checked.ok());
    std::string said;
    for (const Diagnostic& item : checked->diagnostics.items()) {
      CHECK_FALSE(item.primary.is_none());
      said += std::string(info(item.code).text) + " ";
    }
    CHECK(codes(small + more) == said);
    return said;
  };
  CHECK(refused("variant v of red_on_tray { say \"put {source}\\non {target}\" }") == "P0406 ");
  CHECK(refused("object o like red { name \"a\\nb\" }") == "P0304 ");
  CHECK(refused("object o like red { phrase p appearance \"a\\nb\" means color red }") == "P0304 ");
  CHECK(refused("suite s { tasks tasks; seeds 1; prefix \"a\\n\" }") == "P0304 ");
  CHECK(refused(
            "@allow(confounded, \"a\\nb\")\nvariant v of red_on_tray { light night; say take }") ==
        "P0304 ");
  const std::string longer(4097, 'x');
  CHECK(refused("suite s { tasks tasks; seeds 1; prefix \"" + longer + "\" }") == "P0304 ");
  const std::string name(256, 'x');
  CHECK(refused("set " + name + " = tasks") == "P0304 ");
  CHECK(refused("variant " + name + " of red_on_tray { light night }") == "P0304 ");
  CHECK(refused("derive \"" + name.substr(11) + "{t}\" for t in { red_on_tray } { light night }") ==
        "P0304 ");
  CHECK(codes(small + "set " + name.substr(1) + " = tasks") == "");
  std::string suns, metrics;
  for (int i = 0; i < 65; ++i) suns += "; sun (0, 0, -1) power 1";
  for (int i = 0; i < 256; ++i) metrics += "m" + std::to_string(i) + " = max height(source)\n";
  CHECK(refused("light l { ambient 0.1" + suns + " }\nvariant v of red_on_tray { light l }") ==
        "P0304 ");
  CHECK(refused("metrics many like plain { " + metrics +
                " }\ntask t like red_on_tray { metrics many }") == "P0304 ");
  CHECK(refused("task t like red_on_tray { horizon 100001 steps }") == "P0304 ");
  std::string product = "90000000000000";
  for (int i = 0; i < 24; ++i) product += " * 90000000000000";
  CHECK(refused("metrics m like plain { a = final step * (" + product +
                ") }\ntask t like red_on_tray { metrics m }") == "P0601 ");
  CHECK(refused("robot other { urdf \"arm/arm.urdf\"; tcp tool; control ee_delta_pose 5Hz\n"
                "fingers left opens +y, right opens -y\n"
                "drive waist stiffness 100Nm/rad damping 10Nms/rad limit 20Nm\n"
                "drive l, r stiffness 1000N/m damping 200Ns/m limit 60N\n"
                "grip 1cm .. 4cm friction 2 patch -1cm }") == "P0304 ");
}

TEST_CASE("a path that the verifier would refuse is missed at its place, by check as by build") {
  const auto refused = [&](const std::string& mesh) {
    const Folder folder("paths");
    const std::string file = folder.write(
        "x.probe", test::kSmallSuite + ("object o like red { mesh \"" + mesh +
                                        "\" }\nvariant v of red_on_tray { source o }"));
    const auto checked = check(std::span<const std::string>(&file, 1), {test::asset_root(), ""});
    REQUIRE(checked.ok());
    std::string said;
    for (const Diagnostic& item : checked->diagnostics.items()) {
      CHECK_FALSE(item.primary.is_none());
      said += item.message + "\n";
    }
    const auto built = build(std::span<const std::string>(&file, 1), {test::asset_root(), ""});
    REQUIRE(built.ok());
    CHECK_FALSE(built->ok);
    return said;
  };
  for (const std::string mesh : {"../objects/block", "./block", "block/"}) {
    CAPTURE(mesh);
    const std::string said = refused(mesh);
    CHECK_MESSAGE(said.find("is not written straight") != std::string::npos, said);
  }
}

TEST_CASE("a number that world and renderer cannot compute with is refused at its place") {
  const auto said = [](const std::string& more) {
    const auto a = test::analyze_with_suite(more);
    return a->codes() == "P0304" ? a->underlined() : a->said();
  };
  CHECK(said("object o like red { density 1e7kg/m3 }") == "1e7kg/m3");
  CHECK(said("object o like red { friction 1001 }") == "1001");
  CHECK(said("object o like red { box 3km x 2cm x 2cm }").find("P0301") != std::string::npos);
  CHECK(said("object o like red { box 3000m x 2cm x 2cm }") == "3000m");
  CHECK(said("object o like red { box (0cm, 0cm, 0cm) .. (1cm, 1cm, 1e-8m) }") ==
        "box (0cm, 0cm, 0cm) .. (1cm, 1cm, 1e-8m)");
  CHECK(said("light l { ambient 1e7 }") == "1e7");
  CHECK(said("light l { ambient 1; sun (0, 0, -1e-9) power 1 }") == "(0, 0, -1e-9)");
  CHECK(said("light l { ambient 1; sun (0, 0, -1) power 1e7 }") == "1e7");
  CHECK(said("camera c like eye { lens 1e-3px, 30px, 32px, 24px }") == "1e-3px");
  CHECK(said("camera c like eye { mount arm.base at (0m, 0m, 1e4m) look (1, 0, -1) }") == "1e4m");
  CHECK(said("camera c like eye { mount arm.base at (0m, 0m, 1m) look (1e-9, 0, -1e-9) }") ==
        "(1e-9, 0, -1e-9)");
  CHECK(said("scene s like bench { physics 1e7Hz friction 1 }") == "1e7Hz");
  CHECK(said("scene s like bench { surface 2000m area (-50cm, -50cm) .. (50cm, 50cm) }") ==
        "2000m");
  CHECK(said("layout l like pairs { drop 2000m settle 1s }") == "2000m");
  CHECK(said("layout l like pairs { jitter 2000m }") == "2000m");
}

TEST_CASE("files that use each other are checked beside others") {
  const Folder folder("circle");
  folder.write("base.probe", test::kSmallSuite);
  const std::vector<std::string> files = {
      folder.write("a.probe", "use \"base.probe\"\nvariant va of red_on_tray { light night }\n"),
      folder.write("c.probe",
                   "use \"base.probe\"\nuse \"d.probe\"\nvariant vc of red_on_tray { say no }\n"),
      folder.write("d.probe", "use \"c.probe\"\nvariant vd of red_on_tray { say nor }\n")};
  const auto checked = check(files, {test::asset_root(), ""});
  REQUIRE(checked.ok());
  std::string said;
  for (const Diagnostic& item : checked->diagnostics.items()) said += item.message + "\n";
  CHECK_MESSAGE(checked->diagnostics.size() == 2, said);
}

TEST_CASE("a plan of one suite has the baselines of its tasks and not those of the baselines") {
  const Folder folder("chain");
  const std::string file = folder.write("x.probe", std::string(test::kSmallSuite) + R"(
variant dark of red_on_tray { light night }
variant dark_blue of dark { source blue }
suite last trained on lab { tasks { dark_blue }; seeds 1 }
)");
  const Compilation all = build_ok(file);
  const Compilation last = build_ok(file, "last");
  const auto whole = plan::Plan::from_bytes(all.plan);
  const auto plan = plan::Plan::from_bytes(last.plan);
  REQUIRE(plan.ok());
  REQUIRE(plan->tasks().size() == 2);
  CHECK(plan->text(plan->tasks()[0].name) == "dark");
  CHECK(plan->tasks()[0].baseline == plan::kNone);
  CHECK(plan->tasks()[1].axes == static_cast<std::uint32_t>(plan::Axis::kObjectSource));
  // What a task is does not depend on what else is built.
  CHECK(plan->episodes()[24].episode_id == whole->episodes()[48].episode_id);
}
