#include "runtime/report/search_findings.h"

#include <doctest/doctest.h>

#include "runtime/search/search.h"
#include "tests/runtime/report/fake_searches.h"

using namespace probe;
using namespace probe::report;
using namespace probe::test;

TEST_CASE("a search of each method is read with what it found") {
  const FakeSearches box;
  const auto boundary = read_findings(box.add("b", boundary_json("pi0", 0.121)));
  REQUIRE_MESSAGE(boundary.ok(), to_text(boundary.failure()));
  REQUIRE(boundary->sides.size() == 2);
  CHECK(boundary->policy == "pi0");
  CHECK(boundary->seed == 3);
  CHECK(boundary->sides[0].in_words() == "falls to half at 0.121");
  CHECK(boundary->sides[0].interval() == "0.116 to 0.126");
  CHECK(boundary->sides[1].in_words() == "stays above half to 0.9");
  CHECK_FALSE(boundary->sides[1].at.has_value());
  CHECK(boundary->expert_unsolved == 1);

  const auto worst = read_findings(
      box.add("w", worst_json("pi0", Json::array({case_json("p1", "clutter 2", true)}))));
  REQUIRE(worst.ok());
  CHECK(worst->cases[0].failures.k == 40);
  CHECK(worst->own_failures.n == 60);

  const auto axes = read_findings(box.add("x", axes_json("pi0")));
  REQUIRE(axes.ok());
  CHECK(axes->axes.size() == 3);
  CHECK(axes->pairs[0].named);
}

TEST_CASE("statuses without a tolerance are said in words") {
  const auto words = [](const char* status) {
    const FakeSearches box;
    Json json = search_json("boundary", "pi0");
    json["axes"] = Json::array({side_json("light.ambient", false, status)});
    const auto found = read_findings(box.add("b", json));
    REQUIRE(found.ok());
    return found->sides[0].in_words();
  };
  CHECK(words("no fall") == "stays above half to 0.02");
  CHECK(words("fails unchanged") == "nothing to fall from: 17 of 17 succeed unchanged");
  CHECK(words("not monotone") == "falls and rises again: no one tolerance");
  CHECK(words("undecided") == "undecided");
  CHECK(words("left out") == "nothing but the task itself is fair");
  CHECK(words("under way") == "under way");
}

TEST_CASE("a search that has just begun has found nothing, and is no failure") {
  const FakeSearches box;
  for (const char* method : {"boundary", "worst", "minimal", "axes"}) {
    Json json = search_json(method, "pi0");
    json["done"] = false;
    const auto found = read_findings(box.add(method, json));
    REQUIRE_MESSAGE(found.ok(), to_text(found.failure()));
    CHECK_FALSE(found->done);
    CHECK(found->sides.empty());
  }
}

TEST_CASE("a file that no search wrote is refused with the key that is wrong") {
  const FakeSearches box;
  const auto refused = [&](const Json& json) {
    const auto found = read_findings(box.add("bad", json));
    REQUIRE_FALSE(found.ok());
    CHECK(found.failure().where.find("bad/search.json") != std::string::npos);
    return found.failure().message;
  };
  CHECK(refused({{"format", "another"}}).find("not what a search wrote") != std::string::npos);
  CHECK(refused({{"format", "vlaprobe search"}, {"version", 1}}).find("`asked`") !=
        std::string::npos);
  Json json = boundary_json("pi0", 0.1);
  json["asked"]["method"] = "guess";
  CHECK(refused(json).find("`method`") != std::string::npos);
  json = boundary_json("pi0", 0.1);
  json["axes"] = 7;
  CHECK(refused(json).find("`axes`") != std::string::npos);
  json["axes"] = Json::array({Json("text")});
  CHECK(refused(json).find("`axes`") != std::string::npos);
  json["axes"] = Json::array({side_json("light.ambient", false, "found")});
  CHECK(refused(json).find("`tolerance`") != std::string::npos);
  Json side = side_json("light.ambient", false, "no fall");
  side["own_success"] = Json::array({5, 2});
  json["axes"] = Json::array({side});
  CHECK(refused(json).find("`own_success`") != std::string::npos);
  side = side_json("light.ambient", false, "no fall");
  side["end"] = "far";
  json["axes"] = Json::array({side});
  CHECK(refused(json).find("`end`") != std::string::npos);
}

TEST_CASE("a folder is a search's by its search.json") {
  const FakeSearches box;
  const std::string dir = box.add("b", boundary_json("pi0", 0.1));
  CHECK(search::is_search(dir));
  CHECK_FALSE(search::is_search(dir + "/rounds"));
  CHECK_FALSE(search::is_search(dir + "/no/such"));
}
