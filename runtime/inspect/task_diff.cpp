#include "runtime/inspect/task_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "runtime/inspect/axes.h"
#include "runtime/inspect/claims_json.h"
#include "runtime/inspect/fixture_json.h"
#include "runtime/inspect/later_json.h"
#include "runtime/inspect/robot_json.h"
#include "runtime/inspect/roles_json.h"
#include "runtime/inspect/scene_facts.h"
#include "runtime/inspect/skills_json.h"
#include "runtime/inspect/varied.h"
#include "runtime/inspect/words.h"
#include "runtime/inspect/wrap.h"
#include "runtime/plan/later.h"
#include "runtime/plan/roles.h"

namespace probe::inspect {
namespace {

// What only some tasks have; it stands below what all of them have.
constexpr const char* kOfSome[] = {
    "surface", "base",   "posture", "area", "physics", "air",    "stands",   "backdrop", "photo",
    "law",     "placed", "joints",  "idle", "varied",  "claims", "solution", "then"};
bool is_of_some(const std::string& key) {
  return std::ranges::find(kOfSome, key) != std::end(kOfSome);
}

Json side(const plan::Plan& plan, std::uint32_t index) {
  const plan::TaskRecord& task = plan.tasks()[index];
  Json json;
  json["prompt"] = plan.text(task.prompt);
  add_roles(plan, task, json);
  json["baseline"] =
      task.baseline == plan::kNone ? Json() : Json(plan.text(plan.tasks()[task.baseline].name));
  json["scene"] = plan.text(plan.scenes()[task.scene].name);
  const Json robot = robot_of(plan, task);
  json["robot"] = robot_text(robot);
  if (const std::string law = law_text(robot); !law.empty()) json["law"] = law;
  std::string cameras;
  for (const plan::ViewRecord& view : plan.views(task))
    cameras.append(cameras.empty() ? "" : ", ").append(plan.text(plan.cameras()[view.camera].name));
  json["camera"] = cameras;
  json["light"] = plan.text(plan.lights()[task.light].name);
  json["horizon"] = task.horizon;
  json["metrics"] = Json::array();
  for (const plan::MetricRecord& metric : plan.metrics(task))
    json["metrics"].push_back(plan.text(metric.name));
  if (plan.scenes()[task.scene].fixtures.count > 0)
    json["joints"] = joint_starts_text(fixtures_of(plan, index));
  if (task.idle != 0) json["idle"] = task.idle;
  if (const auto varied = varied_in(plan, task); !varied.empty()) json["varied"] = varied;
  Json said;
  add_claims(plan, index, said);
  if (said.contains("claims")) json["claims"] = claims_text(said["claims"]);
  add_solution(plan, index, json);
  add_later(plan, index, said);
  if (said.contains("then")) json["then"] = later_text(said["then"]);
  json["instructions"] = plan.code(plan.programs()[task.program]).size();
  json["episodes"] = task.episodes.count;
  return json;
}

Json equal_ids(const plan::Plan& plan, std::uint32_t first, std::uint32_t second) {
  const plan::TaskRecord &a = plan.tasks()[first], &b = plan.tasks()[second];
  const auto ours = plan.episodes(a);
  const auto theirs = plan.episodes(b);
  std::size_t starts = 0, episodes = 0;
  for (std::size_t e = 0; e < std::min(ours.size(), theirs.size()); ++e) {
    starts += ours[e].start_id == theirs[e].start_id ? 1 : 0;
    episodes += ours[e].episode_id == theirs[e].episode_id ? 1 : 0;
  }
  return {{"starts", starts},
          {"episodes", episodes},
          {"of", std::max(ours.size(), theirs.size())},
          {"prompt", same_prompt(plan, first, plan, second)},
          {"judge", a.judge_id == b.judge_id},
          {"program", plan.programs()[a.program].hash == plan.programs()[b.program].hash}};
}

Json to_json(const std::vector<Word>& words) {
  Json json = Json::array();
  for (const Word& word : words) json.push_back({{"text", word.text}, {"differs", word.differs}});
  return json;
}

std::vector<Word> to_words(const Json& json) {
  std::vector<Word> words;
  for (const Json& word : json)
    words.push_back({word["text"].get<std::string>(), word["differs"].get<bool>()});
  return words;
}

std::string cell(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_null()) return "none";
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const Json& word : value) text += (text.empty() ? "" : ", ") + word.get<std::string>();
  return text.empty() ? "none" : text;
}

std::string joined(const Json& axes) {
  const std::string text = cell(axes);
  return axes.empty() ? "none" : text;
}

const char* same(const Json& flag) { return flag.get<bool>() ? "equal" : "differs"; }

}  // namespace

