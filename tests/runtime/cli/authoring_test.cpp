// The verbs of authors on a file of their own: which suite runs, what is printed fits a screen,
// wrong arguments are named.
#include <doctest/doctest.h>

#include <algorithm>
#include <sstream>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

using probe::test::contains;
using probe::test::Outcome;
using probe::test::Sandbox;
using probe::test::write_file;

namespace {

std::size_t widest(const std::string& text) {
  std::size_t most = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) most = std::max(most, line.size());
  return most;
}

const char* const kMine =
    "use \"suite/intact.probe\"\n"
    "metrics measured like put_strict {\n"
    "  highest = max height(source)\n"
    "  touched = first finger_contact(source)\n"
    "  never   = first height(source) > 2m\n"
    "}\n"
    "variant mine of carrot_on_plate { metrics measured }\n";

}  // namespace

TEST_CASE("run takes a suite of the file itself, never one of a file that it uses") {
  Sandbox box;
  write_file(box / "mine.probe", kMine);
  const Outcome none = box.vlaprobe("run mine.probe --policy null -o out");
  CHECK(none.exit == 1);
  CHECK(contains(none.err, "mine.probe: declares no suite"));
  CHECK(contains(none.err, "--suite: "));
  write_file(box / "own.probe", std::string(kMine) +
                                    "suite second_mine { tasks { mine }; seeds 3 }\n"
                                    "suite other { tasks { carrot_on_plate }; seeds 1 }\n");
  REQUIRE(box.vlaprobe("run own.probe --policy null -o own --episodes 0-0").exit == 0);
  const auto rows = probe::Json::parse(box.vlaprobe("results own --json").out);
  REQUIRE(rows.size() == 1);
  CHECK(rows[0]["task"] == "mine");
  CHECK(rows[0]["seed"] == 3);

  // Numbers have their units, in words for people as in `why`.
  const Outcome text = box.vlaprobe("results own");
  CHECK(contains(text.out, "highest      mean 8"));
  CHECK(contains(text.out, "cm, 8"));
  CHECK(contains(text.out, "never        never in 1"));
  const Outcome why = box.vlaprobe("why own mine 0 --metric highest");
  CHECK_MESSAGE(contains(why.out, "highest = 8"), why.out, why.err);
  CHECK(contains(why.out, "cm at step "));
}

TEST_CASE("in a table of tasks a mean of what did not always come says in how many it did") {
  Sandbox box;
  std::string text =
      "use \"suite/intact.probe\"\n"
      "metrics measured like put_strict { aside = first y(source) > 0cm; never = first "
      "height(source) > 2m }\n";
  std::string names;
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
    text += std::string("task ") + name +
            " like carrot_on_plate { metrics measured; horizon 20 steps }\n";
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  write_file(box / "many.probe", text + "suite many { tasks { " + names + " }; seeds 1 }\n");
  const Outcome run = box.vlaprobe("run many.probe --policy null -o out --episodes 0-23");
  REQUIRE_MESSAGE(run.exit == 0, run.err);
  const Outcome table = box.vlaprobe("results out");
  CHECK_MESSAGE(contains(table.out, "1 in 12/24  never\n"), table.out);
}

TEST_CASE("tables of the whole suite fit a screen of 100 columns") {
  Sandbox box;
  for (const char* verb :
       {"coverage $SUITE", "diff $SUITE carrot_on_plate carrot_on_plate_lang_neg",
        "diff $SUITE orange_juice_on_plate_lang_common_distractv2 put_eggplant_in_basket",
        "explain"}) {
    const Outcome outcome = box.vlaprobe(verb);
    CHECK_MESSAGE(outcome.exit == 0, outcome.err);
    CHECK_MESSAGE(widest(outcome.out) <= 100, verb, ": ", widest(outcome.out));
  }
}

