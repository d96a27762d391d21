#include "runtime/inspect/task_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <vector>

#include "runtime/base/trig.h"
#include "runtime/inspect/axes.h"
#include "runtime/inspect/claims_json.h"
#include "runtime/inspect/fixture_json.h"
#include "runtime/inspect/later_json.h"
#include "runtime/inspect/question_json.h"
#include "runtime/inspect/robot_json.h"
#include "runtime/inspect/roles_json.h"
#include "runtime/inspect/scene_facts.h"
#include "runtime/inspect/skills_json.h"
#include "runtime/inspect/varied.h"
#include "runtime/inspect/wrap.h"
#include "runtime/plan/ids.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/shakes.h"

namespace probe::inspect {
namespace {

struct RollPitchYaw {
  double roll_deg = 0, pitch_deg = 0, yaw_deg = 0;
};

// Extrinsic x, y, z angles of a unit quaternion (w, x, y, z), rounded to 1e-9 degrees so that a
// written 90 reads 90; yaw in (-180, 180].
RollPitchYaw to_angles(const std::array<double, 4>& q) {
  const auto [w, x, y, z] = q;
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const auto rounded = [](double degrees) {
    const double value = std::nearbyint(degrees * 1e9) / 1e9;
    return value == -180.0 ? 180.0 : value + 0.0;
  };
  return {rounded(portable_atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)) * kDegrees),
          rounded(portable_asin(std::clamp(2 * (w * y - z * x), -1.0, 1.0)) * kDegrees),
          rounded(portable_atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) * kDegrees)};
}

std::string object_name(const plan::Plan& plan, std::uint32_t object) {
  return std::string(plan.text(plan.objects()[object].name));
}

std::string hex(const std::array<std::uint8_t, 32>& id) { return to_hex(plan::to_sha256(id)); }

// Names of the sets each task is in; one pass over the sets, whatever the number of tasks.
std::vector<std::vector<std::string_view>> categories_of(const plan::Plan& plan) {
  std::vector<std::vector<std::string_view>> categories(plan.tasks().size());
  for (const plan::SetRecord& set : plan.sets()) {
    for (const std::uint32_t task : plan.members(set))
      categories[task].push_back(plan.text(set.name));
  }
  return categories;
}

Json summarise(const plan::Plan& plan, std::uint32_t index,
               const std::vector<std::string_view>& categories) {
  const plan::TaskRecord& task = plan.tasks()[index];
  Json json;
  json["task"] = plan.text(task.name);
  json["baseline"] =
      task.baseline == plan::kNone ? Json() : Json(plan.text(plan.tasks()[task.baseline].name));
  json["axes"] = plan::moved_axes(plan.tables(), task);
  json["categories"] = categories;
  json["prompt"] = plan.text(task.prompt);
  add_later(plan, index, json);
  json["episodes"] = task.episodes.count;
  return json;
}

Json start_of(const plan::Plan& plan, const plan::EpisodeRecord& episode) {
  Json start = Json::array();
  for (const plan::PlacementRecord& placement : plan.placements(episode)) {
    const RollPitchYaw angles = to_angles(placement.rotation);
    start.push_back({{"object", object_name(plan, placement.object)},
                     {"x_m", placement.position[0]},
                     {"y_m", placement.position[1]},
                     {"roll_deg", angles.roll_deg},
                     {"pitch_deg", angles.pitch_deg},
                     {"yaw_deg", angles.yaw_deg}});
  }
  return start;
}

// A list a start, an entry a camera; empty where all stand as they say.
Json shaken_of(const plan::Plan& plan, const plan::TaskRecord& task) {
  Json starts = Json::array();
  const auto views = plan.views(task);
  for (const plan::EpisodeRecord& episode : plan.episodes(task)) {
    if (episode.shaken.count == 0) continue;
    Json start = Json::array();
    for (std::size_t i = 0; i < views.size(); ++i) {
      const plan::Shake shake = plan::shake_of(plan::shakes_of(plan.tables(), episode), i);
      start.push_back({{"camera", plan.text(views[i].name)},
                       {"moved_m", shake.moved},
                       {"turned_wxyz", shake.turned}});
    }
    starts.push_back(std::move(start));
  }
  return starts;
}

