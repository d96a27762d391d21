#include "compiler/language/moved.h"

#include <doctest/doctest.h>

#include "compiler/language/fixes.h"

namespace probe::language {
namespace {

// A task whose layout is `layout`, over the suite's objects; the text after the move, or why not.
std::string after(const std::string& layout, const std::string& object, const Move& move,
                  const std::string& more = "") {
  const std::string path = VLAPROBE_SOURCE_DIR "/suite/moved_test.probe";
  const std::string text = "use \"intact.probe\"\nlayout mine {\n" + layout +
                           "\n  orient by rest\n  drop 50cm settle 0.5s\n}\ntask t like "
                           "carrot_on_plate { layout mine; " +
                           more + " }\n";
  const Setting setting{VLAPROBE_SOURCE_DIR "/assets", {VLAPROBE_SOURCE_DIR "/dsl"}};
  const auto snapshot = Snapshot::analysed(path, {{path, text}}, setting);
  REQUIRE(snapshot != nullptr);
  auto edits = moved(*snapshot, "t", object, move);
  if (!edits) return "no: " + edits.failure().message;
  for (const Replacement& edit : *edits) CHECK(snapshot->path(edit.span.file) == path);
  const std::string now = applied(text, *edits);
  const std::size_t begin = now.find("layout mine {\n") + 14;
  return now.substr(begin, now.find("\n  orient") - begin);
}

const std::string kPlaced = "  place source at (-16cm, 0.02m)\n  place target at (-125mm, 0cm)";

}  // namespace

TEST_CASE("a thing that is moved has another place, in the units of the text") {
  CHECK(after(kPlaced, "carrot", {{-0.16, 0.02}, {-0.1468, -0.0101}}) ==
        "  place source at (-14.7cm, -0.01m)\n  place target at (-125mm, 0cm)");
  CHECK(after(kPlaced, "plate", {{-0.125, 0}, {-0.1, 0.0504}}) ==
        "  place source at (-16cm, 0.02m)\n  place target at (-100mm, 5cm)");
}

TEST_CASE("what is seen may be older than the text: it goes where it is wanted") {
  CHECK(after(kPlaced, "carrot", {{-0.3, 0.02}, {-0.2, 0.02}}) ==
        "  place source at (-20cm, 0.02m)\n  place target at (-125mm, 0cm)");
  // What jitters stands elsewhere than is written.
  CHECK(after(kPlaced + "\n  jitter 2cm", "carrot", {{-0.17, 0.02}, {-0.16, 0.02}}) ==
        "  place source at (-15cm, 0.02m)\n  place target at (-125mm, 0cm)\n  jitter 2cm");
}

TEST_CASE("an axis along which it was not moved keeps its words") {
  CHECK(after("  place source at (-16.123cm, 0cm)\n  place target at (-5cm, 0cm)", "carrot",
              {{-0.16123, 0}, {-0.161, 0.01}}) ==
        "  place source at (-16.123cm, 1cm)\n  place target at (-5cm, 0cm)");
  CHECK(after(kPlaced, "carrot", {}) == kPlaced);
}

TEST_CASE("no number is written as minus nothing") {
  CHECK(after(kPlaced, "carrot", {{-0.16, 0.02}, {-0.0001, -0.0001}}) ==
        "  place source at (0cm, 0m)\n  place target at (-125mm, 0cm)");
}

TEST_CASE("a thing in a cell moves its grid, and what has no place of its own says why") {
  const std::string grid =
      "  cells c = grid 2 x 2 at (-16cm, 0cm) spread (7.5cm, 7.5cm)\n"
      "  place source, target in distinct c";
  CHECK(after(grid, "plate", {{-0.235, 0.075}, {-0.225, 0.075}}) ==
        "  cells c = grid 2 x 2 at (-15cm, 0cm) spread (7.5cm, 7.5cm)\n"
        "  place source, target in distinct c");
  CHECK(after("  place target at (-10cm, 0cm)\n  place source on target", "carrot",
              {{0, 0}, {0.01, 0}}) == "no: `carrot` is put on `target`: move that");
  CHECK(after(kPlaced, "spoon", {}) == "no: `spoon` is no object of `t`");
  CHECK(after(kPlaced, "carrot", {{0, 0}, {1e300, 0}}) == "no: moved to what is no place");
}

TEST_CASE("a distractor is moved by the line of distractors") {
  CHECK(after(kPlaced + "\n  place distractors at (-20cm, 10cm)", "spoon",
              {{-0.2, 0.1}, {-0.19, 0.1}},
              "distractors spoon") == kPlaced + "\n  place distractors at (-19cm, 10cm)");
}

}  // namespace probe::language
