// Texts that no author would write: each gives a diagnostic in bounded time, and the formatter
// leaves it alone.
#include <doctest/doctest.h>

#include <chrono>

#include "compiler/format/format.h"
#include "tests/compiler/small_suite.h"
#include "tests/dsl/tree_copy.h"

using namespace probe;
namespace fs = std::filesystem;

namespace {

std::string repeated(const std::string& text, std::size_t times) {
  std::string out;
  out.reserve(text.size() * times);
  for (std::size_t i = 0; i < times; ++i) out += text;
  return out;
}

// The codes said of a text, each once; formatted too, which may refuse and must not change tokens.
std::string codes_of(const std::string& text) {
  const auto start = std::chrono::steady_clock::now();
  const auto a = test::analyze_text(text);
  std::string codes;
  for (const Diagnostic& item : a->diagnostics.items()) {
    const std::string code(info(item.code).text);
    if (codes.find(code) == std::string::npos) codes += (codes.empty() ? "" : " ") + code;
    CHECK(item.primary.end <= text.size());
  }
  CHECK(a->said().size() < 200000);
  SourceSet sources;
  Diagnostics diagnostics;
  const FileId id = sources.add("t.probe", text);
  const auto once = format::format_file(sources, id, diagnostics);
  REQUIRE(once.ok());
  if (once->has_value()) {
    SourceSet again;
    const auto twice = format::format_file(again, again.add("t.probe", **once), diagnostics);
    REQUIRE(twice.ok());
    REQUIRE(twice->has_value());
    CHECK(**twice == **once);
  } else {
    CHECK(diagnostics.has_errors());
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  CHECK(seconds.count() < 120);  // well below a second alone: it ends, whatever else runs
  return codes;
}

}  // namespace

TEST_CASE("a file of 100 MB is refused by its size before it is read whole") {
  const fs::path folder = fs::temp_directory_path() / ("probe_big_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const std::string big = (folder / "big.probe").string(), user = (folder / "use.probe").string();
  test::overwrite(big, "task t {}\n");
  fs::resize_file(big, 100'000'000);
  test::overwrite(user, "use \"big.probe\"\n");
  for (const std::string& file : {big, user}) {
    const auto built = build(std::span<const std::string>(&file, 1), {test::asset_root(), ""});
    REQUIRE(built.ok());
    REQUIRE(!built->diagnostics.empty());
    CHECK(info(built->diagnostics.items()[0].code).text == "P0104");
    CHECK(built->sources.file(built->diagnostics.items()[0].primary.file).name() == big);
    CHECK(built->sources.file(FileId{0}).text().size() <= kMaxSourceBytes + 1);
  }
  SourceSet sources;
  Diagnostics diagnostics;
  const auto id = sources.load(big);
  REQUIRE(id.ok());
  const auto text = format::format_file(sources, *id, diagnostics);
  REQUIRE(text.ok());
  CHECK(!text->has_value());
  fs::remove_all(folder);
}

TEST_CASE("NUL bytes and bytes that are not UTF-8 are said with their place") {
  const std::string suite = test::kSmallSuite;
  CHECK(codes_of(suite + std::string("variant v of red_on_tray { say t\0ke }", 37)).find("P0102") !=
        std::string::npos);
  for (const char* bytes : {"\xff", "\xc0\xaf", "\xed\xa0\x80", "\xf5\x80\x80\x80", "\xe2\x82"}) {
    CHECK_MESSAGE(codes_of(suite + "# " + bytes + "\n").find("P0102") != std::string::npos,
                  static_cast<int>(bytes[0]));
    CHECK(codes_of(suite + "variant v of red_on_tray { say \"put " + bytes + "\" }\n")
              .find("P0102") != std::string::npos);
  }
}

TEST_CASE("CRLF and a byte order mark mean nothing; the formatter keeps them") {
  std::string crlf;
  for (const char c : std::string(test::kSmallSuite) + "variant v of red_on_tray { say take }\n") {
    if (c == '\n') crlf += '\r';
    crlf += c;
  }
  const auto a = test::analyze_text("\xef\xbb\xbf" + crlf);
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(a->task("v").prompt == "take the red block to the tray");
  CHECK(codes_of("\xef\xbb\xbf" + crlf) == "");
}

TEST_CASE("nesting bombs are a diagnostic") {
  const std::size_t deep = 100000;
  for (const std::string& bomb :
       {"predicate p() = " + repeated("(", deep), "predicate p() = " + repeated("not ", deep),
        "predicate p() = " + repeated("-", deep) + "1 > 0",
        "predicate p() = " + repeated("any {", deep), "set s = " + repeated("(", deep),
        "set s = " + repeated("variants of ", deep) + "tasks",
        "set s = " + repeated("sample 1 of ", deep) + "tasks",
        "set s = tasks where " + repeated("not ", deep) + "has baseline",
        "set s = tasks where " + repeated("(", deep),
        "predicate p() = " + repeated("all x in objects: ", deep) + "grip > 0.5",
        "predicate p() = " + repeated("all x in (", deep),
        "object o { phrase p appearance \"x\" means " + repeated("not ", deep) + "f }",
        "object o { phrase p appearance \"x\" means " + repeated("(", deep)}) {
    const std::string codes = codes_of(bomb);
    CHECK_MESSAGE(codes.find("P010") != std::string::npos, bomb.substr(0, 60), ": ", codes);
  }
  for (const std::string& bomb :
       {repeated("{", deep), repeated("task t { ", deep), repeated("((", deep), repeated("@", deep),
        repeated("@allow(a, \"b\") ", deep), repeated("\"", deep), repeated("}", deep)}) {
    CHECK_MESSAGE(!codes_of(bomb).empty(), bomb.substr(0, 20));
  }
}

TEST_CASE("long chains are no nesting: sums, lists and declarations may be long") {
  const std::string suite = test::kSmallSuite;
  std::string sum = "1", names = "red", objects;
  for (int i = 0; i < 2000; ++i) sum += " + 1";
  const std::string codes = codes_of(suite + "metrics m like plain { x = final height(source) * (" +
                                     sum + ") }\nvariant v of red_on_tray { metrics m }");
  // Either it is taken or one diagnostic says how long an expression may be.
  const bool said = codes.empty() || codes == "P0103";
  CHECK_MESSAGE(said, codes);
  std::string variants;
  for (int i = 0; i < 5000; ++i)
    variants += "variant v" + std::to_string(i) + " of red_on_tray { horizon " +
                std::to_string(i + 61) + " steps }\n";
  CHECK(codes_of(suite + variants) == "");
}

TEST_CASE("circles of like, against and sets, and chains of like, are said or taken") {
  const std::string suite = test::kSmallSuite;
  for (const char* circle :
       {"task a like b {}\ntask b like c {}\ntask c like a {}\n",
        "object a like b {}\nobject b like a {}\n", "scene a like a {}\n",
        "camera a like b {}\ncamera b like a {}\n", "layout a like b {}\nlayout b like a {}\n",
        "metrics a like b {}\nmetrics b like a {}\n", "set a = b | c\nset b = a\nset c = a\n",
        "variant a of b { say take }\nvariant b of a { light night }\n"}) {
    CHECK_MESSAGE(codes_of(suite + circle).find("P0207") != std::string::npos, circle);
  }
  CHECK(codes_of(suite + "task a like red_on_tray against b { say take }\n"
                         "task b like red_on_tray against c { light night }\n"
                         "task c like red_on_tray against a { horizon 61 steps }\n") == "P0703");
  CHECK(codes_of(suite + "task a like red_on_tray against a { say take }\n") == "P0703");
  std::string chain = "task t0 like red_on_tray {}\n";
  for (int i = 1; i < 3000; ++i)
    chain += "task t" + std::to_string(i) + " like t" + std::to_string(i - 1) + " {}\n";
  CHECK(codes_of(suite + chain) == "");
}

TEST_CASE("expansions beyond the limits are said once and stopped") {
  const std::string suite = test::kSmallSuite;
  std::string derives;
  for (int i = 0; i < 24; ++i)
    derives += "derive \"{t}_" + std::to_string(i) + "\" for t in tasks { horizon " +
               std::to_string(i + 61) + " steps }\n";
  CHECK(codes_of(suite + derives).find("P0210") != std::string::npos);
  CHECK(codes_of(suite +
                 "layout l like pairs { cells spots = grid 1000 x 1000 at (0cm, 0cm) spread "
                 "(10cm, 10cm) }\nvariant v of red_on_tray { layout l }\n") == "P0210");
  CHECK(codes_of(suite + "layout l like pairs { cells spots = grid 100000 x 1 at (0cm, 0cm) spread "
                         "(10cm, 10cm) }\nvariant v of red_on_tray { layout l }\n")
            .find("P0304") != std::string::npos);
  CHECK(codes_of(suite + "set s = sample 18446744073709551615 of tasks seed 1\n") == "P0304");
  CHECK(codes_of(suite + "set s = sample 99999999999999999999 of tasks seed 1\n") == "P0106");
}

TEST_CASE("predicates that double at each level are looked at in bounded time") {
  for (const char* twice : {"p and p", "(p for 2 steps) and (p for 3 steps)"}) {
    std::string text =
        test::kSmallSuite + std::string("predicate p0(a: object) = height(a) > 1m\n");
    for (int i = 1; i < 40; ++i) {
      std::string body = twice;
      for (std::size_t at = 0; (at = body.find("p ", at)) != std::string::npos; ++at)
        body.replace(at, 1, "p" + std::to_string(i - 1) + "(a)");
      if (body.ends_with(" p"))
        body.replace(body.size() - 1, 1, "p" + std::to_string(i - 1) + "(a)");
      text += "predicate p" + std::to_string(i) + "(a: object) = " + body + "\n";
    }
    text +=
        "metrics m like plain { x = at end p39(source) }\nvariant v of red_on_tray { metrics m }\n";
    const fs::path file =
        fs::temp_directory_path() / ("probe_doubling_" + std::to_string(getpid()) + ".probe");
    test::overwrite(file, text);
    const std::string name = file.string();
    const auto built = build(std::span<const std::string>(&name, 1), {test::asset_root(), ""});
    fs::remove(file);
    REQUIRE(built.ok());
    CHECK_MESSAGE(!built->ok, twice);
    const std::string said = render_text(built->diagnostics, built->sources);
    CHECK_MESSAGE(said.find("P0601") != std::string::npos, said);
  }
}