Json diff_tasks(const plan::Plan& plan, std::uint32_t first, std::uint32_t second) {
  const plan::TaskRecord& a = plan.tasks()[first];
  const plan::TaskRecord& b = plan.tasks()[second];
  const bool a_varies = a.baseline == second;
  const bool b_varies = b.baseline == first;
  // All that either is told, in turn.
  const WordDiff words = diff_words(plan::whole_instruction(plan.tables(), first),
                                    plan::whole_instruction(plan.tables(), second));
  Json json;
  json["a"] = plan.text(a.name);
  json["b"] = plan.text(b.name);
  json["baseline"] = a_varies ? Json("b") : b_varies ? Json("a") : Json();
  json["axes"] = axes_between(plan, first, second);
  json["declared_axes"] = a_varies   ? Json(plan::moved_axes(plan.tables(), a))
                          : b_varies ? Json(plan::moved_axes(plan.tables(), b))
                                     : Json();
  json["equal"] = equal_ids(plan, first, second);
  json["left"] = side(plan, first);
  json["right"] = side(plan, second);
  // As high as the robot's and the objects' ground: told where it is another one.
  const double heights[] = {plan.scenes()[a.scene].surface_z, plan.scenes()[b.scene].surface_z};
  if (heights[0] != heights[1]) {
    json["left"]["surface"] = fmt::format("{:.6g} cm", 100 * heights[0]);
    json["right"]["surface"] = fmt::format("{:.6g} cm", 100 * heights[1]);
  }
  // What a task changes of a scene in place leaves its name.
  if (a.scene != b.scene && json["left"]["scene"] == json["right"]["scene"]) {
    const std::vector<SceneFact> left = scene_facts(plan, a.scene);
    const std::vector<SceneFact> right = scene_facts(plan, b.scene);
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (left[i] == right[i]) continue;
      json["left"][left[i].name] = left[i].text;
      json["right"][right[i].name] = right[i].text;
    }
  }
  json["words_a"] = to_json(words.a);
  json["words_b"] = to_json(words.b);
  return json;
}

std::string diff_text(const Json& diff) {
  struct Row {
    std::string name, a, b;
    bool differs;
  };
  std::vector<Row> rows = {{"", cell(diff["a"]), cell(diff["b"]), false}};
  const auto add = [&rows](const std::string& key, const Json& left, const Json& right) {
    rows.push_back({key, cell(left), cell(right), left != right});
  };
  const Json sides[] = {diff["left"], diff["right"]};
  for (const auto& [key, left] : sides[0].items()) {
    if (key == "roles" || is_of_some(key)) continue;
    // Of the program that judges; the words are above.
    add(key == "instructions" ? "judge's ops" : key, left, sides[1][key]);
    if (key != "target") continue;
    // Other roles of either side stand below the two that most tasks have.
    const auto filled = [&](std::size_t side, const std::string& role) {
      return sides[side].contains("roles") ? sides[side]["roles"].value(role, Json()) : Json();
    };
    for (std::size_t side = 0; side < 2; ++side) {
      if (!sides[side].contains("roles")) continue;
      for (const auto& [role, objects] : sides[side]["roles"].items()) {
        if (side == 0 || filled(0, role).is_null()) add(role, filled(0, role), filled(1, role));
      }
    }
  }
  for (const char* key : kOfSome) {
    if (sides[0].contains(key) || sides[1].contains(key))
      add(key, sides[0].value(key, Json()), sides[1].value(key, Json()));
  }
  rows[1].a = marked(to_words(diff["words_a"]));
  rows[1].b = marked(to_words(diff["words_b"]));
  for (const char* words : {"words_a", "words_b"}) {
    for (const Json& word : diff[words]) rows[1].differs |= word["differs"].get<bool>();
  }
  // Two columns side by side within a screen of 100; longer cells go on below themselves.
  constexpr std::size_t kMost = 41;
  std::size_t width = 0;
  for (const Row& row : rows) width = std::max(width, std::min(kMost, row.a.size()));
  std::string text;
  const auto out = std::back_inserter(text);
  for (const Row& row : rows) {
    const std::vector<std::string> left = lines_of(row.a, kMost), right = lines_of(row.b, kMost);
    for (std::size_t i = 0; i < std::max(left.size(), right.size()); ++i) {
      fmt::format_to(out, "{} {:<12}  {:<{}}  {}\n", i == 0 && row.differs ? '*' : ' ',
                     i == 0 ? row.name : "", i < left.size() ? left[i] : "", width,
                     i < right.size() ? right[i] : "");
    }
  }
  const Json& equal = diff["equal"];
  fmt::format_to(out, "\naxes       {}\n", joined(diff["axes"]));
  if (!diff["baseline"].is_null()) {
    const bool a_is_baseline = diff["baseline"] == "a";
    fmt::format_to(out, "declared   {} is a variant of {}: {}\n",
                   cell(diff[a_is_baseline ? "b" : "a"]), cell(diff[a_is_baseline ? "a" : "b"]),
                   joined(diff["declared_axes"]));
  }
  const std::size_t of = equal["of"].get<std::size_t>();
  fmt::format_to(out, "start id   {} of {} equal\n", equal["starts"].get<std::size_t>(), of);
  fmt::format_to(out, "prompt id  {}\n", same(equal["prompt"]));
  fmt::format_to(out, "judge id   {}; program {}\n", same(equal["judge"]), same(equal["program"]));
  fmt::format_to(out, "episode id {} of {} equal\n", equal["episodes"].get<std::size_t>(), of);
  return text;
}

}  // namespace probe::inspect
