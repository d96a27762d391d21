// What an audit finds: in the suite as published at least everything that is known to be irregular
// there, in the repaired suite nothing.
#include "compiler/audit/audit.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "compiler/diag/text.h"
#include "runtime/base/json.h"

using namespace probe;
using audit::Kind;
namespace fs = std::filesystem;

namespace {

struct Audited {
  audit::Audit audit;

  // The finding of that kind about the task; null when there is none.
  const audit::Finding* find(Kind kind, const std::string& task) const {
    for (const audit::Finding& finding : audit.findings) {
      if (finding.kind == kind &&
          std::find(finding.tasks.begin(), finding.tasks.end(), task) != finding.tasks.end())
        return &finding;
    }
    return nullptr;
  }
  std::vector<std::string> axes(Kind kind, const std::string& task) const {
    const audit::Finding* finding = find(kind, task);
    return finding == nullptr ? std::vector<std::string>{} : finding->axes;
  }
};

Audited audit_file(const std::string& file) {
  const std::span<const std::string> files(&file, 1);
  auto compiled = build(files, {.asset_root = VLAPROBE_SOURCE_DIR "/assets",
                                .suite = "",
                                .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"},
                                .wants_unheld = true});
  REQUIRE_MESSAGE(compiled.ok(), to_text(compiled.failure()));
  REQUIRE_MESSAGE(compiled->ok, render_text(compiled->diagnostics, compiled->sources));
  auto plan = plan::Plan::from_bytes(std::move(compiled->plan));
  REQUIRE_MESSAGE(plan.ok(), to_text(plan.failure()));
  auto audited = audit::audit(*compiled, *plan, 0, files);
  REQUIRE_MESSAGE(audited.ok(), to_text(audited.failure()));
  return {std::move(audited).value()};
}

const Audited& published() {
  static const Audited audited = audit_file(VLAPROBE_SOURCE_DIR "/suite/intact.probe");
  return audited;
}

// A text behind the suite, in a folder of its own; `table` is starts.csv beside it.
Audited audit_text(const std::string& text, const std::string& table = "") {
  const fs::path folder = fs::temp_directory_path() / ("probe_audit_" + std::to_string(getpid()));
  fs::create_directories(folder);
  for (const auto& entry : fs::directory_iterator(VLAPROBE_SOURCE_DIR "/suite"))
    if (entry.is_regular_file())
      fs::copy_file(entry.path(), folder / entry.path().filename(),
                    fs::copy_options::overwrite_existing);
  if (!table.empty()) std::ofstream(folder / "starts.csv") << table;
  std::ofstream(folder / "own.probe") << "use \"intact_clean.probe\"\n" << text;
  Audited audited = audit_file((folder / "own.probe").string());
  fs::remove_all(folder);
  return audited;
}

}  // namespace

TEST_CASE("the published suite: comparisons of several axes are found, with axes and reasons") {
  const Audited& suite = published();
  const std::vector<std::string> negation = {"distractors", "language.negation"};
  for (const char* task : {"carrot_on_plate_lang_neg", "coke_can_on_plate_lang_neg",
                           "orange_juice_on_plate_lang_neg"}) {
    CAPTURE(task);
    CHECK(suite.axes(Kind::kConfounded, task) == negation);
    CHECK(suite.find(Kind::kConfounded, task)->allowed.has_value());
  }
  CHECK(suite.axes(Kind::kConfounded, "carrot_on_keyboard_lang_common") ==
        std::vector<std::string>{"distractors", "language.commonsense"});
  CHECK(suite.axes(Kind::kConfounded, "carrot_on_plate_lang_neg_action") ==
        std::vector<std::string>{"distractors", "language.action", "language.negation", "goal"});
  for (const char* task : {"eggplant_on_sponge_clean", "eggplant_on_keyboard_clean"}) {
    CAPTURE(task);
    CHECK(suite.find(Kind::kConfounded, task) != nullptr);
    CHECK(suite.find(Kind::kAcrossScenes, task) != nullptr);
    CHECK(suite.find(Kind::kAcrossLayouts, task) != nullptr);
    CHECK(suite.find(Kind::kHorizon, task) != nullptr);
    CHECK(suite.find(Kind::kSuccessRule, task) != nullptr);
  }
}

TEST_CASE("a warning of another suite is none of this one") {
  const std::string own = "suite own { tasks { carrot_on_plate }; seeds 0 }\n";
  const std::string drawn =
      "suite drawn { sample 2 episodes of variants of { carrot_on_plate } seed 5; seeds 0 }\n";
  const auto cuts = [](const Audited& audited) {
    return std::ranges::count(audited.audit.findings, "cut", &audit::Finding::code);
  };
  CHECK(cuts(audit_text(own + drawn)) == 0);
  CHECK(cuts(audit_text(drawn + own)) == 1);
}

