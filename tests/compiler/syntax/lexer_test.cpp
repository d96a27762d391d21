#include "compiler/syntax/lexer.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "compiler/diag/text.h"
#include "compiler/syntax/parser.h"

using namespace probe;
using namespace probe::syntax;

namespace {

struct Lexed {
  SourceSet sources;
  Diagnostics diagnostics;
  LexResult result;

  explicit Lexed(std::string text) {
    const FileId id = sources.add("t.probe", std::move(text));
    ErrorBudget errors(diagnostics, kMaxSyntaxErrors);
    result = lex(sources.file(id), id, errors);
    CHECK(to_text(result.stream, sources) == sources.file(id).text());
  }

  // Texts of the tokens that are no trivia, without the end.
  std::vector<std::string> words() const {
    std::vector<std::string> out;
    for (const Token& token : result.stream.tokens) {
      if (is_trivia(token.kind) || token.kind == TokenKind::kEnd) continue;
      out.emplace_back(sources.text({result.stream.file, token.begin, token.end}));
    }
    return out;
  }
  const Token& token(std::size_t n) const {
    for (const Token& candidate : result.stream.tokens) {
      if (!is_trivia(candidate.kind) && n-- == 0) return candidate;
    }
    FAIL("no such token");
    return result.stream.tokens.front();
  }
  std::string messages() const {
    std::string out;
    for (const Diagnostic& item : diagnostics.items()) {
      out += std::string(info(item.code).text) + " " + item.message + "\n";
    }
    return out;
  }
};

using Words = std::vector<std::string>;

}  // namespace

TEST_CASE("every unit is read with its number, the longest one wins") {
  for (const char* unit : {"m", "cm", "mm", "s", "ms", "Hz", "kg/m3", "N", "Nm", "N/m", "Nm/rad",
                           "Ns/m", "Nms/rad", "Ns", "px", "deg", "rad"}) {
    const Lexed lexed("1.5" + std::string(unit) + " x");
    CHECK(lexed.words() == Words{"1.5" + std::string(unit), "x"});
    CHECK(to_text(lexed.token(0).unit) == unit);
    CHECK(lexed.diagnostics.empty());
  }
}

TEST_CASE("a slash after a unit divides unless the whole is a unit") {
  CHECK(Lexed("5cm/2").words() == Words{"5cm", "/", "2"});
  CHECK(Lexed("5N/m").words() == Words{"5N/m"});
  CHECK(Lexed("5m/x").words() == Words{"5m", "/", "x"});
}

TEST_CASE("decimals keep their exponent and never eat two points") {
  CHECK(Lexed("1e-6Ns 2E3 4e 0.2604").words() == Words{"1e-6Ns", "2E3", "4e", "0.2604"});
  CHECK(Lexed("12..62 a.b").words() == Words{"12", "..", "62", "a", ".", "b"});
  CHECK(Lexed("-7.5cm").words() == Words{"-", "7.5cm"});
  CHECK(Lexed("4e").messages() == "P0301 unknown unit `e`\n");
}

TEST_CASE("a point without a digit before it is mended") {
  const Lexed lexed("friction .5");
  CHECK(lexed.words() == Words{"friction", ".5"});
  CHECK(lexed.messages() == "P0101 found `.5`, expected a digit before the point\n");
  CHECK(lexed.diagnostics.items()[0].fix->replacements[0].text == "0");
}

TEST_CASE("an unknown unit is reported once and its number is kept") {
  const Lexed lexed("5Cm");
  CHECK(lexed.messages() == "P0301 unknown unit `Cm`\n");
  CHECK(lexed.token(0).unit == Unit::kUnknown);
  CHECK(Lexed("3miles").messages() == "P0301 unknown unit `miles`\n");
}

