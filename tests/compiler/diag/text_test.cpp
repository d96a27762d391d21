#include "compiler/diag/text.h"

#include <doctest/doctest.h>

#include <string>

using namespace probe;

namespace {

// The span of the n-th occurrence (from 0) of `what`.
Span find(const SourceSet& sources, FileId id, std::string_view what, int n = 0) {
  const std::string_view text = sources.file(id).text();
  std::size_t at = text.find(what);
  while (n-- > 0) at = text.find(what, at + 1);
  REQUIRE(at != std::string_view::npos);
  return {id, static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(at + what.size())};
}

std::string draw(const Diagnostic& diagnostic, const SourceSet& sources) {
  return render_text(diagnostic, sources);
}

}  // namespace

TEST_CASE(
    "a label in another file gets its own block and the gutter fits the largest line number") {
  SourceSet sources;
  const FileId color = sources.add(
      "suite/color.probe",
      std::string(6, '\n') +
          "variant hard_color of carrot_on_plate_lang_color { distractors orange, spoon }\n");
  const FileId catalog =
      sources.add("suite/catalog.probe",
                  std::string(20, '\n') +
                      "  phrase by_color appearance \"orange object\" means color orange\n");
  Diagnostics diagnostics;
  Diagnostic& error = diagnostics
                          .report(Code::P0402, find(sources, color, "orange"),
                                  "\"orange object\" denotes 2 objects in `hard_color`")
                          .point("also `color orange`")
                          .label(find(sources, catalog, "\"orange object\""), "meant for `carrot`")
                          .help(
                              "`category vegetable` holds for `carrot` and not for `orange`;\n"
                              "\"orange vegetable\" means color orange and category vegetable");
  CHECK(draw(error, sources) ==
        R"(error[P0402]: "orange object" denotes 2 objects in `hard_color`
  --> suite/color.probe:7:64
   |
 7 | variant hard_color of carrot_on_plate_lang_color { distractors orange, spoon }
   |                                                                ^^^^^^ also `color orange`
  ::: suite/catalog.probe:21:30
   |
21 |   phrase by_color appearance "orange object" means color orange
   |                              --------------- meant for `carrot`
   |
   = help: `category vegetable` holds for `carrot` and not for `orange`;
   =       "orange vegetable" means color orange and category vegetable
)");
}

