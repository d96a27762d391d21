#include "runtime/base/json.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

namespace probe {
namespace {

TEST_CASE("braces of pairs that begin with a text are an object, all others an array") {
  const Json object = {{"a", 1}, {"b", {1, 2.5}}, {"c", {{"d", nullptr}}}};
  CHECK(object.dump() == R"({"a":1,"b":[1,2.5],"c":{"d":null}})");
  const Json row = {"a", 1, true};
  CHECK(row.dump() == R"(["a",1,true])");
  CHECK(Json{"one"}.dump() == R"(["one"])");
  CHECK(Json::array({{"a", 1}}).dump() == R"([["a",1]])");
  CHECK(Json(std::vector<std::string>{"x"}).dump() == R"(["x"])");
  CHECK(Json(std::vector<std::pair<std::string, std::string>>{{"a", "b"}}).dump() ==
        R"([["a","b"]])");
}

TEST_CASE("an object keeps the order in which keys were added, until it is sorted") {
  Json json;
  json["z"] = 1;
  json["a"]["inner"].push_back({{"y", 1}, {"b", 2}});
  json["z"] = 2;
  CHECK(json.dump() == R"({"z":2,"a":{"inner":[{"y":1,"b":2}]}})");
  CHECK(json.sorted().dump() == R"({"a":{"inner":[{"b":2,"y":1}]},"z":2})");
  Json other = {{"z", 3}, {"n", 4}};
  json.update(other);
  CHECK(json["z"] == 3);
  CHECK(json.items().back().first == "n");
  json.erase("a");
  CHECK(json.dump() == R"({"z":3,"n":4})");
}

TEST_CASE("text comes back as it was written: numbers, Unicode, escapes, nesting") {
  const std::string text =
      R"({"k":[0,-1,18446744073709551615,0.1,1e+22,-0.0],"s":"\"\\\n\u0001 ü","e":[],"o":{},"n":null})";
  const Json json = Json::parse(text);
  CHECK(json.dump() == text);
  CHECK(json["k"][2].get<std::uint64_t>() == std::numeric_limits<std::uint64_t>::max());
  CHECK(json["k"][1].get<int>() == -1);
  CHECK(std::signbit(json["k"][5].get<double>()));
  CHECK(Json::parse(json.dump(2)) == json);
  CHECK(json.dump(1).starts_with("{\n \"k\": [\n  0,"));
}

TEST_CASE(
    "bytes that are no UTF-8 are written as the replacement character, numbers that are none as "
    "null") {
  CHECK(Json(std::string("a\xff")).dump() == "\"a\xef\xbf\xbd\"");
  CHECK(Json(std::nan("")).dump() == "null");
}

TEST_CASE("what is no JSON is discarded, also where only its depth or size is the matter") {
  for (const char* text : {"", "[1,", "{\"a\"}", "nul", "[1] 2", "\"\xff\""}) {
    CAPTURE(text);
    CHECK(Json::parse(text).is_discarded());
  }
  const auto nested = [](std::size_t depth) {
    return std::string(depth, '[') + std::string(depth, ']');
  };
  CHECK(Json::parse(nested(400)).is_array());
  CHECK(Json::parse(nested(100000)).is_discarded());
  std::string many = "[0";
  for (int i = 0; i < 4'000'000; ++i) many += ",0";
  CHECK(Json::parse(many + "]").is_discarded());
  CHECK(Json::parse(many.substr(0, 2'000'002) + "]").size() == 1'000'001);
}

TEST_CASE("of a key that is repeated the last value counts, at the place of the first") {
  const Json json = Json::parse(R"({"a":1,"b":2,"a":{"c":3},"b":4,"d":5})");
  CHECK(json.dump() == R"({"a":{"c":3},"b":4,"d":5})");
}

TEST_CASE("numbers are equal by value and objects in any order") {
  CHECK(Json(1) == Json(1u));
  CHECK(Json(1) == Json(1.0));
  CHECK(Json(-1) != Json(std::numeric_limits<std::uint64_t>::max()));
  CHECK(Json(1) != Json("1"));
  CHECK(Json({{"a", 1}, {"b", 2}}) == Json({{"b", 2}, {"a", 1}}));
  CHECK(Json({{"a", 1}}) != Json({{"a", 1}, {"b", 2}}));
  CHECK(Json() == nullptr);
}

TEST_CASE("what is missing or of another kind gives the fallback") {
  const Json json = {{"text", "x"}, {"number", 1}};
  CHECK(json.value("text", "y") == "x");
  CHECK(json.value("number", "y") == "y");
  CHECK(json.value("none", "y") == "y");
  CHECK(json.value("none", Json::array()).is_array());
  CHECK(json.find("none") == nullptr);
  CHECK(Json(1).find("a") == nullptr);
  CHECK(Json("text").begin() == Json("text").end());
  const auto numbers = Json::parse("[[1,2],[3]]").get<std::vector<std::vector<double>>>();
  CHECK(numbers == std::vector<std::vector<double>>{{1, 2}, {3}});
}

}  // namespace
}  // namespace probe