// Suites that run some of the starts.
Json drawn_of(const plan::Plan& plan, std::uint32_t task) {
  Json drawn = Json::array();
  for (const plan::SuiteRecord& suite : plan.suites()) {
    const auto members = plan.members(suite);
    if (std::ranges::find(members, task) == members.end()) continue;
    const auto starts = plan.episodes(suite, task);
    if (starts.size() < plan.tasks()[task].episodes.count)
      drawn.push_back({{"suite", plan.text(suite.name)}, {"starts", starts}});
  }
  return drawn;
}

double distance(const plan::PlacementRecord& a, const plan::PlacementRecord& b) {
  const double x = a.position[0] - b.position[0];
  const double y = a.position[1] - b.position[1];
  return std::sqrt(x * x + y * y);
}

std::string joined(const Json& words, const char* when_empty) {
  std::string text;
  for (const Json& word : words) text += (text.empty() ? "" : ", ") + word.get<std::string>();
  return text.empty() ? when_empty : text;
}

std::string short_id(const Json& id) { return id.get<std::string>().substr(0, 8); }

// A length or an angle to a tenth of a millimetre or degree, without a negative zero.
double tenth(double value, double scale) { return std::nearbyint(value * scale * 10) / 10 + 0.0; }

}  // namespace

std::vector<std::uint32_t> all_tasks(const plan::Plan& plan) {
  std::vector<std::uint32_t> tasks(plan.tasks().size());
  std::iota(tasks.begin(), tasks.end(), 0u);
  return tasks;
}

std::vector<std::uint32_t> members(const plan::Plan& plan, std::uint32_t suite) {
  const auto tasks = plan.members(plan.suites()[suite]);
  return {tasks.begin(), tasks.end()};
}

Json count(const plan::Plan& plan, std::span<const std::uint32_t> tasks,
           const plan::SuiteRecord* suite) {
  if (suite != nullptr) return {{"tasks", tasks.size()}, {"episodes", plan.episode_count(*suite)}};
  std::size_t episodes = 0;
  for (const std::uint32_t task : tasks) episodes += plan.tasks()[task].episodes.count;
  return {{"tasks", tasks.size()}, {"episodes", episodes}};
}

Json list(const plan::Plan& plan, std::span<const std::uint32_t> tasks,
          const plan::SuiteRecord* suite) {
  const auto categories = categories_of(plan);
  Json all = Json::array();
  for (const std::uint32_t task : tasks) {
    all.push_back(summarise(plan, task, categories[task]));
    if (suite != nullptr) all.back()["episodes"] = plan.episodes(*suite, task).size();
  }
  return all;
}

Json describe(const plan::Plan& plan, std::uint32_t index) {
  const plan::TaskRecord& task = plan.tasks()[index];
  Json json = summarise(plan, index, categories_of(plan)[index]);
  add_roles(plan, task, json);
  json["horizon"] = task.horizon;
  if (task.idle != 0) json["idle"] = task.idle;
  if (task.delay != 0) json["delay"] = task.delay;
  if (const auto varied = varied_in(plan, task); !varied.empty()) json["varied"] = varied;
  add_claims(plan, index, json);
  add_solution(plan, index, json);
  json["metrics"] = Json::array();
  for (const plan::MetricRecord& metric : plan.metrics(task))
    json["metrics"].push_back(plan.text(metric.name));
  json["starts"] = Json::array();
  json["scene"] = plan.text(plan.scenes()[task.scene].name);
  for (const SceneFact& fact : facts_in_place(plan, task.scene))
    json["scene_here"][fact.name] = fact.text;
  json["robot"] = robot_of(plan, task);
  json["camera"] = plan.text(plan.cameras()[task.camera].name);
  json["cameras"] = Json::array();
  for (const plan::ViewRecord& view : plan.views(task)) {
    json["cameras"].push_back(
        {{"name", plan.text(view.name)}, {"camera", plan.text(plan.cameras()[view.camera].name)}});
  }
  json["light"] = plan.text(plan.lights()[task.light].name);
  json["ood"] = Json::array();
  for (std::size_t i = 0; i < plan::kNovelty.size(); ++i) {
    if ((task.ood >> i & 1u) != 0) json["ood"].push_back(plan::kNovelty[i]);
  }
  json["drop_m"] = task.drop;
  json["settle_s"] = task.settle;
  json["allow"] = task.allow.length == 0 ? Json() : Json(plan.text(task.allow));
  json["distances_m"] = Json::array();
  json["ids"] = {{"prompt", to_hex(plan::prompt_id(plan.tables(), index))},
                 {"judge", hex(task.judge_id)},
                 {"starts", Json::array()},
                 {"episodes", Json::array()}};
  const plan::TaskRoles roles = plan::roles_of(plan.tables(), task);
  for (const plan::EpisodeRecord& episode : plan.episodes(task)) {
    const auto placements = plan.placements(episode);
    json["starts"].push_back(start_of(plan, episode));
    if (roles.has_both())
      json["distances_m"].push_back(distance(placements[roles.source], placements[roles.target]));
    json["ids"]["starts"].push_back(hex(episode.start_id));
    json["ids"]["episodes"].push_back(hex(episode.episode_id));
  }
  if (Json shaken = shaken_of(plan, task); !shaken.empty()) json["shaken"] = std::move(shaken);
  if (plan.scenes()[task.scene].fixtures.count > 0) json["fixtures"] = fixtures_of(plan, index);
  const Json regions = regions_of(plan, index);
  if (!regions.empty()) json["regions"] = regions;
  if (Json drawn = drawn_of(plan, index); !drawn.empty()) json["drawn"] = std::move(drawn);
  json["questions"] = questions_of(plan, index);
  json["not_asked"] = omissions_of(plan, index);
  return json;
}

