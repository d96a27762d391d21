#include "runtime/report/interaction_map.h"

#include <doctest/doctest.h>

#include "tests/runtime/report/fake_searches.h"

using namespace probe::report;
using namespace probe::test;

namespace {

bool has(const std::string& text, const char* part) { return text.find(part) != text.npos; }

}  // namespace

TEST_CASE("the map has what each axis explains, and of named pairs the sides") {
  const FakeSearches box;
  const auto found = read_findings(box.add("x", axes_json("pi0")));
  REQUIRE(found.ok());
  const std::string html = interaction_map(*found);
  CHECK(has(html, "<b>88 %</b>"));
  CHECK(has(html, "<b>together</b>"));
  CHECK(has(html, "not tested"));
  CHECK(has(html, "fail 68 of 68, one of the two alone 8 of 14 and 0 of 85, neither 0 of 14"));
}

TEST_CASE("a total share is said as a lower bound alone, rounded down") {
  const FakeSearches box;
  const auto found = read_findings(box.add("x", axes_json("pi0")));
  REQUIRE(found.ok());
  CHECK(total_text(found->axes[0]) == "at least 85 %");
  CHECK(total_text(found->axes[1]).empty());
  const std::string html = interaction_map(*found);
  CHECK(has(html, "at least 85 %"));
  for (const char* not_held : {"93 %", "93.0", "99.7", "to be printed"})
    CHECK_FALSE(has(html, not_held));
}

TEST_CASE("where no pair is named the map says that this is no proof of none") {
  const FakeSearches box;
  probe::Json json = axes_json("pi0");
  json["pairs"] = probe::Json::array({pair_json("clutter", "words", false)});
  const auto found = read_findings(box.add("x", json));
  REQUIRE(found.ok());
  CHECK(has(interaction_map(*found), "does not say that none do"));
}
