#include <doctest/doctest.h>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

bool says(const test::Analysis& a, const std::string& text) {
  return a.said().find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("a number without a unit in a layout is answered with the surface it may mean") {
  const auto a = analyze_with_suite(
      "layout l like pairs { cells spots = grid 2 x 2 at (-16, 0cm) spread (10cm, 10cm) }");
  CHECK(a->codes() == "P0302");
  CHECK(says(*a, "the surface is 100cm deep: did you mean `-16cm`?"));
}

TEST_CASE("magnitudes that nobody means are doubted, with the unit that would fit") {
  const auto grid = analyze_with_suite("layout l like pairs { drop 50m }");
  CHECK(grid->codes() == "P0303");
  CHECK(says(*grid, "did you mean `50cm`?"));
  CHECK(analyze_with_suite("layout l like pairs { drop 10cm settle 45s }")->codes() == "P0303");
  CHECK(analyze_with_suite("object o like red { box 4m x 2cm x 2cm }")->codes() == "P0303");
  CHECK(analyze_with_suite("object o like red { density 1e6kg/m3 }")->codes() == "P0303");
  CHECK(analyze_with_suite("scene s like bench { surface 80cm area (-16m, -50cm) .. (50cm, 50cm) }")
            ->codes() == "P0303");
  CHECK(analyze_with_suite("@allow(unit_slip, \"a tower\")\nlayout l like pairs { drop 2m }")
            ->codes() == "");
}

TEST_CASE("read-outs that mean something else than they seem to") {
  const auto codes = [](const std::string& metric) {
    return analyze_with_suite("metrics m { x = " + metric + " }")->codes();
  };
  CHECK(codes("at end impulse(source, target) > 1e-6Ns") == "P0605");
  CHECK(codes("at end (any f in fingers: impulse(f, source) > 1e-6Ns)") == "P0605");
  CHECK(codes("once (not height(source) > 1m)") == "P0605");
  CHECK(codes("once (once height(source) > 1m)") == "P0605");
  CHECK(codes("always (not height(source) > 1m)") == "");
  CHECK(codes("once impulse(source, target) > 1e-6Ns") == "");
  CHECK(codes("at end height(source) == height(target)") == "P0606");
}

TEST_CASE("a confounded comparison marks what moved and names the nearer baseline") {
  const auto a = analyze_with_suite(R"(
variant among of red_on_tray { distractors blue }
variant warned of among against red_on_tray { say "put {source} on {the target}, not {avoid blue}" }
)");
  CHECK_MESSAGE(a->codes() == "P0701", a->said());
  CHECK(says(*a, "language.negation"));
  CHECK(says(*a, "compared with this"));
  CHECK(says(*a, "compare with `among`, where only language.negation moves"));
}

TEST_CASE("what a file of tasks declares and never mentions is pointed out, a catalogue is not") {
  SourceSet sources;
  Diagnostics diagnostics;
  const FileId library = sources.add("library.probe", test::kSmallSuite);
  const FileId tasks = sources.add("tasks.probe", R"(use "library.probe"
template spare "take {source}"
template used "take {source} to {target}"
predicate lonely(o: object) = height(o) > 1m
object third like red { phrase odd appearance "strange thing" means color red }
# a comment that names third and lonely is no use
task t like red_on_tray { say used }
)");
  std::vector<syntax::ParseResult> files;
  files.push_back(syntax::parse(sources, library, diagnostics));
  files.push_back(syntax::parse(sources, tasks, diagnostics));
  sema::analyze(sources, {&files[0].file, &files[1].file}, test::asset_root(), diagnostics,
                {tasks});
  std::string said;
  for (const Diagnostic& item : diagnostics.items())
    said += std::string(info(item.code).text) + " " + item.message + "\n";
  CHECK(said ==
        "P0205 template `spare` is never used\nP0205 predicate `lonely` is never used\n"
        "P0205 object `third` is never used\nP0205 phrase `odd` is never used\n");
}

TEST_CASE("a density in grams, a turn in radians and a focal length in metres are doubted") {
  const auto said = [](const std::string& declaration) {
    const auto a = analyze_with_suite(declaration);
    return a->codes() == "P0303" && a->diagnostics.items().front().helps.size() == 1
               ? a->diagnostics.items().front().helps.front()
               : a->codes();
  };
  CHECK(said("object o like red { density 0.7kg/m3 }") == "did you mean `700kg/m3`?");
  CHECK(said("object o like red { rest yaw 1.5708deg }") == "did you mean `1.5708rad`?");
  CHECK(said("variant v of red_on_tray { pose red yaw 90rad, yaw 0deg }") ==
        "did you mean `90deg`?");
  CHECK(said("layout l like pairs { orient source yaw 3.14deg }") == "did you mean `3.14rad`?");
  CHECK(analyze_with_suite("object o like red { friction 50 }")->codes() == "P0303");
  CHECK(analyze_with_suite("layout l like pairs { orient source yaw 45deg, yaw 2deg }")->codes() ==
        "");
}

TEST_CASE("sets, suites and derives without tasks, seeds twice or not at all") {
  const auto codes = [](const std::string& text) { return analyze_with_suite(text)->codes(); };
  CHECK(codes("set s = tasks where has distractors") == "P0211");
  CHECK(codes("@allow(empty, \"a later release\")\nset s = tasks where has distractors") == "");
  CHECK(codes("derive \"{t}_x\" for t in tasks where has distractors { light night }") == "P0211");
  CHECK(codes("derive \"{t}_{p}\" for t in tasks, p in phrases commonsense of target "
              "{ refer target as p }") == "P0211");
  CHECK(codes("suite s { tasks tasks where has distractors; seeds 1 }") == "P0211");
  CHECK(codes("suite s { tasks tasks; seeds 1, 2, 1 }") == "P0203");
  CHECK(codes("suite s { tasks tasks }") == "P0206");
  CHECK(codes("suite s { tasks { base }; seeds 1 }") == "P0703");
  CHECK(codes("derive \"{t}_x\" for t in { base } { light night }") == "P0703");
}

TEST_CASE("a layout lets objects come to rest, metrics say what success is") {
  const auto codes = [](const std::string& text) { return analyze_with_suite(text)->codes(); };
  const std::string places = "place source at (0cm, 0cm); place target at (20cm, 0cm)";
  const std::string turns = "; orient source yaw 0deg; orient target yaw 0deg";
  const std::string task = "variant v of red_on_tray { layout l }";
  CHECK(codes("layout l { " + places + turns + " }\n" + task) == "P0206");
  CHECK(codes("layout l { " + places + turns + "; drop 10cm }\n" + task) == "P0206");
  CHECK(codes("layout l { " + places + turns + "; drop 10cm settle 1s }\n" + task) == "");
  const std::string judged =
      "task t like red_on_tray { metrics m }\nvariant u of t { source blue }";
  CHECK(codes("metrics m { moved = at end moved_xy(source) > 1cm }\n" + judged) == "P0206");
  CHECK(codes("metrics m { success = max moved_xy(source) }\n" + judged) == "P0601");
  CHECK(codes("metrics m { moved = at end moved_xy(source) > 1cm }\n"
              "task t like red_on_tray { metrics m; set success = once moved_xy(source) > 1cm }") ==
        "");
}

TEST_CASE("a camera that looks nowhere is told so") {
  const auto a =
      analyze_with_suite("camera c like eye { mount arm.base at (0cm, 0cm, 1m) look (0, 0, 0) }");
  CHECK(a->codes() == "P0304");
  CHECK(says(*a, "a camera looks along a direction, found none"));
}

TEST_CASE("what is wrong with a start is said of what came in, when the layout was fine before") {
  const auto overlap = analyze_with_suite(
      "object wide like blue { mesh \"block\"; box 60cm x 60cm x 2cm; name \"w\" }\n"
      "variant v of red_on_tray { source wide }");
  CHECK_MESSAGE(overlap->codes().starts_with("P0501"), overlap->said());
  CHECK(overlap->underlined() == "wide");
  const auto cells = analyze_with_suite(
      "object b1 like blue { name \"b1\" }\nobject b2 like blue { name \"b2\" }\n"
      "variant v of red_on_tray { distractors blue, b1, b2 }");
  CHECK_MESSAGE(cells->codes() == "P0503", cells->said());
  CHECK(cells->underlined() == "distractors blue, b1, b2");
}

TEST_CASE("a tag for another data set does not answer for the suite's own") {
  const auto a = analyze_with_suite(
      "dataset other \"Other\"\nsuite s trained on other { tasks { red_on_tray }; seeds 1 }");
  CHECK_MESSAGE(a->codes() == "P0705 P0705", a->said());
  CHECK(says(*a, "does not say whether it was seen in `other`"));
}

TEST_CASE("cells in the same place are an error where the spread stands") {
  const auto a = analyze_with_suite(
      "layout l like pairs { cells spots = grid 3 x 1 at (0cm, 0cm) spread (0cm, 0cm) }");
  CHECK(a->codes() == "P0304");
  CHECK(a->underlined() == "(0cm, 0cm)");
  CHECK(analyze_with_suite(
            "layout l like pairs { cells spots = grid 3 x 1 at (0cm, 0cm) spread (9cm, 0cm) }")
            ->codes() == "");
}