TEST_CASE("a warning of what a task copies from one that the suite leaves out is the suite's") {
  const std::string tasks =
      "task base like carrot_on_plate { say \"put the left carrot on {the target}\" }\n"
      "variant longer of base { horizon 40s }\n"
      "task copy like base { horizon 41s }\n";
  const auto said = [&](const std::string& task) {
    const Audited audited = audit_text(tasks + "suite own { tasks { " + task + " }; seeds 0 }\n");
    return std::ranges::any_of(audited.audit.findings, [&](const audit::Finding& finding) {
      return finding.code == "unproved_place" &&
             finding.message.find("`" + task + "`") != std::string::npos;
    });
  };
  for (const char* task : {"base", "longer", "copy"}) {
    CAPTURE(task);
    CHECK(said(task));
  }
}

TEST_CASE("a solution that does not do what success asks for is found, with what would") {
  const Audited suite = audit_text(R"(
use "std/fixtures.probe"
fixture chest {
  urdf "fixtures/cabinet/cabinet.urdf"; at (-27cm, 30cm, 87cm)
  joint top friction 1N damping 5Ns/m
  joint bottom friction 1N damping 5Ns/m
  part top_drawer link top_drawer
  part bottom_drawer link bottom_drawer
  region inside of top_drawer box (-8cm, -12cm, -3cm) .. (10cm, 12cm, 2cm)
}
scene with_chest like table { fixture chest }
layout corner like grid_24 { cells corners = grid 2 x 2 at (-16cm, -5cm) spread (7.5cm, 7.5cm) }
metrics tidied { success = at end (put_in(source, chest.inside) and closed(chest.top_drawer)) }
metrics both { success = at end (opened(chest.top_drawer) and opened(chest.bottom_drawer)) }
abstract task tidy like carrot_on_plate {
  scene with_chest; layout corner; metrics tidied; say "put {the source} away"
}
task whole like tidy {
  solution { open chest.top_drawer; put source in chest.inside; close chest.top_drawer }
}
task shut like tidy { solution { put source in chest.inside } }
task left_open like tidy { solution { open chest.top_drawer; put source in chest.inside } }
task wrong_one like tidy {
  solution { open chest.top_drawer; put target in chest.inside; close chest.top_drawer }
}
task one_of_two like carrot_on_plate {
  scene with_chest; layout corner; metrics both; say "open both drawers"
  solution { open chest.top_drawer }
}
suite own_solutions trained on bridge_v2 {
  tasks { whole, shut, left_open, wrong_one, one_of_two }; seeds 42
}
)");
  CHECK(suite.find(Kind::kSolution, "whole") == nullptr);
  const auto said = [&](const char* task) {
    const audit::Finding* finding = suite.find(Kind::kSolution, task);
    return finding == nullptr ? std::string("nothing") : finding->message;
  };
  CHECK(said("shut") == "`put carrot in chest.inside` goes into what is closed then");
  const std::string all =
      "when it is done `success` is not true; `open chest.top_drawer; put carrot in chest.inside; "
      "close chest.top_drawer` makes it so";
  CHECK(said("left_open") == all);
  CHECK(said("wrong_one") == all);
  CHECK(said("one_of_two") ==
        "when it is done `success` is not true; `open chest.top_drawer; open chest.bottom_drawer` "
        "makes it so");
}

TEST_CASE("the published suite: success by another rule than the canonical task's is found") {
  for (const char* task : {"spoon_on_towel_distract", "spoon_on_towel_lang_common_distract"}) {
    const audit::Finding* finding = published().find(Kind::kSuccessRule, task);
    REQUIRE_MESSAGE(finding != nullptr, task);
    CHECK(finding->place.file.ends_with("suite/intact.probe"));
    CHECK(finding->place.line > 0);
    CHECK(finding->allowed ==
          "published with the contact condition that the canonical task does "
          "not have");
  }
}

TEST_CASE("the published suite: what is said of absent objects, and of two objects by one name") {
  const audit::Finding* absent = published().find(Kind::kWarning, "spoon_on_towel_lang_neg");
  REQUIRE(absent != nullptr);
  CHECK(absent->code == "absent");
  CHECK(absent->allowed.has_value());
  const audit::Finding* small =
      published().find(Kind::kNamesake, "spoon_on_towel_lang_common_distract");
  REQUIRE(small != nullptr);
  CHECK(small->message == "\"sponge\" is `sponge_small` here and `sponge` in other tasks");
}

TEST_CASE("the published suite: a comparison that no suite holds is found") {
  const audit::Finding* finding =
      published().find(Kind::kUnlisted, "carrot_on_plate_lang_neg_action");
  REQUIRE(finding != nullptr);
  CHECK(finding->baseline == "carrot_on_plate_distract");
  CHECK(published().find(Kind::kEndsInGrasp, "carrot_on_plate_lang_neg_action") != nullptr);
}

TEST_CASE("the published suite: rules that pass or count what they should not are found") {
  const audit::Finding* target = published().find(Kind::kWrongCountsTarget, "carrot_on_plate");
  REQUIRE(target != nullptr);
  CHECK(target->place.file.ends_with("suite/manipulation.probe"));
  CHECK(target->tasks.size() == 51);
  CHECK(published().find(Kind::kWrongAtEnd, "carrot_on_plate") != nullptr);
  for (const char* task :
       {"carrot_on_ramekin_clean", "carrot_on_wheel_clean", "coke_can_on_ramekin_clean",
        "coke_can_on_wheel_clean", "nut_on_wheel_clean", "spoon_on_towel"}) {
    CHECK_MESSAGE(published().find(Kind::kBeside, task) != nullptr, task);
  }
  for (const char* task :
       {"carrot_on_plate", "stack_cube", "spoon_on_towel_distract", "put_eggplant_in_basket"}) {
    CHECK_MESSAGE(published().find(Kind::kBeside, task) == nullptr, task);
  }
}