TEST_CASE("a product without blanks is one report with a fix, read as if it had blanks") {
  const Lexed grid("grid 2x2 at");
  CHECK(grid.words() == Words{"grid", "2", "x", "2", "at"});
  CHECK(render_text(grid.diagnostics, grid.sources) == R"(error[P0301]: unknown unit `x`
 --> t.probe:1:6
  |
1 | grid 2x2 at
  |      ^^^ a unit touches its number
  |
  = help: write `2 x 2`
)");
  const Lexed box("box 11.5cmx3.2cmx3.8cm;");
  CHECK(box.words() == Words{"box", "11.5cm", "x", "3.2cm", "x", "3.8cm", ";"});
  REQUIRE(box.diagnostics.size() == 1);
  CHECK(box.diagnostics.items()[0].fix->message == "write `11.5cm x 3.2cm x 3.8cm`");
  const Lexed half("2x 2");
  CHECK(half.words() == Words{"2", "x", "2"});
  CHECK(half.diagnostics.items()[0].fix->message == "write `2 x`");
  CHECK(Lexed("2x2..3x").words().front() == "2x2");
}

TEST_CASE("comments, documentation, blanks and every line ending are trivia") {
  const Lexed lexed(
      "\xef\xbb\xbf"
      "a # one\r\n## two\n### ruler\n\tb\r");
  CHECK(lexed.words() == Words{"a", "b"});
  CHECK(lexed.diagnostics.empty());
  int docs = 0, newlines = 0;
  for (const Token& token : lexed.result.stream.tokens) {
    docs += token.kind == TokenKind::kDocComment;
    newlines += token.kind == TokenKind::kNewline;
  }
  CHECK(docs == 1);
  CHECK(newlines == 3);
}

TEST_CASE("a string ends with its line when its quote is missing") {
  const Lexed lexed("name \"carrot\nbox \"a\\\"b\"");
  CHECK(lexed.words() == Words{"name", "\"carrot", "box", "\"a\\\"b\""});
  CHECK(lexed.messages() == "P0105 found end of line, expected `\"` to close the string\n");
  CHECK(Lexed("\"abc\\").messages() ==
        "P0105 found end of line, expected `\"` to close the string\n");
  CHECK(Lexed("\"").words() == Words{"\""});
}

TEST_CASE("only three escapes are known") {
  CHECK(Lexed(R"("\n \\ \"")").diagnostics.empty());
  CHECK(Lexed(R"("a\tb")").messages() == "P0105 found `\\t`, expected `\\\"`, `\\\\` or `\\n`\n");
}

TEST_CASE("stray characters are reported once a run with a hint") {
  const Lexed lexed("color $$$ caf\xc3\xa9 'x'");
  CHECK(lexed.words() == Words{"color", "caf"});
  CHECK(lexed.diagnostics.size() == 3);
  CHECK(Lexed("a ! b").diagnostics.items()[0].helps[0] == "negation is written `not`");
}

TEST_CASE("text that is not UTF-8, holds a NUL byte or is UTF-16 is refused as a whole") {
  const auto code = [](std::string text) {
    const Lexed lexed(std::move(text));
    CHECK(lexed.result.unreadable);
    return lexed.messages();
  };
  CHECK(code(std::string("set a\0 = b", 10)) == "P0102 found a NUL byte, expected UTF-8 text\n");
  CHECK(code("set \xff") == "P0102 found byte 0xff, expected UTF-8 text\n");
  CHECK(code("set \xc3") == "P0102 found byte 0xc3, expected UTF-8 text\n");
  CHECK(code("# \xed\xa0\x80") == "P0102 found byte 0xed, expected UTF-8 text\n");
  CHECK(code("\xc0\x80") == "P0102 found byte 0xc0, expected UTF-8 text\n");
  CHECK(code(std::string("\xff\xfes\0e\0t\0", 8)) ==
        "P0102 found byte 0xff, expected UTF-8 text\n");
  CHECK(!Lexed("# \xf0\x9f\xa5\x95 \xe4\xb8\xad\n").result.unreadable);
}

TEST_CASE("a text that is too large is one diagnostic") {
  const Lexed lexed(std::string(kMaxSourceBytes + 100, 'a'));
  CHECK(lexed.messages() == "P0104 found more than 16 MiB, expected the text of a suite\n");
}
