#include "compiler/diag/diagnostic.h"
#include "runtime/base/spelling.h"

#include <doctest/doctest.h>

#include <array>
#include <set>
#include <string>

using namespace probe;

TEST_CASE("every code has one line in the table, warnings have a word for @allow") {
  std::set<std::string_view> slugs;
  for (const Code code : all_codes()) {
    const CodeInfo& entry = info(code);
    CHECK(entry.code == code);
    CHECK(code_from_text(entry.text) == code);
    CHECK(!entry.title.empty());
    // An idle @allow is removed, not allowed; P0608 is asked of the plan, when @allow has been
    // asked.
    const bool can_be_allowed =
        entry.severity == Severity::kWarning && code != Code::P0209 && code != Code::P0608;
    if (can_be_allowed) CHECK_MESSAGE(!entry.slug.empty(), entry.text);
    if (!entry.slug.empty()) CHECK_MESSAGE(slugs.insert(entry.slug).second, entry.slug);
  }
  CHECK(code_from_slug("confounded") == Code::P0701);
  CHECK(!code_from_slug(""));
  CHECK(!code_from_text("P9999"));
}

TEST_CASE("the collector counts errors apart from warnings and sorts by place") {
  SourceSet sources;
  const FileId id = sources.add("a.probe", "abcdef");
  Diagnostics diagnostics;
  Diagnostic& first = diagnostics.report(Code::P0701, {id, 4, 5}, "later");
  for (std::uint32_t i = 0; i < 50; ++i) diagnostics.report(Code::P0201, {id, 1, 2}, "earlier");
  first.help("the reference is still good");
  CHECK(diagnostics.error_count() == 50);
  CHECK(diagnostics.size() == 51);
  CHECK(diagnostics.in_source_order().front()->message == "earlier");
  CHECK(diagnostics.in_source_order().back()->helps.size() == 1);
}

TEST_CASE("edits count insertions, deletions, replacements and swapped neighbours") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("carot", "carrot") == 1);
  CHECK(edit_distance("carrto", "carrot") == 1);
  CHECK(edit_distance("plate", "slate") == 1);
  CHECK(edit_distance("kitten", "sitting") == 3);
  CHECK(edit_distance("", "abc") == 3);
}

TEST_CASE("the nearest spelling is offered only when it is near") {
  constexpr std::array<std::string_view, 4> kNames = {"plate", "carrot", "small_plate", "spoon"};
  CHECK(nearest("carot", kNames) == "carrot");
  CHECK(nearest("plat", kNames) == "plate");
  CHECK(nearest("spo0n", kNames) == "spoon");
  CHECK(!nearest("keyboard", kNames));
  CHECK(!nearest("x", kNames));
  CHECK(!nearest(std::string(100000, 'a'), kNames));
  constexpr std::array<std::string_view, 1> kOne = {"y"};
  CHECK(!nearest("x", kOne));
}

TEST_CASE("the compiler and the runtime's messages choose the same nearest name") {
  const std::vector<std::string> known = {"carrot_on_plate", "carrot_on_plate_lang_color", "ever"};
  const std::vector<std::string_view> views(known.begin(), known.end());
  // Three edits of a long name, two of a short one, one too many, and a tie.
  for (const char* name : {"carrot_on_late", "carot_on_plate_lang_colour", "eevre", "evxyz", "e"}) {
    const auto near = nearest(name, views);
    CHECK(did_you_mean(name, known) ==
          (near ? ", did you mean `" + std::string(*near) + "`?" : std::string()));
  }
  CHECK(did_you_mean("carrot_plate", known) == ", did you mean `carrot_on_plate`?");
  CHECK(did_you_mean("carrot", known).empty());
}