TEST_CASE("the published suite: what lies on the sink's wall passes, and what is still held") {
  const audit::Finding* wall = published().find(Kind::kOnFixture, "put_eggplant_in_basket");
  REQUIRE(wall != nullptr);
  CHECK(wall->place.file.ends_with("suite/manipulation.probe"));
  CHECK(wall->tasks.size() == 4);  // all in the sink
  CHECK(published().find(Kind::kOnFixture, "carrot_on_plate") == nullptr);
  std::size_t held = 0;
  for (const audit::Finding& finding : published().audit.findings)
    if (finding.kind == Kind::kHeld) held += finding.tasks.size();
  CHECK(held == 50);  // not the 51st, which asks for the opposite
  CHECK(published().find(Kind::kHeld, "carrot_on_plate_lang_neg_action") == nullptr);
}

TEST_CASE("the published suite: every @allow is in the audit with its reason") {
  std::ifstream in(VLAPROBE_SOURCE_DIR "/suite/intact.probe");
  std::size_t allows = 0;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("@allow(")) continue;
    ++allows;
    const std::size_t from = line.find('"') + 1;
    const std::string reason = line.substr(from, line.rfind('"') - from);
    const auto& findings = published().audit.findings;
    CHECK_MESSAGE(std::any_of(findings.begin(), findings.end(),
                              [&](const audit::Finding& f) { return f.allowed == reason; }),
                  reason);
  }
  CHECK(allows >= 10);
}

TEST_CASE("the repaired suite has nothing irregular") {
  const Audited clean = audit_file(VLAPROBE_SOURCE_DIR "/suite/intact_clean.probe");
  CHECK_MESSAGE(clean.audit.findings.empty(), audit::to_text(clean.audit));
  CHECK(clean.audit.tasks == 52);
  CHECK(clean.audit.comparisons == 48);
  CHECK(audit::to_text(clean.audit) ==
        audit::to_text(clean.audit.robots.front()) +
            "\nlooked at: all words of 52 of 52 tasks are held to success; success of 52 of 52 "
            "tasks was "
            "put to the test in made-up worlds\n12 of 1248 starts repeat another start of the same "
            "task, to the last bit\nsuite `intact_clean`, 52 tasks, 48 comparisons: nothing "
            "irregular\n");
}

TEST_CASE("of each robot it says how it is driven, grips, where things are and what is varied") {
  const Audited own = audit_text(R"(use "panda.probe"
camera noisy like third_view { sensor noise 0.02 }
variant carrot_noisy of carrot_on_plate { camera noisy }
variant carrot_late of carrot_on_plate { delay 2 steps }
suite robots trained on bridge_v2 {
  tasks { carrot_on_plate, carrot_noisy, carrot_late, panda_carrot_on_plate }; seeds 42
}
)");
  REQUIRE(own.audit.robots.size() == 2);
  const bool panda_first = own.audit.robots[0].name == "panda";
  const audit::RobotFacts& panda = own.audit.robots[panda_first ? 0 : 1];
  const audit::RobotFacts& widowx = own.audit.robots[panda_first ? 1 : 0];
  CHECK(panda.law == "osc_pose");
  CHECK(panda.control_hz == 20);
  CHECK(panda.tasks == 1);
  CHECK(panda.axes.empty());
  REQUIRE(panda.reach);
  CHECK(panda.reach->near <= panda.nearest);
  CHECK(panda.farthest <= panda.reach->far);
  CHECK(widowx.name == "widowx");
  CHECK(widowx.law == "ee_delta_pose");
  CHECK(widowx.control_hz == 5);
  CHECK(widowx.fingers == 2);
  CHECK(widowx.grip_open == doctest::Approx(0.038));
  CHECK(widowx.tasks == 3);
  CHECK(widowx.starts == 72);
  CHECK(widowx.axes == std::map<std::string, std::size_t>{{"latency", 1}, {"sensor", 1}});
  REQUIRE(widowx.reach);
  // The near corner of the grid is (-8.5cm, 7.5cm), the far one (-23.5cm, -7.5cm); the base stands
  // at (14.7cm, 2.8cm).
  CHECK(widowx.nearest == doctest::Approx(std::hypot(0.232, 0.047)));
  CHECK(widowx.farthest == doctest::Approx(std::hypot(0.382, 0.103)));
  const std::string told = audit::to_text(widowx);
  CHECK(told.find("robot `widowx`: ee_delta_pose at 5 Hz, 2 fingers (joint at 0.014 closed, 0.038 "
                  "open); 72 starts of 3 tasks, objects 23.7cm to 39.6cm from its base, all within "
                  "its reach of 12cm to 62cm; comparisons move latency in 1, sensor in 1") !=
        std::string::npos);
  CHECK(audit::to_json(own.audit).find("\"law\": \"osc_pose\"") != std::string::npos);
}