std::string list_text(const Json& list) {
  constexpr std::size_t kScreen = 100, kLeast = 30;
  std::size_t width = 0;
  for (const Json& task : list) width = std::max(width, task["task"].text().size());
  // Long instructions go on below themselves.
  const std::size_t before = width + 8;
  const std::size_t room = before + kLeast < kScreen ? kScreen - before : kLeast;
  std::string text;
  for (const Json& task : list) {
    const auto lines = lines_of(whole_prompt(task), room);
    fmt::format_to(std::back_inserter(text), "{:<{}}  {:>4}  {}\n", task["task"].get<std::string>(),
                   width, task["episodes"].get<std::size_t>(), lines[0]);
    for (std::size_t i = 1; i < lines.size(); ++i)
      fmt::format_to(std::back_inserter(text), "{:<{}}{}\n", "", before, lines[i]);
  }
  return text;
}

namespace {

// "-23.5, 7.5 yaw 90": centimetres and degrees.
std::string place_text(const Json& object) {
  std::string text = fmt::format("{}, {}", tenth(object["x_m"].get<double>(), 100),
                                 tenth(object["y_m"].get<double>(), 100));
  for (const char* angle : {"roll", "pitch", "yaw"}) {
    const double degrees = tenth(object[std::string(angle) + "_deg"].get<double>(), 1);
    if (degrees != 0) fmt::format_to(std::back_inserter(text), " {} {}", angle, degrees);
  }
  return text;
}

// A line a start, a column an object. The ids of episodes are in the JSON.
std::string starts_text(const Json& task) {
  std::vector<std::string> names;
  std::vector<std::size_t> widths;
  if (!task["starts"].empty()) {
    for (const Json& object : task["starts"][0]) {
      names.push_back(object["object"].get<std::string>());
      widths.push_back(names.back().size());
    }
  }
  for (const Json& start : task["starts"]) {
    for (std::size_t i = 0; i < names.size(); ++i)
      widths[i] = std::max(widths[i], place_text(start[i]).size());
  }
  const std::vector<BegunColumn> joints =
      task.contains("fixtures") ? begun_columns(task["fixtures"]) : std::vector<BegunColumn>();
  std::string text;
  const auto out = std::back_inserter(text);
  const auto column = [&](std::size_t i, const std::string& cell) {
    fmt::format_to(out, "  {:<{}}", cell, i + 1 < names.size() ? widths[i] : 0);
  };
  // How far source and target are apart, where there are both.
  const bool has_both = !task["distances_m"].empty();
  fmt::format_to(out, "{:>5}  {:<8}", "start", "start id");
  if (has_both) fmt::format_to(out, "  {:>5}", "apart");
  for (const BegunColumn& joint : joints) fmt::format_to(out, "  {}", joint.joint);
  for (std::size_t i = 0; i < names.size(); ++i) column(i, names[i]);
  text += '\n';
  for (std::size_t e = 0; e < task["starts"].size(); ++e) {
    fmt::format_to(out, "{:>5}  {}", e, short_id(task["ids"]["starts"][e]));
    if (has_both) fmt::format_to(out, "  {:>5}", tenth(task["distances_m"][e].get<double>(), 100));
    for (const BegunColumn& joint : joints)
      fmt::format_to(out, "  {:>{}}", joint.starts[e], joint.joint.size());
    for (std::size_t i = 0; i < names.size(); ++i) column(i, place_text(task["starts"][e][i]));
    text += '\n';
  }
  return text;
}

}  // namespace

