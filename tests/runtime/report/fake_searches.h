// Folders of searches, made up: search.json and the tables of rounds, as `vlaprobe search` writes
// them.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "runtime/base/json.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::test {

inline Json asked(const char* method, const std::string& policy) {
  return {{"method", method},
          {"space", "around"},
          {"task", "carrot_on_plate"},
          {"text_sha256", "ab12"},
          {"policy", policy},
          {"policy_content", ""},
          {"seed", 3},
          {"error", 0.05},
          {"levels", 41},
          {"proved_by_expert", true}};
}

inline Json search_json(const char* method, const std::string& policy) {
  return {{"format", "vlaprobe search"},
          {"version", 1},
          {"asked", asked(method, policy)},
          {"file", "/nowhere/mine.probe"},
          {"done", true},
          {"trials", 68},
          {"episodes", 40},
          {"left_out", 2},
          {"expert_starts", 44},
          {"expert_unsolved", 1},
          {"expert_not_attempted", 0},
          {"lines", Json::array({"a line"})}};
}

// From 0.3 down to 0.02, or up to 0.9; a tolerance only where one is given.
inline Json side_json(const char* axis, bool up, const char* status, double at = 0,
                      double half = 0.005) {
  Json side = {{"axis", axis},
               {"up", up},
               {"side", std::string(axis) + (up ? " up" : " down")},
               {"status", status},
               {"unit", ""},
               {"own", 0.3},
               {"end", up ? 0.9 : 0.02},
               {"last_fair", up ? 0.9 : 0.02},
               {"trials", 68},
               {"left_out", 0},
               {"own_success", {17, 17}},
               {"no_fall", 0.0},
               {"sentence", std::string(axis) + ": as the search said it"}};
  if (at > 0) {
    side["tolerance"] = at;
    side["low"] = up ? at - half : at + half;
    side["high"] = up ? at + half : at - half;
  }
  return side;
}

inline Json boundary_json(const std::string& policy, double down) {
  Json json = search_json("boundary", policy);
  json["axes"] = Json::array({side_json("light.ambient", false, "found", down),
                              side_json("light.ambient", true, "no fall")});
  return json;
}

inline Json case_json(const std::string& name, const std::string& text, bool confirmed) {
  return {{"name", name},
          {"changes", {{"clutter", 2.0}}},
          {"text", text},
          {"distance", 1.5},
          {"search_failures", {10, 10}},
          {"failures", {40, 40}},
          {"at_least", 0.8862},
          {"p", 1e-9},
          {"confirmed", confirmed},
          {"sentence", "case: " + text}};
}

inline Json worst_json(const std::string& policy, Json cases) {
  Json json = search_json("worst", policy);
  json["own_failures"] = Json::array({0, 60});
  json["rate"] = 0.07;
  json["cases"] = std::move(cases);
  return json;
}

inline Json effect_json(const char* axis, bool matters, double first, double total_low) {
  return {{"axis", axis},
          {"matters", matters},
          {"p", matters ? 0.003 : 1.0},
          {"side", std::string(axis) + " from 2 on"},
          {"failures_there", {76, 82}},
          {"failures_elsewhere", {0, 99}},
          {"first", first},
          {"first_interval", {first / 2, first * 1.1}},
          {"total", 0.9304},
          {"total_interval", {total_low, 0.9968}},
          {"sentence", "not to be printed: explains 93 %"}};
}

inline Json pair_json(const char* a, const char* b, bool named, bool tested = true) {
  return {{"a", a},
          {"b", b},
          {"named", named},
          {"tested", tested},
          {"synergy", true},
          {"p", 0.01},
          {"share", 0.05},
          {"side_a", std::string(a) + " from 2 on"},
          {"side_b", std::string(b) + " other than as the task"},
          {"both", {68, 68}},
          {"only_a", {8, 14}},
          {"only_b", {0, 85}},
          {"neither", {0, 14}},
          {"sentence", ""}};
}

inline Json axes_json(const std::string& policy) {
  Json json = search_json("axes", policy);
  json["failures"] = Json::array({76, 181});
  json["effects"] =
      Json::array({effect_json("clutter", true, 0.8757, 0.8549), effect_json("words", false, 0, 0),
                   effect_json("light.power", false, 0, 0)});
  json["pairs"] =
      Json::array({pair_json("clutter", "words", true), pair_json("clutter", "light.power", false),
                   pair_json("words", "light.power", false, false)});
  return json;
}

class FakeSearches {
 public:
  std::string add(const std::string& name, const Json& json) const {
    const std::string dir = folder_ / name;
    std::filesystem::create_directories(dir);
    std::ofstream(dir + "/search.json") << json.dump(1);
    return dir;
  }
  void add_round(const std::string& dir, const std::string& round, const std::string& csv) const {
    std::filesystem::create_directories(dir + "/rounds/" + round);
    std::ofstream(dir + "/rounds/" + round + "/points.csv") << csv;
  }
  std::string operator/(const std::string& name) const { return folder_ / name; }

 private:
  run::TemporaryFolder folder_;
};

}  // namespace probe::test