TEST_CASE("the same task twice is found") {
  const Audited own = audit_text(
      "object twin like carrot { density 650kg/m3 }\n"
      "variant twin_on_plate of carrot_on_plate { source twin }\n"
      "task copied like twin_on_plate {}\n"
      "suite own { tasks { twin_on_plate, copied }; seeds 1 }\n");
  CHECK(own.find(Kind::kDuplicate, "copied") != nullptr);
}

TEST_CASE("a drawer that is to be opened and begins open is found") {
  const Audited own = audit_text(
      "fixture cabinet { urdf \"fixtures/cabinet/cabinet.urdf\"; at (-27cm, 30cm, 87cm) }\n"
      "scene furnished like table { fixture cabinet }\n"
      "metrics opening { success = at end travel(cabinet.top) >= 10cm }\n"
      "task shut like carrot_on_plate { scene furnished; metrics opening; say \"open the drawer\" "
      "}\n"
      "variant begun of shut { start cabinet.top 13cm }\n"
      "suite own { tasks { shut, begun }; seeds 1 }\n");
  CHECK(own.find(Kind::kHoldsAtStart, "begun") != nullptr);
  CHECK(own.find(Kind::kHoldsAtStart, "shut") == nullptr);
}

TEST_CASE("the kitchen and its variants have nothing irregular but what is allowed with a reason") {
  const Audited audited = audit_file(VLAPROBE_SOURCE_DIR "/suite/kitchen_variants.probe");
  for (const audit::Finding& finding : audited.audit.findings)
    CHECK_MESSAGE(finding.allowed.has_value(), finding.tasks.front());
  // One irregularity of a piece of furniture that stands elsewhere is as many as there are tasks.
  CHECK(audited.find(Kind::kConfounded, "open_the_microwave_far") != nullptr);
}

TEST_CASE("a thing that is to be put on another and begins there is found") {
  const Audited own = audit_text(
      "layout apart { cells c = grid 2 x 1 at (-16cm, 0cm) spread (6cm, 0cm)\n"
      "  place target in distinct c; place source in distinct c; drop 30cm settle 0.5s }\n"
      "layout stacked { cells c = grid 2 x 1 at (-16cm, 0cm) spread (6cm, 0cm)\n"
      "  place target in distinct c; place source on target; drop 30cm settle 0.5s }\n"
      "layout turned { cells c = grid 2 x 1 at (-16cm, 0cm) spread (6cm, 0cm)\n"
      "  place source in distinct c; place target on source; drop 30cm settle 0.5s }\n"
      "variants of carrot_on_plate { lies { layout stacked }\n begun { layout apart }\n below { "
      "layout turned } }\n"
      "suite own { tasks { carrot_on_plate, lies, begun, below }; seeds 1 }\n");
  CHECK(own.find(Kind::kHoldsAtStart, "lies") != nullptr);
  for (const char* task : {"carrot_on_plate", "begun", "below"}) {
    CAPTURE(task);
    CHECK(own.find(Kind::kHoldsAtStart, task) == nullptr);
  }
}

TEST_CASE("a thing that begins on another while a drawer is shut, in one start alone, is found") {
  const std::string start_1 = "1,carrot,-0.2,0.1,0.926,\n1,plate,-0.2,0.1,0.903,\n";
  const auto holds = [&](const char* top_0, const char* top_1) {
    const Audited own = audit_text(
        "use \"kitchen.probe\"\n"
        "layout given { starts \"starts.csv\"; drop 1cm settle 0.5s }\n"
        "metrics laid { success = at end (on_top_of(source, target) and "
        "closed(cabinet.top_drawer)) }\n"
        "task lay like store { source carrot; target plate; layout given; metrics laid\n"
        "  say \"put {the source} on {the target} and close the top drawer\"; solution none }\n"
        "suite own { tasks { lay }; seeds 0 }\n",
        std::string("start,object,x_m,y_m,z_m,value\n"
                    "0,carrot,-0.2,0.1,0.92,\n0,plate,-0.2,-0.1,0.903,\n0,cabinet.top,,,,") +
            top_0 + "\n" + start_1 + "1,cabinet.top,,,," + top_1 + "\n");
    return own.find(Kind::kHoldsAtStart, "lay") != nullptr;
  };
  CHECK(holds("0.13", "0"));
  CHECK(!holds("0", "0.13"));
}

TEST_CASE("a thing that begins in the drawer that it shall be put into is found") {
  const auto with = [](const std::string& place, const std::string& top) {
    return audit_text(
               "use \"kitchen.probe\"\n"
               "layout here { cells c = grid 2 x 2 at (-18cm, -9cm) spread (7.5cm, 7.5cm)\n"
               "  place carrot in distinct c; place source " +
               place +
               "\n  drop 10cm settle 0.5s }\n"
               "metrics storing { success = at end lies_in(source, target) }\n"
               "task store_it like in_kitchen { source green_cube; target cabinet.inside_top\n"
               "  layout here; metrics storing; start cabinet.top " +
               top +
               "\n  say \"put {the source} in {the target}\" }\n"
               "suite own { tasks { store_it }; seeds 0 }\n")
               .find(Kind::kHoldsAtStart, "store_it") != nullptr;
  };
  CHECK(with("in cabinet.inside_top", "12cm"));
  CHECK(with("in cabinet.inside_top", "0cm"));
  CHECK(!with("in distinct c", "12cm"));
  CHECK(!with("on carrot", "12cm"));
}