TEST_CASE("labels on the same line get rows of their own and the next line joins the block") {
  SourceSet sources;
  const FileId id = sources.add(
      "suite/intact.probe",
      std::string(69, '\n') +
          "variant carrot_on_plate_lang_neg of carrot_on_plate_distract against carrot_on_plate {\n"
          "  say \"put {the source} on {the target}, not {avoid the towel}\"\n}\n");
  Diagnostics diagnostics;
  diagnostics
      .report(Code::P0701, find(sources, id, "carrot_on_plate_distract"),
              "`carrot_on_plate_lang_neg` differs from its baseline on 2 axes")
      .point("distractors: + spoon, towel")
      .also(find(sources, id, "{avoid the towel}"), "language.negation")
      .label(find(sources, id, "against carrot_on_plate"), "compared with this")
      .help("compare with `carrot_on_plate_distract`, where only language.negation moves")
      .note("to keep it, put @allow(confounded, \"why\") above the declaration");
  CHECK(render_text(diagnostics, sources) ==
        R"(warning[P0701]: `carrot_on_plate_lang_neg` differs from its baseline on 2 axes
  --> suite/intact.probe:70:37
   |
70 | variant carrot_on_plate_lang_neg of carrot_on_plate_distract against carrot_on_plate {
   |                                     ^^^^^^^^^^^^^^^^^^^^^^^^ distractors: + spoon, towel
   |                                                              ----------------------- compared with this
71 |   say "put {the source} on {the target}, not {avoid the towel}"
   |                                              ^^^^^^^^^^^^^^^^^ language.negation
   |
   = help: compare with `carrot_on_plate_distract`, where only language.negation moves
   = note: to keep it, put @allow(confounded, "why") above the declaration
)");
}

TEST_CASE("an earlier line of the same file is shown in a block of its own") {
  SourceSet sources;
  const FileId id =
      sources.add("t.probe", "layout tight like grid_24\n\nvariant bad of x { layout tight }\n");
  Diagnostics diagnostics;
  Diagnostic& error =
      diagnostics.report(Code::P0501, find(sources, id, "tight", 1), "overlap by 3.3cm")
          .label(find(sources, id, "tight"), "declared here");
  CHECK(draw(error, sources) == R"(error[P0501]: overlap by 3.3cm
 --> t.probe:3:27
  |
3 | variant bad of x { layout tight }
  |                           ^^^^^
 ::: t.probe:1:8
  |
1 | layout tight like grid_24
  |        ----- declared here
)");
}

TEST_CASE("tabs, wide and control characters keep the carets in place") {
  SourceSet sources;
  const FileId id =
      sources.add("w.probe", "\ta \xe4\xb8\xad\xe6\x96\x87 b\x1b[2J\xe2\x80\xae c\r\n");
  Diagnostics diagnostics;
  Diagnostic& wide = diagnostics.report(Code::P0101, find(sources, id, "\xe6\x96\x87"), "x");
  CHECK(draw(wide, sources) ==
        "error[P0101]: x\n --> w.probe:1:5\n  |\n"
        "1 |     a \xe4\xb8\xad\xe6\x96\x87 b\xef\xbf\xbd[2J\xef\xbf\xbd c\n"
        "  |         ^^\n");
  Diagnostic& tab = diagnostics.report(Code::P0101, {id, 0, 1}, "escape \x1b[31m");
  CHECK(draw(tab, sources).find("| ^^^^\n") != std::string::npos);
  CHECK(draw(tab, sources).find('\x1b') == std::string::npos);
}

TEST_CASE("a place at the end of a line or of the file has one caret") {
  SourceSet sources;
  const FileId id = sources.add("e.probe", "set a =\n");
  Diagnostics diagnostics;
  CHECK(draw(diagnostics.report(Code::P0101, {id, 7, 7}, "x"), sources) ==
        "error[P0101]: x\n --> e.probe:1:8\n  |\n1 | set a =\n  |        ^\n");
  CHECK(draw(diagnostics.report(Code::P0101, {id, 8, 8}, "x"), sources) ==
        "error[P0101]: x\n --> e.probe:2:1\n  |\n2 |\n  | ^\n");
}

TEST_CASE("a span over several lines is drawn to the end of its first") {
  SourceSet sources;
  const FileId id = sources.add("m.probe", "abc def\nghi\n");
  Diagnostics diagnostics;
  CHECK(draw(diagnostics.report(Code::P0101, {id, 4, 10}, "x"), sources) ==
        "error[P0101]: x\n --> m.probe:1:5\n  |\n1 | abc def\n  |     ^^^\n");
}

TEST_CASE("a very long line is cut around its mark") {
  SourceSet sources;
  const FileId id =
      sources.add("l.probe", std::string(100000, 'a') + "BAD" + std::string(100000, 'z'));
  Diagnostics diagnostics;
  const std::string drawn =
      draw(diagnostics.report(Code::P0101, find(sources, id, "BAD"), "x"), sources);
  CHECK(drawn.size() < 800);
  // The caret stands under the B.
  const std::size_t line = drawn.find("1 | ");
  const std::size_t carets = drawn.find("  | ", line);
  CHECK(drawn.find("BAD") - line == drawn.find("^^^") - carets);
}

TEST_CASE("a diagnostic about no place has no snippet") {
  SourceSet sources;
  Diagnostics diagnostics;
  CHECK(draw(diagnostics.report(Code::P0202, {}, "plan cut off").note("why"), sources) ==
        "error[P0202]: plan cut off\n  = note: why\n");
}

TEST_CASE("colour is only there when asked for") {
  SourceSet sources;
  const FileId id = sources.add("c.probe", "abc\n");
  Diagnostics diagnostics;
  Diagnostic& error =
      diagnostics.report(Code::P0201, {id, 0, 3}, "x").fix_by("write `d`", {id, 0, 3}, "d");
  CHECK(draw(error, sources).find('\x1b') == std::string::npos);
  CHECK(draw(error, sources).find("  = help: write `d`\n") != std::string::npos);
  CHECK(render_text(error, sources, {.colour = true}).find("\x1b[1;31merror[P0201]\x1b[0m") == 0);
}
