#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "compiler/check/analyze.h"
#include "compiler/diag/text.h"
#include "compiler/syntax/parser.h"

using namespace probe;

namespace {

// The suite as one text: whatever is wrong after an edit is then wrong in the edited file.
std::string suite_text() {
  std::string out;
  for (const char* name : {"catalog", "stage", "layouts", "manipulation", "language", "intact"}) {
    std::ifstream stream(std::string(VLAPROBE_SOURCE_DIR "/suite/") + name + ".probe",
                         std::ios::binary);
    for (std::string line; std::getline(stream, line);) {
      if (!line.starts_with("use ")) out += line + "\n";
    }
  }
  return out;
}

// What a slip of the hand does.
void edit(std::string& text, std::mt19937& random) {
  static constexpr const char* kPieces[] = {"{",    "}",   "(",     ")", "\"", "\n",  ";",
                                            ",",    "2x",  "cm",    "-", "0",  "1e9", "_",
                                            "not ", "of ", "like ", "=", "@"};
  const std::size_t at = random() % (text.size() + 1);
  switch (random() % 5) {
    case 0:
      text.erase(at, 1 + random() % 12);
      break;
    case 1:
      text.insert(at, text.substr(random() % text.size(), random() % 40));
      break;
    case 2:
      if (at + 1 < text.size()) std::swap(text[at], text[at + 1]);
      break;
    case 3: {  // a line less
      const std::size_t begin = text.rfind('\n', at == 0 ? 0 : at - 1);
      const std::size_t end = text.find('\n', at);
      if (begin != std::string::npos && end != std::string::npos) text.erase(begin, end - begin);
      break;
    }
    default:
      text.insert(at, kPieces[random() % std::size(kPieces)]);
      break;
  }
}

struct Checked {
  SourceSet sources;
  Diagnostics diagnostics;

  explicit Checked(const std::string& text) {
    const FileId id = sources.add("suite.probe", text);
    const syntax::ParseResult parsed = syntax::parse(sources, id, diagnostics);
    model = sema::analyze(sources, {&parsed.file}, VLAPROBE_SOURCE_DIR "/assets", diagnostics);
  }
  sema::Model model;
};

}  // namespace

TEST_CASE("the suite as one text has no errors") {
  const Checked checked(suite_text());
  CHECK_MESSAGE(!checked.diagnostics.has_errors(),
                render_text(checked.diagnostics, checked.sources));
}

TEST_CASE("a thousand random edits of the suite compile or say where they do not") {
  const std::string suite = suite_text();
  std::mt19937 random(42);
  std::size_t clean = 0;
  for (int round = 0; round < 1000; ++round) {
    std::string text = suite;
    for (unsigned i = 0; i < 1 + random() % 3; ++i) edit(text, random);
    const Checked checked(text);
    clean += checked.diagnostics.has_errors() ? 0 : 1;
    for (const Diagnostic& item : checked.diagnostics.items()) {
      const bool inside = !item.primary.is_none() && item.primary.begin <= item.primary.end &&
                          item.primary.end <= text.size();
      REQUIRE_MESSAGE(inside, item.message);
      for (const Label& label : item.labels) {
        REQUIRE(!label.span.is_none());
        REQUIRE(label.span.end <= text.size());
      }
    }
    if (round % 20 == 0) {
      CHECK(render_text(checked.diagnostics, checked.sources).empty() ==
            checked.diagnostics.empty());
    }
  }
  CHECK(clean > 50);  // edits of comments and numbers
  CHECK(clean < 800);
}