TEST_CASE("a thing that begins in a region that is turned is found off its middle, too") {
  const Audited audited = audit_text(R"(
use "kitchen.probe"
fixture slanted like cabinet {
  region inside_top of top_drawer box (-9cm, -2.2cm, -3cm) .. (9cm, 2.2cm, 2cm) at (1cm, 0cm, 0cm) yaw 45deg
}
scene with_slot like counter { fixture slanted, stove }
layout here {
  place source, helper in slanted.inside_top
  drop 10cm settle 0.5s
}
metrics storing { success = at end lies_in(source, target) }
task store_it like in_kitchen {
  scene with_slot; source green_cube; helper yellow_cube; target slanted.inside_top
  layout here; metrics storing; start slanted.top 12cm
  say "put {the source} in {the target} beside {the helper}"
}
suite own { tasks { store_it }; seeds 0 }
)");
  CHECK(audited.find(Kind::kHoldsAtStart, "store_it") != nullptr);
}

TEST_CASE("a rule that passes too much in another start than the first is found, with that start") {
  // The middle of a can that stands beside the plate is 2.8 cm above that of the plate, of one that
  // lies 1.4 cm.
  const auto with = [](const std::string& turns, const std::string& metrics) {
    return audit_text(
        "use \"std/place.probe\"\nlayout turning like grid_24 { orient source " + turns +
        "; orient target yaw 0deg }\nmetrics m like put_clean { " + metrics +
        " }\ntask t like carrot_on_plate { source coke_can; layout turning; metrics m }\n"
        "suite own { tasks { t }; seeds 1 }\n");
  };
  const std::string tall =
      "success = at end (distance_xy(source, target) < 20cm and height(source) - height(target) > "
      "2cm)";
  const std::string stands_first = "roll 90deg, roll 0deg", lies_first = "roll 0deg, roll 90deg";
  for (const std::string& turns : {lies_first, stands_first}) {
    CAPTURE(turns);
    const Audited own = with(turns, tall);
    const audit::Finding* beside = own.find(Kind::kBeside, "t");
    REQUIRE(beside != nullptr);
    const bool says = beside->message.find("where `t` begins as in start 1") != std::string::npos;
    CHECK(says == (turns == lies_first));
  }
  CHECK(with("roll 0deg, roll 0deg", tall).find(Kind::kBeside, "t") == nullptr);
}

TEST_CASE("what is to lie between two things may lie beside one of them") {
  const Audited own = audit_text(
      "use \"std/space.probe\"\nrole helper\n"
      "layout three { cells c = grid 1 x 3 at (-16cm, 0cm) spread (0cm, 13cm)\n"
      "  place source, target, helper in distinct c; drop 30cm settle 0.5s }\n"
      "metrics middle { success = at end between(source, target, helper) }\n"
      "metrics near { success = at end (distance_xy(source, target) < 20cm and "
      "distance_xy(helper, target) < 9m) }\n"
      "task amid like carrot_on_plate { layout three; helper spoon; metrics middle\n"
      "  say \"put {the source} between {the target} and {the helper}\" }\n"
      "task loose like amid { metrics near; say \"put {the source} on {the target}, not on {avoid "
      "the helper}\" }\n"
      "suite own { tasks { amid, loose }; seeds 1 }\n");
  CHECK(own.find(Kind::kBeside, "amid") == nullptr);
  CHECK(own.find(Kind::kBeside, "loose") != nullptr);
}

TEST_CASE("each of several things that are put somewhere is tried on the table and in the hand") {
  const auto with = [](const std::string& success, const std::string& words) {
    return audit_text(
        "use \"std/place.probe\"\nrole helper\n"
        "layout two_and_a_plate { cells back = grid 1 x 2 at (-20cm, 0cm) spread (0cm, 9cm)\n"
        "  place source, helper in distinct back; place target at (-6cm, 0cm)\n"
        "  orient by rest; drop 50cm settle 0.5s }\n"
        "metrics two { success = at end " +
        success +
        " }\n"
        "task t like carrot_on_plate { helper green_cube; layout two_and_a_plate; metrics two\n"
        "  horizon 120 steps; say \"" +
        words + "\" }\nsuite own { tasks { t }; seeds 1 }\n");
  };
  const std::string both = "put both {the source} and {the helper} on {the target}";
  const Audited loose = with("(resting_on(source, target) and resting_on(helper, target))", both);
  const audit::Finding* held = loose.find(Kind::kHeld, "t");
  REQUIRE(held != nullptr);
  CHECK(held->message.find("one of the things that are put somewhere") != std::string::npos);
  const Audited strict = with("(on_top_of(source, target) and on_top_of(helper, target))", both);
  CHECK(strict.find(Kind::kHeld, "t") == nullptr);
  CHECK(strict.find(Kind::kBeside, "t") == nullptr);
  CHECK(strict.audit.tried == 1);
  const Audited ordered = with("put_in_order(source, target, helper, target)",
                               "first put {the source} on {the target}, then {the helper}");
  CHECK(ordered.audit.tried == 1);
  CHECK(ordered.find(Kind::kHeld, "t") == nullptr);
  const Audited unknown = with("(distance_xy(source, helper) < 1cm and height(source) > 9m)",
                               "use {the source}, {the helper} and {the target}");
  CHECK(unknown.audit.untried == std::vector<std::string>{"t"});
  CHECK(audit::to_text(unknown.audit).find("not that of t, where it is not known") !=
        std::string::npos);
}