TEST_CASE(
    "coverage tells of each base what was not seen in training and which phrases nobody uses") {
  Sandbox box;
  write_file(box / "mine.probe",
             std::string("use \"suite/intact.probe\"\n") +
                 "object bright like carrot { name \"bright carrot\"; unseen\n"
                 "  phrase glow appearance \"glowing thing\" means color orange }\n"
                 "task lone like carrot_on_plate { source bright }\n"
                 "suite one { tasks { lone }; seeds 1 }\n");
  const auto json = probe::Json::parse(box.vlaprobe("coverage mine.probe --suite one --json").out);
  REQUIRE(json["bases"].size() == 1);
  CHECK(json["bases"][0]["ood"]["source"] == 1);
  CHECK(json["bases"][0]["tasks"] == 1);
  bool found = false;
  for (const auto& phrase : json["unused_phrases"]) found = found || phrase == "bright.glow";
  CHECK(found);
}

TEST_CASE("the suite is found from any folder, and a named library folder is the only one") {
  Sandbox box;
  write_file(box / "deep/mine.probe",
             "use \"suite/catalog.probe\"\nuse \"std/place.probe\"\nset none = tasks\n");
  CHECK(box.vlaprobe("check deep/mine.probe").exit == 0);
  const Outcome nowhere = box.vlaprobe("check deep/mine.probe --std deep");
  CHECK(nowhere.exit == 1);
  CHECK(contains(nowhere.err, "holds no std/"));
}

TEST_CASE("the picture from above says which way is left, and words go by the same left") {
  Sandbox box;
  const auto mine = [&](const std::string& coke, const std::string& pepsi) {
    write_file(box / "mine.probe",
               "use \"suite/intact.probe\"\n"
               "use \"std/space.probe\"\n"
               "extend object coke_can {\n"
               "  phrase left_can spatial \"left can\" means category drink and leftmost\n"
               "}\n"
               "layout sides {\n"
               "  place source at (-16cm, " + coke + ")\n"
               "  place distractors at (-16cm, " + pepsi + ")\n"
               "  place target at (-8cm, 0cm)\n"
               "  orient by rest\n  drop 50cm settle 0.5s\n"
               "}\n"
               "task mine like carrot_on_plate {\n"
               "  layout sides; source coke_can; distractors pepsi_can; refer source as left_can\n"
               "}\n");
  };
  const auto height_of = [](const std::string& svg, const std::string& word) {
    const std::size_t end = svg.find(">" + word + "</text>");
    REQUIRE(end != svg.npos);
    return std::stod(svg.substr(svg.rfind(" y=\"", end) + 4));
  };
  mine("-8cm", "8cm");
  const Outcome right = box.vlaprobe("check mine.probe");
  CHECK_MESSAGE(right.exit == 0, right.err);
  const Outcome drawn = box.vlaprobe("draw mine.probe mine");
  REQUIRE_MESSAGE(drawn.exit == 0, drawn.err);
  // The world's y goes up there, and what lies at less of it is on the left of this camera.
  CHECK(height_of(drawn.out, "left") > height_of(drawn.out, "right"));
  CHECK(contains(drawn.out, ">left and right: as</text>"));
  CHECK(contains(drawn.out, ">third_view sees it</text>"));

  mine("8cm", "-8cm");
  const Outcome wrong = box.vlaprobe("check mine.probe");
  CHECK(wrong.exit == 1);
  CHECK_MESSAGE(contains(wrong.err, "[P0401]: \"left can\" does not denote `coke_can`"), wrong.err);
  CHECK(contains(wrong.err, "there it denotes `pepsi_can`"));
}

