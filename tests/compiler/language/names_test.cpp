// Every name of every text that we ship, and which it is.
#include <doctest/doctest.h>

#include <filesystem>

#include "compiler/language/hover.h"
#include "compiler/language/snapshot.h"

using namespace probe;
using namespace probe::language;
namespace fs = std::filesystem;

namespace {

const Setting kSetting{VLAPROBE_SOURCE_DIR "/assets",
                       {VLAPROBE_SOURCE_DIR "/dsl", VLAPROBE_SOURCE_DIR}};

std::unique_ptr<Snapshot> of_text(const std::string& text) {
  return Snapshot::analysed("t.probe", {{"t.probe", text}}, kSetting);
}

// Where the name at the nth `word` is declared, as lines from 1.
std::string declared_at(const Snapshot& snapshot, const std::string& word, std::size_t behind) {
  const std::string_view text = snapshot.text(snapshot.root());
  const auto at = static_cast<std::uint32_t>(text.find(word) + behind);
  std::string lines;
  for (const Span& span : definitions(snapshot, snapshot.root(), at)) {
    lines += (lines.empty() ? "" : " ") +
             std::to_string(snapshot.lines(span.file).position(span.begin).line + 1);
  }
  return lines;
}

}  // namespace

TEST_CASE("in texts without a mistake every name stands for something") {
  for (const std::string name :
       {"suite/intact.probe", "suite/beyond.probe", "suite/kitchen.probe",
        "suite/kitchen_variants.probe", "suite/kitchen_beyond.probe", "suite/semantics.probe",
        "examples/roles.probe", "examples/drawer.probe", "examples/put_away.probe",
        "examples/spatial.probe"}) {
    CAPTURE(name);
    const auto snapshot =
        Snapshot::analysed((fs::path(VLAPROBE_SOURCE_DIR) / name).string(), {}, kSetting);
    REQUIRE(snapshot != nullptr);
    REQUIRE_FALSE(snapshot->diagnostics().has_errors());
    std::size_t unknown = 0;
    std::string first;
    for (const syntax::ParseResult& file : snapshot->files()) {
      for (const Place& place : snapshot->index().places(file.file.id)) {
        if (snapshot->index().symbol(place)) continue;
        // Of what `derive` makes no text declares the name; sets of the language, joints and the
        // one mesh that stands are no declarations either.
        const bool is_derived = place.may_be.has(Kind::kTask) && snapshot->task(place.text);
        const bool is_own = place.may_be.has(Kind::kMember) || place.may_be.has(Kind::kView) ||
                            place.may_be.has(Kind::kRole) || place.may_be.has(Kind::kSet) ||
                            place.text == "none";
        if (is_derived || is_own || place.text == "surface") continue;
        if (unknown++ == 0) first = std::string(place.text);
      }
    }
    CAPTURE(first);
    CHECK(unknown == 0);
  }
}

TEST_CASE("a name is declared where its kind is, and a variable in its own predicate") {
  const auto snapshot = of_text(
      "attribute color { red }\n"
      "object red { color red }\n"
      "predicate near(a: object, d: length = 2cm) = distance(a, source) < d\n"
      "predicate far(a: object) = not near(a, 9cm) and no b in objects: near(b, 1cm)\n");
  CHECK(declared_at(*snapshot, "color red", 6) == "1");
  CHECK(declared_at(*snapshot, "object red", 7) == "2");
  CHECK(declared_at(*snapshot, "distance(a", 9) == "3");
  CHECK(declared_at(*snapshot, "not near", 4) == "3");
  CHECK(declared_at(*snapshot, "near(a, 9cm", 5) == "4");
  CHECK(declared_at(*snapshot, "near(b", 5) == "4");
  CHECK(declared_at(*snapshot, "source", 0).empty());
}

TEST_CASE(
    "behind an attribute stands its value, whatever object is called so; behind a relation an "
    "object") {
  const auto snapshot = of_text(
      "attribute color { orange, red }\nobject orange { color orange }\n"
      "relation left_of(a: object, b: object) \"left of\" = distance(a, b) < 1cm\n"
      "object other {\n  phrase p appearance \"x\" means color orange\n"
      "  phrase q spatial \"y\" means left_of orange\n}\n");
  REQUIRE(snapshot != nullptr);
  CHECK(declared_at(*snapshot, "means color orange", 12) == "1");
  CHECK(declared_at(*snapshot, "means left_of orange", 14) == "2");
}

TEST_CASE("hovers tell what a measure is, what a number measures, and the essay of a mistake") {
  const auto snapshot =
      of_text("object mug { density 500 }\npredicate p() = height(source) > 1m\n");
  const std::string_view text = snapshot->text(snapshot->root());
  std::vector<const Diagnostic*> said;
  for (const Diagnostic& item : snapshot->diagnostics().items()) said.push_back(&item);
  const auto at = [&](const char* word) {
    return hover(*snapshot, snapshot->root(), static_cast<std::uint32_t>(text.find(word)), said)
        .value_or(Hover{{}, ""})
        .text;
  };
  CHECK(at("height").find("z of a point") != std::string::npos);
  CHECK(at("500").find("`density` takes a density") != std::string::npos);
  CHECK(at("500").find("P0302") != std::string::npos);
}