TEST_CASE("what is wrong before the target was moved is not wrong because of it") {
  const auto with = [](const std::string& wrong) {
    return audit_text("metrics kept like put_clean { wrong = once " + wrong +
                      " }\ntask t like carrot_on_plate { metrics kept }\n"
                      "suite own { tasks { t }; seeds 1 }\n");
  };
  CHECK(with("moved_xy(target) > 5cm").find(Kind::kWrongCountsTarget, "t") != nullptr);
  CHECK(with("height(source) < height(target) + 1m").find(Kind::kWrongCountsTarget, "t") ==
        nullptr);
}

TEST_CASE("an order that the words say and success does not ask for is found") {
  const auto with = [](const std::string& success, const std::string& words) {
    return audit_text(
        "use \"std/place.probe\"\nrole helper\n"
        "layout three { cells c = grid 1 x 3 at (-22cm, 0cm) spread (0cm, 13cm)\n"
        "  place source, target, helper in distinct c; place towel at (-4cm, 0cm)\n"
        "  drop 30cm settle 0.5s }\n"
        "predicate both_put(a: object, p: object, b: object, q: object) = all {\n"
        "  on_top_of(a, p)\n  on_top_of(b, q)\n}\n"
        "metrics two { success = " +
        success +
        " }\ntask t like carrot_on_plate { layout three; helper spoon; metrics two\n  say \"" +
        words + "\" }\nsuite own { tasks { t }; seeds 1 }\n");
  };
  const std::string first = "put {the source} on {the target}, then {the helper} on the towel";
  const Audited either = with("at end both_put(source, target, helper, towel)", first);
  const audit::Finding* found = either.find(Kind::kSwappedOrder, "t");
  REQUIRE(found != nullptr);
  CHECK(found->message == "`t` says \"then\", and `success` is true whichever is put first");
  CHECK(with("at end put_in_order(source, target, helper, towel)", first)
            .find(Kind::kSwappedOrder, "t") == nullptr);
  CHECK(with("at end (on_top_of(source, target) and on_top_of(helper, towel))",
             "put {the source} on {the target} and {the helper} on the towel")
            .find(Kind::kSwappedOrder, "t") == nullptr);
}

TEST_CASE("a warning about a task of another suite is no finding of this one") {
  const std::string text =
      "@allow(absent, \"a test\")\nvariant odd of carrot_on_plate {\n"
      "  say \"put {the source} on {the target}, not on {avoid the towel}\"\n}\n"
      "suite own { tasks { carrot_on_plate }; seeds 1 }\nsuite odd_one { tasks { odd }; seeds 1 "
      "}\n";
  CHECK(audit_text(text).audit.findings.empty());
  const std::string first = text.substr(0, text.find("suite own"));
  CHECK(audit_text(first + "suite odd_one { tasks { odd }; seeds 1 }\n")
            .find(Kind::kWarning, "odd") != nullptr);
}

TEST_CASE("a variant that moves the goal alone is no irregularity") {
  const Audited own = audit_text(
      "metrics ever like put_clean { success = once resting_on(source, target) }\n"
      "variant carrot_ever of carrot_on_plate { metrics ever }\n"
      "suite own { tasks { carrot_on_plate, carrot_ever }; seeds 1 }\n");
  CHECK(own.find(Kind::kSuccessRule, "carrot_ever") == nullptr);
}

TEST_CASE("the JSON names kind, tasks, axes, place and reason") {
  const auto json = Json::parse(audit::to_json(published().audit));
  CHECK(json["suite"] == "intact");
  CHECK(json["tasks"] == 50);
  CHECK(json["comparisons"] == 46);
  CHECK(json["findings"].size() == published().audit.findings.size());
  const auto& first = json["findings"][0];
  CHECK(first["kind"] == "confounded");
  CHECK(first["tasks"].size() == 1);
  CHECK(first["baseline"].is_string());
  CHECK(first["axes"].size() >= 2);
  CHECK(first["line"].get<int>() > 0);
  CHECK(first["allowed"].is_string());
}

