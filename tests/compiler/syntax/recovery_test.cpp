#include <doctest/doctest.h>

#include <string>

#include "compiler/diag/text.h"
#include "tests/compiler/syntax/parse_helper.h"

using namespace probe;
using namespace probe::syntax;

TEST_CASE("a misspelt statement is one message that offers the nearest word") {
  const Parsed parsed("task a { soruce carrot; target plate }\n");
  CHECK(render_text(parsed.diagnostics, parsed.sources) ==
        R"(error[P0101]: found `soruce`, expected a statement of a task
 --> t.probe:1:10
  |
1 | task a { soruce carrot; target plate }
  |          ^^^^^^ did you mean `source`?
  |
  = help: expected one of `scene`, `layout`, `source`, `target`, `metrics`, `light`, `camera`, `distractors`, `say`, `then`, `refer`, `pose`, `start`, `horizon`, `idle`, `delay`, `moves`, `solution` or `set`
)");
  const Decl& decl = parsed.decl(0);
  CHECK(!decl.complete);
  CHECK(parsed.get<TaskDecl>().body.size() == 1);
}

TEST_CASE("a bad line of a block leaves the others standing") {
  const Parsed parsed(
      "object o {\n  box 3cm x 3cm 3cm\n  color\n  rest yaw\n  mesh \"x\"\n}\nset a = b\n");
  CHECK(parsed.messages() ==
        "2:17 P0101 found `3cm`, expected `x`\n"
        "3:8 P0101 found end of line, expected a name\n"
        "4:11 P0101 found end of line, expected a number\n");
  REQUIRE(parsed.get<ObjectDecl>().body.size() == 1);
  CHECK(std::holds_alternative<MeshStmt>(parsed.get<ObjectDecl>().body[0]));
  CHECK(parsed.decl(1).complete);
}

TEST_CASE("a bad head of a declaration still has its block read") {
  const Parsed parsed("task b lik c { source d }\nset a = b");
  CHECK(parsed.messages() == "1:8 P0101 found `lik`, expected `like`, `against` or `{`\n");
  CHECK(!parsed.decl(0).complete);
  CHECK(parsed.get<TaskDecl>().body.size() == 1);
  CHECK(parsed.file().decls.size() == 2);
}

TEST_CASE("a list that a derive goes over has a word before it and parentheses round it") {
  CHECK(Parsed("derive \"{t}_{l}\" for t in { a }, l in lights day, night { light l }").messages() ==
        "1:46 P0101 found `day`, expected `(`\n");
  CHECK(Parsed("derive \"{t}_{l}\" for t in { a }, l in (day, night) { light l }").messages() ==
        "1:39 P0101 a list of names has a word before it that says of what: `lights (..)`, `cameras`, "
        "`scenes`, `robots`, `fixtures`, `objects` or `parts`; tasks stand in braces\n");
  // A set may have such a name.
  CHECK(Parsed("derive \"{t}_x\" for t in lights { light l }").messages() == "");
  CHECK(Parsed("derive \"{t}_x\" for t in lights where axis light { light l }").messages() == "");
}

TEST_CASE("an unclosed parenthesis points at where it was opened and costs one line") {
  const Parsed parsed(
      "layout l {\n  place target at (-12.5cm, 2.5cm\n  orient by rest\n  expect 2 episodes\n}\n");
  CHECK(parsed.messages() == "3:3 P0101 found `orient`, expected `,` or `)`\n");
  const Diagnostic& error = parsed.diagnostics.items().front();
  REQUIRE(error.labels.size() == 1);
  CHECK(error.labels[0].text == "this `(` is not closed");
  CHECK(parsed.text(error.labels[0].span) == "(");
  CHECK(parsed.get<LayoutDecl>().body.size() == 2);
}

TEST_CASE("an unclosed parenthesis in a set does not swallow the next declaration") {
  const Parsed parsed("set x = (a - b\nset y = a\n");
  CHECK(parsed.diagnostics.size() == 1);
  CHECK(parsed.file().decls.size() == 2);
  CHECK(parsed.decl(1).complete);
}

TEST_CASE("an unclosed block ends where the next declaration begins") {
  const Parsed parsed("task a {\n  source carrot\n\ntask b {\n  source x\n}\nset z = tasks\n");
  CHECK(parsed.messages() == "4:1 P0101 found `task`, expected `}`\n");
  CHECK(parsed.diagnostics.items()[0].labels[0].text == "this `{` is not closed");
  CHECK(parsed.file().decls.size() == 3);
  CHECK(parsed.get<TaskDecl>(1).body.size() == 1);
}

