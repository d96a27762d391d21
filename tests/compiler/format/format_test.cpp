#include "compiler/format/format.h"

#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/diag/text.h"

using namespace probe;

namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// The formatted text; "" with a message when it does not parse.
std::string formatted(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  const FileId id = sources.add("t.probe", text);
  const auto result = format::format_file(sources, id, diagnostics);
  REQUIRE_MESSAGE(result.ok(), text);
  REQUIRE_MESSAGE(result->has_value(), render_text(diagnostics, sources));
  return **result;
}

void check_stays(const std::string& text) { CHECK(formatted(text) == text); }

void check_becomes(const std::string& text, const std::string& wanted) {
  CHECK(formatted(text) == wanted);
  CHECK(formatted(wanted) == wanted);
}

std::vector<std::string> corpus() {
  std::vector<std::string> texts;
  const fs::path root(VLAPROBE_SOURCE_DIR);
  for (const fs::path& folder :
       {root / "suite", root / "suite/libero", root / "examples", root / "dsl/std",
        root / "tests/golden", root / "../shared/design/examples"}) {
    if (!fs::is_directory(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ".probe") texts.push_back(read(entry.path()));
    }
  }
  return texts;
}

bool parses(const std::string& text) {
  SourceSet sources;
  Diagnostics diagnostics;
  return syntax::parse(sources, sources.add("t.probe", text), diagnostics).ok;
}

}  // namespace

TEST_CASE("blanks become one, indents two, statements keep their lines") {
  check_becomes(
      "layout   l{\n cells c=grid 2 x 2 at(-16cm,0cm)spread(1cm,1cm)\n\n\n\tplace source,target in "
      "distinct c ;\n}\n",
      "layout l {\n  cells c = grid 2 x 2 at (-16cm, 0cm) spread (1cm, 1cm)\n\n  place source, "
      "target in distinct c\n}\n");
  check_becomes("object o{mesh\"m\";unseen;;is a,b}", "object o { mesh \"m\"; unseen; is a, b }\n");
  check_becomes("light l {}\nlight m {\n}", "light l {}\nlight m {}\n");
}

TEST_CASE("signs and calls touch, operators do not") {
  check_becomes(
      "predicate p (a:object,s:length=3mm)=all x in bodies-{ a }:impulse( a ,x )*-2>=-1e-6Ns and "
      "not(a)\nrobot r { fingers l opens + y }\n",
      "predicate p(a: object, s: length = 3mm) = all x in bodies - {a}: impulse(a, x) * -2 >= "
      "-1e-6Ns and not (a)\nrobot r { fingers l opens +y }\n");
  check_becomes("predicate p()=all x in { c . top ,c.low }|whole c . door:q(x)\n",
                "predicate p() = all x in {c.top, c.low} | whole c.door: q(x)\n");
  check_stays("set a = { b, c } | (variants of d - { e }) where not (axis language.action)\n");
}

TEST_CASE("comments stay where they are") {
  check_stays(
      "# about the file\n\n## about the task\n@allow(confounded, \"why\")\ntask t like b {  # "
      "here\n  # a line\n  source o  # short\n  say s     # aligned\n  # last\n}\n# end\n");
  check_becomes("set a = # why\n   b |   # first\n # between\n c",
                "set a =  # why\n  b |    # first\n  # between\n  c\n");
  check_becomes("set a = {  # names\n b,\n c   \n  # no more\n}",
                "set a = {  # names\n  b,\n  c\n  # no more\n}\n");
}

TEST_CASE("an @allow stands on its own line") {
  check_becomes("variants of b {\n @allow(confounded,\"x\") c { light l }\nd { light l } }",
                "variants of b {\n  @allow(confounded, \"x\")\n  c { light l }\n  d { light l }\n}\n");
  check_becomes("@allow(unused,\"x\")@allow(latch,\"y\") set a = b",
                "@allow(unused, \"x\")\n@allow(latch, \"y\")\nset a = b\n");
}

TEST_CASE("columns that the author lined up stay lined up, others are left alone") {
  check_stays("set core   = a\nset longer = b\n");
  check_becomes("set core     = a\nset longer   = b\nset x = c\n",
                "set core   = a\nset longer = b\nset x      = c\n");
  check_stays("set core = a\nset longer = b\n");
  check_becomes("set  core = a\nset longer = b\n", "set core = a\nset longer = b\n");
  check_stays("set longer = a\nset other  = b\nset apart_by_a_very_long_name = c\n");
  check_stays("template put  frame put  \"a\"\ntemplate take frame take \"b\"\n");
}