TEST_CASE("questions that can be answered without looking are found, and others are not") {
  const Audited found = audit_text(R"(
questions asked {
  choice pick "A robot is told: \"{instruction}\". Which object must it pick up?" answer source among objects
  choice wide "A robot is told: \"{instruction}\". Which one is moved?" answer source among objects and 2 absent
  choice look "Which object is the {phrase of source}?" answer source among objects and 2 absent
  yesno  there "Is there {a o} in the picture?" for o in objects answer present(o)
  yesno  both "Is there {a o} in the picture?" for o in objects and 2 absent answer present(o)
}
suite own trained on bridge_v2 {
  tasks { carrot_on_plate, carrot_on_plate_lang_color, carrot_on_plate_lang_common, spoon_on_towel }
  seeds 42
  questions asked
}
)");
  const auto message = [&](Kind kind, const std::string& question) {
    for (const audit::Finding& finding : found.audit.findings) {
      if (finding.kind == kind && finding.message.find("`asked." + question) != std::string::npos)
        return finding.message;
    }
    return std::string();
  };
  // The color and the common sense task say no name.
  CHECK(message(Kind::kNamesAnswer, "pick").find("in 2 of 4 tasks") != std::string::npos);
  CHECK(message(Kind::kNamesAnswer, "look").empty());
  CHECK(message(Kind::kCoin, "pick").find("in 4 of 4 tasks") != std::string::npos);
  CHECK(message(Kind::kCoin, "wide").empty());
  CHECK(message(Kind::kOneAnswer, "there").find("always `yes`") != std::string::npos);
  CHECK(message(Kind::kOneAnswer, "both").empty());
  const audit::Finding* coin = found.find(Kind::kCoin, "spoon_on_towel");
  REQUIRE(coin != nullptr);
  CHECK(coin->place.line > 0);
  CHECK(to_json(found.audit).find("\"names_answer\"") != std::string::npos);
}

TEST_CASE("what is put likewise needs no verb and no place of its own") {
  const auto not_held = [](const std::string& goal) {
    const Audited own = audit_text(R"(
use "std/place.probe"
role helper
layout two_and_a_plate {
  cells back = grid 1 x 2 at (-20cm, 0cm) spread (0cm, 9cm)
  place source, helper in distinct back
  place target at (-6cm, 0cm)
  orient by rest
  drop 50cm settle 0.5s
}
metrics asked { success = at end )" +
                                   goal + R"( }
task two like on_table {
  source carrot; helper green_cube; target plate; layout two_and_a_plate; metrics asked
  say "first put {the source} on {the target}, then {the helper}"
}
suite own trained on bridge_v2 { tasks { two }; seeds 42 }
)");
    std::string words;
    for (const audit::Unheld& one : own.audit.unheld) words += one.words + ": " + one.why + "\n";
    return words;
  };
  CHECK(not_held("put_in_order(source, target, helper, target)") == "");
  // It may be where the carrot goes then.
  CHECK(not_held("on_top_of(source, target)").find("the green cube: not understood") !=
        std::string::npos);
}

TEST_CASE(
    "a thing whose model begins at its foot: regions are where it has them, held in one counts") {
  const Audited own = audit_text(R"(
object bin {
  mesh "ramekin"; box (-8cm, -8cm, 0cm) .. (8cm, 8cm, 14cm); density 100kg/m3; friction 0.6; name "bin"
  category dishware; rest yaw 0deg
  region inside box (-6cm, -6cm, 1cm) .. (6cm, 6cm, 13cm)
}
metrics binned { success = at end within(position(source), target.inside) }
metrics let_go like binned { success = at end (within(position(source), target.inside) and impulse(source, target) > 0Ns) }
@allow(ambiguous, "there is one bin")
task drop like carrot_on_plate { target bin; metrics binned; say "put {the source} in {the target}"; solution { put source in target } }
task leave like drop { metrics let_go }
suite bins { tasks { drop, leave }; seeds 0 }
)");
  // The middle of what lies in it is below the region's middle, and in the region.
  for (const char* task : {"drop", "leave"})
    CHECK_MESSAGE(own.find(Kind::kSolution, task) == nullptr, to_text(own.audit));
  CHECK(own.find(Kind::kHeld, "drop") != nullptr);
  CHECK(own.find(Kind::kHeld, "leave") == nullptr);
}

TEST_CASE("words that nothing is held to are listed with the reason, and counted") {
  const Audited own = audit_text(R"(
variant kind of carrot_on_plate { say "gently put {the source} on {the target}" }
variant odd of carrot_on_plate { say "put {the source} kind of on {the target}" }
variant covers of carrot_on_plate { say "warm {the source} with {the target}" }
variant touched of carrot_on_plate { say "warm {the source}" }
variant plain of carrot_on_plate { say "lay {the source} on {the target}" }
suite own trained on bridge_v2 { tasks { kind, odd, covers, touched, plain }; seeds 42 }
)");
  const auto why = [&](const std::string& task) {
    std::string text;
    for (const audit::Unheld& one : own.audit.unheld) {
      if (std::ranges::find(one.tasks, task) != one.tasks.end())
        text += (text.empty() ? "" : " | ") + one.words + ": " + one.why;
    }
    return text;
  };
  CHECK(why("plain") == "");
  CHECK(why("kind") == "gently: how it is done is measured by nothing");
  CHECK(why("odd") ==
        "put the carrot: `kind` is not understood | kind of on the plate: not understood");
  CHECK(why("covers") == "warm the carrot with the plate: not understood");
  CHECK(why("touched") == "warm the carrot: not understood");
  CHECK(own.audit.held == 1);
  CHECK(own.audit.heard == 5);
  CHECK(to_text(own.audit).find("looked at: all words of 1 of 5 tasks are held to success") !=
        std::string::npos);
  const auto json = Json::parse(to_json(own.audit));
  CHECK(json["held"] == 1);
  CHECK(json["not_held"].size() == 5);
  CHECK(json["not_held"][0]["line"].get<int>() > 0);
  // Of the suite as published next to all.
  CHECK(published().audit.held + 3 >= published().audit.heard);
}