TEST_CASE("an object that a metric names is looked for in the scene, and is told how to come there") {
  Sandbox box;
  const auto check = [&](const std::string& object, const std::string& more = "") {
    write_file(box / "mine.probe",
               "use \"suite/intact.probe\"\n"
               "metrics near like put_strict { beside = at end (distance(source, " + object +
                   ") < 10cm) }\n"
                   "variant mine of carrot_on_plate { metrics near" + more + " }\n");
    return box.vlaprobe("check mine.probe");
  };
  // It is declared, in a file that is used, and not there.
  const Outcome absent = check("towel");
  CHECK(absent.exit == 1);
  CHECK(contains(absent.err, "[P0201]: object `towel` is not in the scene of `mine`"));
  CHECK(contains(absent.err, "its scene has carrot, plate"));
  CHECK(contains(absent.err, "or `distractors towel`"));
  CHECK(contains(check("towl").err, "did you mean `towel`?"));
  // As it was told.
  const Outcome there = check("towel", "; distractors towel");
  CHECK_MESSAGE(!contains(there.err, "error["), there.err);
}

TEST_CASE("a copied metric that measures nothing here is a warning with what helps") {
  Sandbox box;
  write_file(box / "bare.probe",
             "use \"suite/intact.probe\"\n"
             "task bare like on_table { source carrot; target plate; metrics put_clean }\n"
             "suite bare_alone { tasks { bare }; seeds 1 }\n");
  const Outcome check = box.vlaprobe("check bare.probe");
  CHECK(check.exit == 0);
  CHECK_MESSAGE(contains(check.err, "warning[P0602]: metric `wrong` is always false"), check.err);
  CHECK(contains(check.err, "`bare` is judged by it"));
}

TEST_CASE("a mesh that is a file, or a name that the program's own assets have, is told") {
  Sandbox box;
  const std::string object =
      "  box (-4cm, -4cm, 0cm) .. (4cm, 4cm, 9cm); density 500kg/m3; friction 0.5; unseen; name \"cup\" }\n"
      "task t like on_table { source cup; target plate }\nsuite mine { tasks { t }; seeds 1 }\n";
  write_file(box / "mug.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  // There is a mug among the program's own.
  write_file(box / "a.probe", "use \"suite/intact.probe\"\nobject cup {\n  mesh \"mug\"\n" + object);
  const Outcome own = box.vlaprobe("check a.probe");
  CHECK_MESSAGE(contains(own.err, "the mesh is `objects/mug` of the program's own assets"), own.err);
  CHECK_MESSAGE(contains(own.err, "vlaprobe assets pack mug.obj -o assets/objects/my_mug"), own.err);
  write_file(box / "b.probe", "use \"suite/intact.probe\"\nobject cup {\n  mesh \"mug.obj\"\n" + object);
  const Outcome missing = box.vlaprobe("check b.probe");
  CHECK(missing.exit == 1);
  CHECK_MESSAGE(contains(missing.err, "vlaprobe assets pack mug.obj -o assets/objects/my_mug"), missing.err);
}

TEST_CASE("a check of what is fine is one line; other verbs count warnings and say where they stand") {
  Sandbox box;
  write_file(box / "fine.probe", "use \"suite/intact.probe\"\nsuite few { tasks { carrot_on_plate }; seeds 1 }\n");
  const Outcome fine = box.vlaprobe("check fine.probe");
  CHECK(fine.exit == 0);
  CHECK(contains(fine.err, " tasks, "));
  CHECK(contains(fine.err, " files: no findings, "));
  CHECK(contains(fine.err, " ms"));
  CHECK(std::count(fine.err.begin(), fine.err.end(), '\n') == 1);

  write_file(box / "odd.probe",
             "use \"suite/intact.probe\"\n"
             "variant odd of carrot_on_plate { light dim; distractors nut }\n"
             "light dim { ambient 0.2; sun (0, 0, -1) power 1 }\n"
             "suite few { tasks { odd }; seeds 1 }\n");
  const Outcome check = box.vlaprobe("check odd.probe");
  CHECK_MESSAGE(contains(check.err, "warning[P0701]"), check.err);
  for (const std::string verb : {"list odd.probe", "show odd.probe odd", "coverage odd.probe"}) {
    CAPTURE(verb);
    const Outcome other = box.vlaprobe(verb);
    CHECK_MESSAGE(contains(other.err, "; `vlaprobe check odd.probe` shows "), other.err);
    CHECK(!contains(other.err, "P0701"));
  }
}