TEST_CASE("a word that is a statement too starts a declaration when the rest of the line says so") {
  CHECK(Parsed("task a {\n source b\nset z = tasks\n").messages() ==
        "3:1 P0101 found `set`, expected `}`\n");
  CHECK(Parsed("task a {\n source b\nscene t {\n}\n").messages() ==
        "3:1 P0101 found `scene`, expected `}`\n");
  CHECK(Parsed("object a {\n color b\nobject c like d { }\n").messages() ==
        "3:1 P0101 found `object`, expected `}`\n");
  CHECK(Parsed("task a {\nscene t\nset z = once b\n}\n").messages() == "");
}

TEST_CASE("the end of the file inside blocks is one message") {
  CHECK(Parsed("task a {").messages() == "1:9 P0101 found end of file, expected `}`\n");
  CHECK(Parsed("variants of a {\n b {\n source c").messages() ==
        "3:10 P0101 found end of file, expected `}`\n");
  CHECK(Parsed("metrics m { a = at end all {\n x > 1").messages() ==
        "2:7 P0101 found end of file, expected `}`\n");
}

TEST_CASE("a missing opening brace costs its declaration and no other") {
  const Parsed parsed("task a like b\n  source carrot\n  target c\n}\nset z = tasks\n");
  CHECK(parsed.messages() == "1:14 P0101 found end of line, expected `against` or `{`\n");
  CHECK(parsed.file().decls.size() == 2);
}

TEST_CASE("an unclosed string that swallowed a brace is one message") {
  const Parsed parsed("task c { say \"unclosed {x }\nset q = tasks\n");
  CHECK(parsed.messages() == "1:14 P0105 found end of line, expected `\"` to close the string\n");
  CHECK(parsed.file().decls.size() == 2);
}

TEST_CASE("an unknown declaration, a stray brace and a stray character are one message each") {
  CHECK(Parsed("tassk d {\n source x\n}\nset a = b").messages() ==
        "1:1 P0101 found `tassk`, expected a declaration\n");
  CHECK(Parsed("}\nset a = b").diagnostics.size() == 1);
  CHECK(Parsed("set a = $\nset b = c").diagnostics.size() == 1);
  CHECK(Parsed("set a = $\nset b = c").file().decls.size() == 2);
}

TEST_CASE("two declarations on one line are one message and both are kept") {
  const Parsed parsed("task x {} task y {}");
  CHECK(parsed.messages() == "1:11 P0101 found `task`, expected end of line\n");
  CHECK(parsed.file().decls.size() == 2);
}

TEST_CASE("a blank before a unit has a fix that removes it") {
  const Parsed parsed("object o { density 700 kg/m3; friction 1 }");
  CHECK(parsed.messages() == "1:24 P0301 found a blank before unit `kg/m3`\n");
  const Fix& fix = *parsed.diagnostics.items()[0].fix;
  CHECK(fix.message == "write `700kg/m3`");
  CHECK(parsed.text(fix.replacements[0].span) == " ");
  CHECK(Parsed("camera c { lens 1 px }").messages() ==
        "1:19 P0301 found a blank before unit `px`\n");
}

TEST_CASE("an unknown unit is not reported a second time by the grammar") {
  CHECK(Parsed("layout l {\n drop 5foot\n expect 2.5 episodes\n}").messages() ==
        "2:7 P0301 unknown unit `foot`\n3:9 P0101 found `2.5`, expected a whole number without "
        "unit\n");
  CHECK(Parsed("layout l { expect 2foot episodes }").messages() ==
        "1:19 P0301 unknown unit `foot`\n");
}

TEST_CASE("whole numbers have a range") {
  CHECK(Parsed("suite s { seeds 18446744073709551615 }").messages() == "");
  CHECK(Parsed("suite s { seeds 18446744073709551616 }").messages() ==
        "1:17 P0106 found `18446744073709551616`, expected at most 18446744073709551615\n");
}

TEST_CASE("a line that ends with a word of logic says how to go on") {
  const Parsed parsed("predicate p() = a and\n  b\n");
  REQUIRE(parsed.diagnostics.size() >= 1);
  CHECK(parsed.diagnostics.items()[0].helps[0] ==
        "an expression goes on over a line end only inside parentheses");
}

