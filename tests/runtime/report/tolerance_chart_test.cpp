#include "runtime/report/tolerance_chart.h"

#include <doctest/doctest.h>

#include "tests/runtime/report/fake_searches.h"

using namespace probe;
using namespace probe::report;
using namespace probe::test;

namespace {

SearchFindings found(const FakeSearches& box, const std::string& name, const Json& json) {
  auto read = read_findings(box.add(name, json));
  REQUIRE_MESSAGE(read.ok(), to_text(read.failure()));
  return std::move(read).value();
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("policies of one text and space stand below one another, of another text apart") {
  const FakeSearches box;
  Json other = boundary_json("pi0", 0.2);
  other["asked"]["text_sha256"] = "cd34";
  const std::vector<SearchFindings> all = {found(box, "a", boundary_json("pi0", 0.121)),
                                           found(box, "b", boundary_json("octo", 0.2)),
                                           found(box, "c", other)};
  const auto groups = tolerance_groups(all);
  REQUIRE(groups.size() == 2);
  CHECK(groups[0].searches.size() == 2);
  CHECK(groups[1].searches.size() == 1);
  const std::string html = tolerance_chart(groups[0], all);
  CHECK(count(html, "<h4>") == 2);
  CHECK(count(html, "<svg") == 4);
  CHECK(count(html, "<circle") == 2);
  CHECK(html.find("falls to half at 0.121") != html.npos);
  CHECK(html.find("stays above half to 0.9") != html.npos);
}

TEST_CASE(
    "a tolerance stands where it is between the own value and the end, and so does its band") {
  const FakeSearches box;
  const std::vector<SearchFindings> all = {found(box, "a", boundary_json("pi0", 0.16))};
  const std::string html = tolerance_chart(tolerance_groups(all)[0], all);
  CHECK(html.find("<circle cx=\"50.00%\"") != html.npos);
  CHECK(html.find("class=\"doubt\" x=\"48.21%\" y=\"6\" width=\"3.57%\"") != html.npos);
}

TEST_CASE("where nothing is fair any more is said, and drawn") {
  const FakeSearches box;
  Json json = boundary_json("pi0", 0.2);
  json["axes"][0]["last_fair"] = 0.16;
  const std::vector<SearchFindings> all = {found(box, "a", json)};
  const std::string html = tolerance_chart(tolerance_groups(all)[0], all);
  CHECK(html.find("nothing beyond 0.16 is fair") != html.npos);
  CHECK(html.find("class=\"unfair\" x=\"50.00%\"") != html.npos);
}

TEST_CASE("a side that one of two searches has not had is said to be that") {
  const FakeSearches box;
  Json json = boundary_json("octo", 0.2);
  json["axes"] = Json::array({side_json("light.ambient", true, "no fall")});
  const std::vector<SearchFindings> all = {found(box, "a", boundary_json("pi0", 0.2)),
                                           found(box, "b", json)};
  CHECK(tolerance_chart(tolerance_groups(all)[0], all).find("not searched") != std::string::npos);
}

TEST_CASE("two policies of one name are told apart by their folders") {
  const FakeSearches box;
  const std::vector<SearchFindings> all = {found(box, "a", boundary_json("pi0", 0.1)),
                                           found(box, "b", boundary_json("pi0", 0.2))};
  CHECK(policy_label(all, all[0]) == "pi0 (" + all[0].folder + ")");
}