std::string describe_text(const Json& task) {
  std::string text;
  const auto out = std::back_inserter(text);
  const auto line = [&](const char* name, const std::string& value) {
    const char* key = name;
    for (const std::string& part : lines_of(value, 87)) {
      fmt::format_to(out, "{:<12} {}\n", key, part);
      key = "";
    }
  };
  const auto word = [&](const char* key) { line(key, task[key].get<std::string>()); };
  word("task");
  word("prompt");
  if (task.contains("then")) {
    for (const Json& sentence : later_text(task["then"])) line("then", sentence.text());
  }
  for (const char* role : {"source", "target"})
    line(role, task[role].is_null() ? "none" : task[role].get<std::string>());
  if (task.contains("roles")) {
    for (const auto& [role, filled] : task["roles"].items())
      line(role.c_str(), filled.is_array() ? joined(filled, "none") : filled.get<std::string>());
  }
  line("distractors", joined(task["distractors"], "none"));
  if (task.contains("placed")) line("placed", joined(task["placed"], "none"));
  line("baseline", task["baseline"].is_null() ? "none" : task["baseline"].get<std::string>());
  line("axes", joined(task["axes"], "none"));
  if (!task["allow"].is_null()) line("allowed", task["allow"].get<std::string>());
  line("unseen", joined(task["ood"], "nothing"));
  line("categories", joined(task["categories"], "none"));
  word("scene");
  if (task.contains("scene_here")) {
    for (const auto& [fact, said] : task["scene_here"].items())
      line("", fmt::format("{} {}", fact, said.get<std::string>()));
  }
  line("robot", robot_text(task["robot"]));
  if (const std::string law = law_text(task["robot"]); !law.empty()) line("law", law);
  std::string cameras;
  for (const Json& view : task["cameras"]) {
    const auto name = view["name"].get<std::string>(), camera = view["camera"].get<std::string>();
    cameras += (cameras.empty() ? "" : ", ") + (name == camera ? name : camera + " as " + name);
  }
  line(task["cameras"].size() == 1 ? "camera" : "cameras", cameras);
  word("light");
  for (const std::string& fixture : fixture_lines(task)) line("fixture", fixture);
  if (task.contains("regions")) line("regions", joined(names_of(task["regions"]), "none"));
  const double settle = task["settle_s"].get<double>();
  line("layout", settle == 0 ? fmt::format("{} starts, begun as placed", task["starts"].size())
                             : fmt::format("{} starts, dropped from {} cm, settled for {} s",
                                           task["starts"].size(),
                                           tenth(task["drop_m"].get<double>(), 100), settle));
  if (task.contains("drawn")) {
    for (const Json& drawn : task["drawn"]) {
      std::string starts;
      for (const Json& start : drawn["starts"])
        starts += (starts.empty() ? "" : ", ") + std::to_string(start.get<std::uint32_t>());
      line("drawn", fmt::format("suite {} runs {} of them: {}", drawn["suite"].text(),
                                drawn["starts"].size(), starts));
    }
  }
  if (task.contains("varied")) line("varied", joined(task["varied"], "nothing"));
  line("metrics", joined(task["metrics"], "none"));
  const std::string idle = task.contains("idle") ? fmt::format(", behind {} of standing still",
                                                               task["idle"].get<std::uint32_t>())
                                                 : "";
  line("horizon", fmt::format("{} steps{}", task["horizon"].get<std::uint32_t>(), idle));
  if (task.contains("claims")) line("claims", joined(claims_text(task["claims"]), "none"));
  if (task.contains("solution")) line("solution", joined(task["solution"], "none"));
  const Json& ids = task["ids"];
  line("prompt id", short_id(ids["prompt"]));
  line("judge id", short_id(ids["judge"]));
  text += task["distances_m"].empty() ? "\nstarts: cm and degrees\n"
                                      : "\nstarts: cm and degrees, source and target apart in cm\n";
  text += starts_text(task);
  const std::string questions = questions_text(task["questions"], task["not_asked"]);
  if (!questions.empty()) text += "\nquestions\n" + questions;
  return text;
}

}  // namespace probe::inspect
