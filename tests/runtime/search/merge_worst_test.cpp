#include "runtime/search/merge_worst.h"

#include <doctest/doctest.h>

#include <vector>

namespace probe::search {
namespace {

Json case_of(const std::string& name, double distance, bool confirmed) {
  return {{"name", name},
          {"distance", distance},
          {"confirmed", confirmed},
          {"sentence", "case 1: clutter 2: fails in 40 of 40 fresh trials"}};
}

Json findings_of(const std::string& shard, std::vector<Json> cases) {
  return {{"asked", {{"method", "worst"}, {"shard", shard}}},
          {"done", true},
          {"trials", 600},
          {"own_failures", Json::array({3, 60})},
          {"rate", shard == "1/2" ? 0.1 : 0.2},
          {"cases", Json(std::move(cases))}};
}

WorstShard shard_of(const std::string& shard, std::vector<Json> cases) {
  return worst_shard("DIR" + shard.substr(0, 1), findings_of(shard, std::move(cases))).value();
}

std::string refused(Json findings) {
  const auto shard = worst_shard("DIR", std::move(findings));
  REQUIRE_FALSE(shard.ok());
  CHECK(shard.failure().where == "DIR");
  return shard.failure().message;
}

TEST_CASE("cases of all shards: confirmed ones first, the nearer first, a point once") {
  const std::vector<WorstShard> shards = {
      shard_of("1/2", {case_of("a", 0.5, true), case_of("b", 0.1, false)}),
      shard_of("2/2", {case_of("c", 0.3, true), case_of("a", 0.5, true)})};
  const Json joined = joined_worst(shards);
  std::string names;
  for (const Json& one : joined.at("cases")) names += one.value("name", "");
  CHECK(names == "cab");
  CHECK(joined.at("lines")[1].text() == "case 2: clutter 2: fails in 40 of 40 fresh trials");
  CHECK(joined.at("trials").get<int>() == 1200);
  CHECK(joined.at("own_failures") == Json::array({6, 120}));
  // Of the rates that cases were tested against the one that all of them exceed.
  CHECK(joined.at("rate").get<double>() == 0.2);
  CHECK_FALSE(joined.at("asked").contains("shard"));
  CHECK(joined.at("asked").at("shards").get<int>() == 2);
}

TEST_CASE("shards that found nothing, or whose task fails by itself, say so together") {
  Json none = findings_of("1/1", {});
  none.erase("own_failures");
  std::vector<WorstShard> shards = {worst_shard("DIR", none).value()};
  CHECK(joined_worst(shards).at("lines")[0].text().starts_with("nothing failed in 600 trials"));
  Json hopeless = findings_of("1/1", {case_of("a", 0.5, false)});
  hopeless["own_failures"] = Json::array({60, 60});
  shards = {worst_shard("DIR", hopeless).value()};
  CHECK(joined_worst(shards).at("lines")[0].text().starts_with("the task itself fails in 60 of 60"));
}

TEST_CASE("trials that are invalid in some shards are told of all") {
  std::vector<WorstShard> shards;
  for (const char* const shard : {"1/2", "2/2"}) {
    Json findings = findings_of(shard, {case_of("a", 0.5, true)});
    findings["invalid"] = shards.empty() ? 0 : 7;
    shards.push_back(worst_shard("DIR", findings).value());
  }
  const Json joined = joined_worst(shards);
  CHECK(joined.at("lines")[0].text().starts_with("7 of 1200 trials are invalid and left out"));
  CHECK(joined.at("lines").size() == 2);
}

TEST_CASE("what is no finished shard is refused by its folder") {
  for (const char* const odd : {"", "2", "0/2", "3/2", "2/", "a/b"}) {
    CAPTURE(odd);
    CHECK(refused(findings_of(odd, {})) == "it is no shard of a search for the worst");
  }
  Json open = findings_of("1/2", {});
  open["done"] = false;
  CHECK(refused(open).starts_with("it is not finished"));
}

}  // namespace
}  // namespace probe::search