TEST_CASE(
    "a rule that a thing in the air passes, and one that counts a touch that was, are found") {
  const Audited own = audit_text(R"(
predicate risen(o: object) = height(o) - height(start(o)) > 2cm
metrics raised { success = at end risen(source) }
metrics taken { success = at end (risen(source) and any f in fingers: impulse(f, source) > 1e-6Ns) }
metrics brushed { success = at end (height(target) > 0cm and once impulse(source, target) > 1e-6Ns) }
layout alone { cells spots = grid 2 x 1 at (-16cm, 0cm) spread (7.5cm, 0cm); place source in distinct spots
               orient by rest; drop 50cm settle 0.5s }
task lifted { scene table; layout alone; metrics raised; horizon 60 steps; source carrot; say "pick up {the source}" }
task held like lifted { metrics taken }
task met like on_table { source carrot; target plate; metrics brushed }
suite own trained on bridge_v2 { tasks { lifted, held, met }; seeds 0 }
)");
  CHECK(own.find(Kind::kInTheAir, "lifted") != nullptr);
  CHECK(own.find(Kind::kInTheAir, "held") == nullptr);
  CHECK(own.find(Kind::kTouchedOnce, "met") != nullptr);
  CHECK(own.find(Kind::kTouchedOnce, "held") == nullptr);
}

TEST_CASE("of starts of a file the one is named that is the same in height, too") {
  const fs::path folder = fs::temp_directory_path() / ("probe_same_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "same.csv") << "start,object,x_m,y_m,z_m\n"
                                        "0,source,-0.16,-0.1,0.9\n0,target,-0.16,0.1,0.9\n"
                                        "1,source,-0.16,-0.1,1.0\n1,target,-0.16,0.1,0.9\n"
                                        "2,source,-0.16,-0.1,1.0\n2,target,-0.16,0.1,0.9\n";
  const std::string file = (folder / "own.probe").string();
  std::ofstream(file) << "use \"suite/intact_clean.probe\"\n"
                         "layout filed { starts \"same.csv\"; drop none }\n"
                         "task t like carrot_on_plate { layout filed }\n";
  const auto compiled = build(std::span<const std::string>(&file, 1),
                              {.asset_root = VLAPROBE_SOURCE_DIR "/assets",
                               .suite = "",
                               .library_folders = {VLAPROBE_SOURCE_DIR, VLAPROBE_SOURCE_DIR "/dsl"},
                               .wants_unheld = true});
  fs::remove_all(folder);
  REQUIRE_MESSAGE(compiled.ok(), to_text(compiled.failure()));
  const std::string said = render_text(compiled->diagnostics, compiled->sources);
  CHECK_MESSAGE(said.find("start 2 is start 1") != std::string::npos, said);
}

TEST_CASE("what a layout puts on a thing does not fall onto it, nor does what stands on that") {
  const Audited own = audit_text(R"(
metrics away { success = at end moved_xy(source) > 5cm }
layout stacked { place target at (-16cm, 0cm); place source on target; place distractors on source
                 orient by rest; drop 50cm settle 0.5s }
task carried like on_table { source carrot; target plate; layout stacked; distractors sponge
                             metrics away; say "push {the source} away" }
suite own trained on bridge_v2 { tasks { carried }; seeds 0 }
)");
  CHECK(own.find(Kind::kFallsOn, "carried") == nullptr);
}

TEST_CASE(
    "the Google robot's suite: what is irregular in the release is found, and mended in the "
    "other") {
  const Audited google = audit_file(VLAPROBE_SOURCE_DIR "/suite/google.probe");
  CHECK(google.find(Kind::kInTheAir, "pick_standing") != nullptr);
  CHECK(google.find(Kind::kTouchedOnce, "place_apple") != nullptr);
  const audit::Finding* crowded = google.find(Kind::kFallsOn, "pick_horizontal_among_more");
  REQUIRE(crowded != nullptr);
  CHECK_MESSAGE(crowded->message.find("of 25 starts two objects are dropped onto one another") !=
                    std::string::npos,
                crowded->message);
  const audit::Finding* handle = google.find(Kind::kUnfelt, "open_top");
  REQUIRE(handle != nullptr);
  CHECK_MESSAGE(handle->message.find("3.25cm beyond what is felt") != std::string::npos,
                handle->message);
  const Audited clean = audit_file(VLAPROBE_SOURCE_DIR "/suite/google_clean.probe");
  for (const audit::Finding& finding : clean.audit.findings) {
    const bool is_silenced = finding.kind == Kind::kWarning || finding.allowed;
    CHECK_MESSAGE(is_silenced, finding.message);
  }
}