TEST_CASE("an empty block of conditions is reported") {
  CHECK(Parsed("predicate p() = all { }").messages() ==
        "1:17 P0101 found an empty block, expected one condition a line\n");
}

TEST_CASE("deep nesting is a diagnostic, in every recursive rule") {
  const auto many = [](const char* text, int n) {
    std::string out;
    for (int i = 0; i < n; ++i) out += text;
    return out;
  };
  const auto code = [](const std::string& text) {
    const Parsed parsed(text);
    REQUIRE_MESSAGE(parsed.diagnostics.size() == 1, parsed.messages().substr(0, 400));
    return std::string(info(parsed.diagnostics.items()[0].code).text);
  };
  constexpr int kDeep = 100000;
  const std::string predicate = "predicate p() = ";
  CHECK(code(predicate + many("(", kDeep)) == "P0103");
  CHECK(code(predicate + many("not ", kDeep) + "a") == "P0103");
  CHECK(code(predicate + many("-", kDeep) + "a") == "P0103");
  CHECK(code(predicate + "a" + many(" + a", kDeep)) == "P0103");
  CHECK(code(predicate + many("f(", kDeep)) == "P0103");
  CHECK(code(predicate + many("all {", kDeep)) == "P0103");
  CHECK(code(predicate + many("any x in a: ", kDeep) + "x") == "P0103");
  CHECK(code(predicate + "any x in " + many("(", kDeep)) == "P0103");
  CHECK(code("set a = " + many("(", kDeep)) == "P0103");
  CHECK(code("set a = " + many("variants of ", kDeep) + "b") == "P0103");
  CHECK(code("set a = b" + many(" | b", kDeep)) == "P0103");
  CHECK(code("set a = b where " + many("not ", kDeep) + "has x") == "P0103");
  CHECK(code("set a = b where has x" + many(" or has x", kDeep)) == "P0103");
  CHECK(code("object a { phrase p q \"r\" means " + many("(", kDeep)) == "P0103");
  CHECK(code("object a { phrase p q \"r\" means x" + many(" and x", kDeep) + " }") == "P0103");
  CHECK(Parsed(predicate + many("(", 150) + "a" + many(")", 150)).messages() == "");
}

TEST_CASE("a file of rubbish is given up after a bounded number of messages") {
  std::string text;
  for (int i = 0; i < 100000; ++i) text += "task } 5q {\n";
  const Parsed parsed(text);
  CHECK(parsed.diagnostics.size() <= kMaxSyntaxErrors);
  CHECK(parsed.diagnostics.items().back().code == Code::P0107);
}

TEST_CASE("a torn `start` or `sensor` costs its own line, and `none` is whole") {
  const Parsed parsed(
      "task a {\n  start\n  start cabinet\n  start cabinet.top\n  start none\n  start cabinet.top "
      "none\n}\n"
      "camera c {\n  sensor\n  sensor none\n}\n");
  CHECK(parsed.messages() ==
        "2:8 P0101 found end of line, expected `none` or a name\n"
        "3:16 P0101 found end of line, expected `.`\n"
        "4:20 P0101 found end of line, expected `none`, a name or a number\n"
        "9:9 P0101 found end of line, expected something else\n");
  REQUIRE(parsed.get<TaskDecl>().body.size() == 2);
  const auto& all = std::get<StartStmt>(parsed.get<TaskDecl>().body[0]);
  CHECK(all.none);
  CHECK(all.fixture.text.empty());
  const auto& one = std::get<StartStmt>(parsed.get<TaskDecl>().body[1]);
  CHECK(one.none);
  CHECK(one.joint.text == "top");
}

TEST_CASE("two things in a role of one, and words without quotes, are answered by what was meant") {
  const auto text = [](const std::string& task) {
    const Parsed parsed(task);
    return render_text(parsed.diagnostics, parsed.sources);
  };
  const std::string two = text("task a { source carrot, spoon; target plate }\n");
  CHECK_MESSAGE(two.find("help: one thing fills it; `role goods: set` declares a role that several "
                         "fill: `goods a, b`") != std::string::npos,
                two);
  const std::string words = text("task a { say put the carrot on the plate; target plate }\n");
  CHECK_MESSAGE(words.find("help: words stand in quotes: `say \"put {the source} on {the target}\"`") !=
                    std::string::npos,
                words);
  CHECK(text("task a { scene table, other }\n").find("help") == std::string::npos);
}
