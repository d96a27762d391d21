#include "runtime/report/compare_searches.h"

#include <doctest/doctest.h>

#include "tests/runtime/report/fake_searches.h"

using namespace probe;
using namespace probe::report;
using namespace probe::test;

TEST_CASE("tolerances of two searches stand side by side, and no more is said than holds") {
  const FakeSearches box;
  const std::string a = box.add("a", boundary_json("pi0", 0.121));
  const auto apart = compare_searches(a, box.add("b", boundary_json("octo", 0.2)));
  REQUIRE_MESSAGE(apart.ok(), to_text(apart.failure()));
  REQUIRE(apart->sides.size() == 2);
  CHECK(apart->sides[0].verdict == "intervals do not overlap");
  CHECK(apart->sides[1].verdict == "both stand it");
  const std::string text = to_text(*apart);
  CHECK(text.find("light.ambient down: intervals do not overlap") != text.npos);
  CHECK(text.find("A  falls to half at 0.121 (0.116 to 0.126)") != text.npos);
  CHECK(text.find("no test at 5 %") != text.npos);
  for (const char* more : {"better", "differ", "significant"}) CHECK(text.find(more) == text.npos);

  const auto near = compare_searches(a, box.add("c", boundary_json("octo", 0.125)));
  REQUIRE(near.ok());
  CHECK(near->sides[0].verdict == "intervals overlap");
}

TEST_CASE("a tolerance beside none is said as that") {
  const FakeSearches box;
  Json none = boundary_json("octo", 0.2);
  none["axes"] = Json::array({side_json("light.ambient", false, "no fall")});
  const auto compared =
      compare_searches(box.add("a", boundary_json("pi0", 0.121)), box.add("b", none));
  REQUIRE(compared.ok());
  CHECK(compared->sides[0].verdict == "a tolerance was found in one alone");
  CHECK(compared->sides[1].verdict == "searched once");
  const Json json = to_json(*compared);
  CHECK(json["sides"][1]["b"].is_null());
  CHECK(json["sides"][0]["a"]["interval"][0].get<double>() == doctest::Approx(0.116));
  CHECK(json["interval_level"].get<double>() == 0.95);
}

TEST_CASE("searches over another space, task or text, or by another method, are refused by name") {
  const FakeSearches box;
  const std::string a = box.add("a", boundary_json("pi0", 0.121));
  const auto refused = [&](const char* name, const Json& json) {
    const auto compared = compare_searches(a, box.add(name, json));
    REQUIRE_FALSE(compared.ok());
    const std::string said = to_text(compared.failure());
    CHECK_MESSAGE(said.find(name) != std::string::npos, said);
    return said;
  };
  for (const auto& [key, word] : {std::pair("space", "another space"),
                                  {"task", "another task"},
                                  {"text_sha256", "another text"}}) {
    Json json = boundary_json("octo", 0.2);
    json["asked"][key] = "wide";
    CHECK(refused("other", json).find(word) != std::string::npos);
  }
  CHECK(refused("axes", axes_json("octo")).find("search axes") != std::string::npos);
  Json begun = search_json("boundary", "octo");
  begun["done"] = false;
  CHECK(refused("begun", begun).find("not done") != std::string::npos);
}
