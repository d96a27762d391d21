#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/diag/json.h"
#include "compiler/diag/text.h"
#include "tests/compiler/syntax/parse_helper.h"

using namespace probe;
using namespace probe::syntax;

namespace {

// A bit of everything that the suites and examples lack.
constexpr const char* kSample = R"(# a comment
dataset b "B" { relations carrot on plate }
attribute color { orange, red }
object carrot {
  mesh "m"; box 11.5cm x 3.2cm x 3.8cm; density 700kg/m3
  color orange; rest yaw 180deg, yaw -90deg; seen in b
  phrase p appearance "orange object" means color orange and not (color red or f)
}
robot w { fingers l opens +y, r opens -y; drive a, b stiffness 1Nm/rad damping 2Nms/rad limit 3Nm }
scene s { robot w at (1cm, 2cm) yaw 180deg; surface 87cm area (-34cm, -20cm) .. (4cm, 20cm) }
layout l { cells c = grid 2 x 2 at (0cm, 0cm) spread (1cm, 1cm), (2cm, 2cm) }
predicate p(a: object, s: length = 3mm) = all {
  any f in fingers - {a}: impulse(f, a) >= 1e-6Ns and a
  height(a) - s * 2 <= 2cm for 5 steps
}
## documented
@allow(confounded, "why")
variants of t { x { say "put {the source: drink}" } }
set core = { a, b } - variants of (c | d) where not has distractors or axis language.action
suite q trained on b { tasks core; seeds 42, 7; expect 4 tasks, 96 episodes }
)";

std::vector<std::string> corpus() {
  std::vector<std::string> out;
  for (const char* folder : {"suite", "examples"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(VLAPROBE_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".probe") continue;
      std::ifstream stream(entry.path(), std::ios::binary);
      std::ostringstream text;
      text << stream.rdbuf();
      out.push_back(text.str());
    }
  }
  REQUIRE(out.size() > 20);
  std::sort(out.begin(), out.end());
  out.emplace_back(kSample);
  return out;
}

// Cuts, doubles, flips or inserts something somewhere.
void edit(std::string& text, std::mt19937& random) {
  static constexpr const char* kPieces[] = {
      "{", "}",  "(",  ")",    "\"",   "\n",       ";",     "\\",   "#",
      "@", "..", "2x", "5cmx", "\xff", "\xc3\xa9", "\r\n",  "not ", "task ",
      "=", "-",  ",",  "1e",   ".5",   "\t",       "all {", "{a}",  "set x = "};
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % (n + 1)); };
  const std::size_t at = below(text.size());
  switch (random() % 4) {
    case 0:
      text.erase(at, below(20));
      break;
    case 1:
      text.insert(at, text.substr(below(text.size()), below(30)));
      break;
    case 2:
      if (at < text.size()) text[at] = static_cast<char>(random() % 256);
      break;
    default:
      text.insert(at, kPieces[random() % std::size(kPieces)]);
      break;
  }
}

// Spans lie in the file and the tokens give it back.
void check_whole(const SourceSet& sources, const ParseResult& result,
                 const Diagnostics& diagnostics) {
  const std::size_t size = sources.file(result.file.id).text().size();
  REQUIRE(to_text(result.tokens, sources) == sources.file(result.file.id).text());
  for (const Decl& decl : result.file.decls) {
    const bool inside = decl.span.begin <= decl.span.end && decl.span.end <= size;
    REQUIRE(inside);
  }
  for (const Diagnostic& item : diagnostics.items()) {
    const bool inside = item.primary.begin <= item.primary.end && item.primary.end <= size;
    REQUIRE(inside);
  }
}

}  // namespace

TEST_CASE("a number without its zero before `x` comes back byte for byte") {
  SourceSet sources;
  Diagnostics diagnostics;
  const FileId id = sources.add("grid.probe", "layout l { cells c = grid 2 .5x 2 }");
  check_whole(sources, parse(sources, id, diagnostics), diagnostics);
}

TEST_CASE(
    "the suites and the example programs parse without a message and come back byte for byte") {
  for (const std::string& text : corpus()) {
    const Parsed parsed(text);
    CHECK(parsed.messages() == "");
    CHECK(parsed.file().decls.size() > 0);
  }
}

TEST_CASE("random edits never crash the parser or the renderers, and no byte is lost") {
  std::mt19937 random(20240607);
  const std::vector<std::string> texts = corpus();
  std::size_t messages = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string text = texts[static_cast<std::size_t>(round) % texts.size()];
    const unsigned edits = 1 + random() % 4;
    for (unsigned i = 0; i < edits; ++i) edit(text, random);
    SourceSet sources;
    Diagnostics diagnostics;
    const FileId id = sources.add("edited.probe", std::move(text));
    const ParseResult result = parse(sources, id, diagnostics);
    check_whole(sources, result, diagnostics);
    CHECK(result.ok == !diagnostics.has_errors());
    messages += diagnostics.size();
    if (round % 10 == 0) {
      CHECK(!render_text(diagnostics, sources).empty() == !diagnostics.empty());
      CHECK(!render_json(diagnostics, sources).empty());
    }
  }
  // One mistake gives about one message: 2.5 edits a round, of which some are harmless.
  CHECK(messages < 3000 * 4);
  MESSAGE("messages for 3000 rounds of 1 to 4 edits: ", messages);
}

TEST_CASE("every prefix of a text is parsed") {
  const std::string text = kSample;
  for (std::size_t size = 0; size < text.size(); ++size) {
    SourceSet sources;
    Diagnostics diagnostics;
    const FileId id = sources.add("prefix.probe", text.substr(0, size));
    check_whole(sources, parse(sources, id, diagnostics), diagnostics);
    CHECK(diagnostics.size() <= 3);
  }
}

TEST_CASE("large texts take time in proportion") {
  std::string text;
  while (text.size() < (std::size_t{2} << 20u)) text += kSample;
  SourceSet sources;
  Diagnostics diagnostics;
  const FileId id = sources.add("large.probe", std::move(text));
  const auto start = std::chrono::steady_clock::now();
  const ParseResult result = parse(sources, id, diagnostics);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  CHECK(result.ok);
  CHECK(seconds.count() < 120);  // about 50 ms: it ends, whatever else runs
  MESSAGE("2 MiB parsed in ", seconds.count() * 1e3, " ms");
}

TEST_CASE("one very long line with many mistakes is drawn in bounded space") {
  std::string text = "set a = ";
  for (int i = 0; i < 200000; ++i) text += "$ ";
  SourceSet sources;
  Diagnostics diagnostics;
  const FileId id = sources.add("line.probe", std::move(text));
  CHECK(!parse(sources, id, diagnostics).ok);
  CHECK(diagnostics.size() <= kMaxSyntaxErrors);
  CHECK(render_text(diagnostics, sources).size() < 100000);
}