TEST_CASE("a block that does not fit on its line is opened, its statements fill lines") {
  const std::string statements =
      "scene table; layout grid; metrics strict; say put; horizon 60 steps; source carrot; target "
      "plate";
  check_becomes("task a_task_with_quite_a_long_name like on_table { " + statements + " }",
                "task a_task_with_quite_a_long_name like on_table {\n  " + statements + "\n}\n");
  check_becomes("task t { " + statements + "; distractors one, two, three, four }",
                "task t {\n  " + statements + "\n  distractors one, two, three, four\n}\n");
}

TEST_CASE("long expressions break at commas and operators, never where a line end would count") {
  std::string names, wide = "predicate p(a: object) = (touches(a)";
  for (int i = 0; i < 40; ++i) names += (i > 0 ? ", name_" : "name_") + std::to_string(i);
  for (int i = 0; i < 20; ++i) wide += " and moved_far_away(a, " + std::to_string(i) + "cm)";
  for (const std::string& text : {"facts { " + names + " }", "set s = { " + names + " }",
                                  "object o { is " + names + " }", wide + ")"}) {
    const std::string out = formatted(text);
    CHECK(formatted(out) == out);
    std::istringstream lines(out);
    for (std::string line; std::getline(lines, line);) CHECK_MESSAGE(line.size() <= 120, line);
  }
  std::string query = "object o { phrase p look \"x\" means a";
  for (int i = 0; i < 40; ++i) query += " and a";
  const std::string unbreakable = formatted(query + " }");
  CHECK(unbreakable.find(query.substr(query.find("phrase")) + "\n") != std::string::npos);
}

TEST_CASE("line ends of Windows and a byte order mark become plain") {
  check_becomes("\xef\xbb\xbfset a = b\r\n\r\n# c \r\nset d = e\r\n",
                "set a = b\n\n# c\nset d = e\n");
}

TEST_CASE("the programs at hand are stable under formatting") {
  for (const std::string& text : corpus()) {
    if (!parses(text)) continue;
    const std::string once = formatted(text);
    CHECK(formatted(once) == once);
  }
}

TEST_CASE("the suite, the examples and the library stand in canonical layout") {
  const fs::path root(VLAPROBE_SOURCE_DIR);
  for (const fs::path& folder :
       {root / "suite", root / "suite/libero", root / "examples", root / "dsl/std"}) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() != ".probe") continue;
      const std::string text = read(entry.path());
      CHECK_MESSAGE(formatted(text) == text, entry.path().string());
    }
  }
}

TEST_CASE("whatever blanks and line ends are strewn into a program, one layout is a fixed point") {
  std::mt19937 random(7);
  const std::vector<std::string> texts = corpus();
  REQUIRE(!texts.empty());
  static constexpr const char* kStrewn[] = {" ",     "   ", "\n",       "\n\n\n", ";",  "\n  ",
                                            "# c\n", "\t",  " # d\n\n", "\r\n",   ";\n"};
  std::size_t formatted_count = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string text = texts[static_cast<std::size_t>(round) % texts.size()];
    for (unsigned i = 0; i < 1 + random() % 6; ++i) {
      const std::size_t at = random() % (text.size() + 1);
      switch (random() % 3) {
        case 0:
          text.insert(at, kStrewn[random() % std::size(kStrewn)]);
          break;
        case 1:  // a line end less
          if (const auto end = text.find('\n', at); end != std::string::npos) text[end] = ' ';
          break;
        default:  // a bracket with its inside on lines of its own
          if (const auto open = text.find_first_of("({,", at); open != std::string::npos)
            text.insert(open + 1, "\n");
          break;
      }
    }
    if (!parses(text)) continue;
    const std::string once = formatted(text);
    REQUIRE_MESSAGE(formatted(once) == once, text);
    ++formatted_count;
  }
  CHECK(formatted_count > 500);
}

TEST_CASE("bombs are formatted in bounded time") {
  const auto start = std::chrono::steady_clock::now();
  std::string flat = "object o { rest ", deep = "set a = ", many = "facts { a";
  for (int i = 0; i < 100000; ++i) flat += "yaw 1deg ";
  for (int i = 0; i < 190; ++i) deep += "(";
  deep += "b" + std::string(190, ')');
  for (int i = 0; i < 200000; ++i) many += ", b";
  for (const std::string& text : {flat + "}", deep, many + " }", std::string(100000, '\n'),
                                  std::string(100000, ';'), std::string(100000, '#')}) {
    const std::string once = formatted(text);
    CHECK(formatted(once) == once);
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  CHECK(seconds.count() < 120);
}

TEST_CASE("a text with errors is not formatted") {
  SourceSet sources;
  Diagnostics diagnostics;
  for (const std::string text : {"set = ", "\xff", "task t {"}) {
    const FileId id = sources.add("bad.probe", text);
    const auto result = format::format_file(sources, id, diagnostics);
    REQUIRE(result.ok());
    CHECK(!result->has_value());
  }
  CHECK(diagnostics.error_count() == 3);
}
