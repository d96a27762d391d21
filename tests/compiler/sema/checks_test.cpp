#include <doctest/doctest.h>

#include "tests/compiler/sema/small_suite.h"

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
