// SimplerEnv's Google robot: every trial of both protocols against the released starts, as often as
// the protocols make it, and their totals.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/later.h"
#include "tests/parity/published.h"

using namespace probe;

namespace {

// A trial as one line, and how many there are of it.
using Trials = std::map<std::string, int>;
using Row = std::map<std::string, std::string>;

std::vector<std::string> cells_of(std::string line) {
  if (line.ends_with('\r')) line.pop_back();
  std::vector<std::string> cells;
  std::istringstream parts(line);
  for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
  return cells;
}

// Nothing, and a message, where the released starts are not on this machine.
std::vector<Row> released_rows() {
  std::ifstream file(VLAPROBE_SOURCE_DIR "/../shared/reference/google/google_starts.csv");
  std::vector<Row> rows;
  std::string line;
  if (!std::getline(file, line)) {
    MESSAGE("skipped: the released starts of the Google robot are not on this machine");
    return rows;
  }
  const std::vector<std::string> names = cells_of(line);
  while (std::getline(file, line)) {
    std::vector<std::string> cells = cells_of(line);
    cells.resize(names.size());
    Row row;
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

// Quaternions were published to six digits; q and -q are one turn.
std::string turn_text(std::array<double, 4> q) {
  for (const double part : q) {
    if (std::abs(part) < 1e-4) continue;
    if (part < 0) {
      for (double& one : q) one = -one;
    }
    break;
  }
  std::string text;
  for (const double part : q) {
    char digits[32];
    std::snprintf(digits, sizeof digits, " %.4f", std::abs(part) < 5e-5 ? 0.0 : part);
    text += digits;
  }
  return text;
}
std::string place_text(double x, double y, double z) {
  char digits[96];
  std::snprintf(digits, sizeof digits, " %.9f %.9f %.9f", x + 0.0, y + 0.0, z + 0.0);
  return digits;
}
std::string trial_text(const std::string& prompt, int horizon, const std::string& robot,
                       double drawer, const std::string& objects) {
  char opened[32];
  std::snprintf(opened, sizeof opened, " | %.9f", drawer);
  return prompt + " | " + std::to_string(horizon) + " |" + robot + opened + objects;
}

const std::map<std::string, std::string> kOurNames = {
    {"7up_can", "seven_up"}, {"sprite_can", "sprite"},
    {"fanta_can", "fanta"},  {"redbull_can", "redbull"},
    {"coke_can", "coke"},    {"pepsi_can", "pepsi"},
    {"apple", "apple"},      {"blue_plastic_bottle", "bottle"},
    {"sponge", "sponge"},    {"bridge_spoon_generated_modified", "spoon"},
    {"orange", "orange"}};

// `baked_` where the release shows the thing with its light baked in.
std::string our_name(std::string model, const std::string& task) {
  const bool is_baked = model.starts_with("baked_");
  for (const char* more : {"baked_", "opened_"}) {
    if (model.starts_with(more)) model.erase(0, std::string(more).size());
  }
  if (model.ends_with("_v2")) model.erase(model.size() - 3);
  const auto found = kOurNames.find(model);
  REQUIRE_MESSAGE(found != kOurNames.end(), model);
  const bool is_fruit = model == "apple" || model == "orange";
  const std::string name = (is_fruit && task != "move_near" ? "heavy_" : "") + found->second;
  return is_baked ? "baked_" + (name == "seven_up" ? "7up" : name) : name;
}

int horizon_of(const std::string& task) {
  if (task.starts_with("pick") || task == "move_near") return 80;
  return task.starts_with("place") ? 200 : 113;
}

// How often a protocol makes the trials of a row.
int times(const Row& row, bool has_tilted) {
  if (row.at("protocol") == "visual_matching") return 4;
  if (row.at("start_set") != "base") return 1;
  const bool is_table = row.at("task").starts_with("pick") || row.at("task") == "move_near";
  return 7 + (is_table && has_tilted ? 2 : 0);
}

// Distractors of the coke can were dropped one after the other, from one height; here each from
// 15 cm above the one before it.
Trials released(const std::vector<Row>& rows, const std::string& protocol, bool has_tilted) {
  Trials trials;
  for (std::size_t i = 0; i < rows.size();) {
    const Row& first = rows[i];
    const std::string& task = first.at("task");
    const bool is_crowded = first.at("start_set").starts_with("distractor");
    std::map<std::string, std::string> objects;  // by our name
    int dropped = 0;
    std::size_t next = i;
    for (; next < rows.size(); ++next) {
      const Row& row = rows[next];
      bool is_same = true;
      for (const char* key : {"protocol", "task", "env_id", "start_set", "trial"})
        is_same = is_same && row.at(key) == first.at(key);
      if (!is_same) break;
      if (row.at("object").empty()) continue;
      const auto number = [&](const char* key) { return test::decimal(row.at(key)); };
      const std::string name = our_name(row.at("object"), task);
      const double z = number("z_drop") + (is_crowded ? 0.15 * dropped++ : 0);
      objects[name] = " | " + name + place_text(number("x"), number("y"), z) +
                      turn_text({number("qw"), number("qx"), number("qy"), number("qz")});
    }
    i = next;
    if (first.at("protocol") != protocol) continue;
    std::string placed;
    for (const auto& [name, text] : objects) placed += text;
    const auto number = [&](const char* key) { return test::decimal(first.at(key)); };
    const std::string robot =
        place_text(number("robot_x"), number("robot_y"), number("robot_z")) +
        turn_text({number("robot_qw"), number("robot_qx"), number("robot_qy"), number("robot_qz")});
    trials[trial_text(first.at("prompt"), horizon_of(task), robot, number("drawer_q0"), placed)] +=
        times(first, has_tilted);
  }
  return trials;
}

plan::Plan plan_of(const std::string& suite) {
  const std::string root = VLAPROBE_SOURCE_DIR;
  const std::string file = root + "/suite/google.probe";
  auto built = build(std::span<const std::string>(&file, 1), {root + "/assets", suite});
  REQUIRE_MESSAGE(built.ok(), to_text(built.failure()));
  CHECK_MESSAGE(built->diagnostics.items().empty(),
                render_text(built->diagnostics, built->sources));
  REQUIRE(built->ok);
  auto opened = plan::Plan::from_bytes(std::move(built->plan));
  REQUIRE_MESSAGE(opened.ok(), to_text(opened.failure()));
  return std::move(opened).value();
}

// The episodes of the suite's own tasks, without what they are compared with.
std::vector<plan::EpisodeRecord> episodes_of(const plan::Plan& plan) {
  const plan::Tables& tables = plan.tables();
  REQUIRE(tables.suites.size() == 1);
  std::vector<plan::EpisodeRecord> episodes;
  for (const std::uint32_t task : plan::slice_of(tables.list, tables.suites[0].members)) {
    for (const plan::EpisodeRecord& episode :
         plan::slice_of(tables.episodes, tables.tasks[task].episodes))
      episodes.push_back(episode);
  }
  return episodes;
}

Trials ours(const plan::Plan& plan) {
  Trials trials;
  const plan::Tables& tables = plan.tables();
  for (const plan::EpisodeRecord& episode : episodes_of(plan)) {
    const plan::TaskRecord& task = tables.tasks[episode.task];
    const plan::SceneRecord& scene = tables.scenes[task.scene];
    std::string prompt;
    for (const std::string_view sentence : plan::sentences_of(tables, episode.task))
      prompt += (prompt.empty() ? "" : "|") + std::string(sentence);
    std::map<std::string, std::string> objects;
    for (const plan::PlacementRecord& placement :
         plan::slice_of(tables.placements, episode.placements)) {
      const std::string name(plan.text(tables.objects[placement.object].name));
      const auto& p = placement.position;
      objects[name] = " | " + name + place_text(p[0], p[1], p[2]) + turn_text(placement.rotation);
    }
    std::string placed;
    for (const auto& [name, text] : objects) placed += text;
    const auto joints = plan::joint_starts_of(tables, scene, episode);
    const auto& p = scene.base_position;
    const std::string robot = place_text(p[0], p[1], p[2]) + turn_text(scene.base_rotation);
    ++trials[trial_text(prompt, static_cast<int>(task.horizon), robot,
                        std::accumulate(joints.begin(), joints.end(), 0.0), placed)];
  }
  return trials;
}

std::map<std::string, int> totals(const plan::Plan& plan) {
  std::map<std::string, int> count;
  const plan::Tables& tables = plan.tables();
  for (const plan::EpisodeRecord& episode : episodes_of(plan)) {
    const auto sentences = plan::sentences_of(tables, episode.task);
    const std::string_view told = sentences.back();
    ++count[std::string(told.substr(0, told.find(' ')))];
  }
  return count;
}

void check_equal(const Trials& wanted, const Trials& found) {
  std::size_t equal = 0;
  for (const auto& [trial, count] : wanted) {
    const auto here = found.find(trial);
    const int made = here == found.end() ? 0 : here->second;
    CHECK_MESSAGE(made == count, trial, ": ", made, " of ", count);
    equal += made == count;
  }
  for (const auto& [trial, count] : found)
    CHECK_MESSAGE(wanted.contains(trial), "not released: ", trial);
  MESSAGE(equal << " of " << wanted.size() << " different trials as often as released");
}

}  // namespace

TEST_CASE("both protocols of the Google robot make as many trials of each task as published") {
  using Totals = std::map<std::string, int>;
  CHECK(totals(plan_of("google_visual_matching")) ==
        Totals{{"pick", 300}, {"move", 240}, {"open", 108}, {"close", 108}, {"place", 108}});
  CHECK(totals(plan_of("google_variants")) ==
        Totals{{"pick", 675}, {"move", 480}, {"open", 189}, {"close", 189}, {"place", 189}});
  CHECK(totals(plan_of("google_variants_run")) ==
        Totals{{"pick", 825}, {"move", 600}, {"open", 189}, {"close", 189}, {"place", 189}});
  CHECK(totals(plan_of("google_visual_matching_501")) == Totals{{"pick", 300}});
}

TEST_CASE("every trial of the Google robot starts, is told and lasts as released") {
  const std::vector<Row> rows = released_rows();
  if (rows.empty()) return;
  SUBCASE("visual matching") {
    check_equal(released(rows, "visual_matching", false), ours(plan_of("google_visual_matching")));
  }
  SUBCASE("variant aggregation, what is averaged") {
    check_equal(released(rows, "variant_aggregation", false), ours(plan_of("google_variants")));
  }
  SUBCASE("variant aggregation, what is run") {
    check_equal(released(rows, "variant_aggregation", true), ours(plan_of("google_variants_run")));
  }
}

TEST_CASE("the Google robot is controlled at 3 Hz, and physics runs at 513 or 501 Hz") {
  for (const auto& [suite, rate] :
       {std::pair{"google_visual_matching", 513.0}, std::pair{"google_variants_run", 513.0},
        std::pair{"google_visual_matching_501", 501.0}}) {
    const plan::Plan plan = plan_of(suite);
    const plan::Tables& tables = plan.tables();
    for (const plan::EpisodeRecord& episode : episodes_of(plan)) {
      const plan::SceneRecord& scene = tables.scenes[tables.tasks[episode.task].scene];
      CHECK(scene.physics_hz == rate);
      CHECK(tables.robots[scene.robot].control_hz == 3);
    }
  }
}

TEST_CASE("what the Google robot handles weighs, and rubs, as released") {
  const auto list = read_file(VLAPROBE_SOURCE_DIR "/../shared/reference/google/google_tasks.json");
  if (!list) {
    MESSAGE("skipped: the released things of the Google robot are not on this machine");
    return;
  }
  const Json released = Json::parse(*list)["objects"];
  const std::map<std::string, std::pair<const char*, const char*>> theirs = {
      {"coke", {"opened_coke_can", "mass_kg_from_collision_mesh"}},
      {"pepsi", {"opened_pepsi_can", "mass_kg_from_collision_mesh"}},
      {"seven_up", {"opened_7up_can", "mass_kg_from_collision_mesh"}},
      {"sprite", {"opened_sprite_can", "mass_kg_from_collision_mesh"}},
      {"fanta", {"opened_fanta_can", "mass_kg_from_collision_mesh"}},
      {"redbull", {"opened_redbull_can", "mass_kg_from_collision_mesh"}},
      {"bottle", {"blue_plastic_bottle", "mass_kg_from_collision_mesh"}},
      {"apple", {"apple", "mass_in_move_near_kg"}},
      {"orange", {"orange", "mass_in_move_near_kg"}},
      {"heavy_apple", {"apple", "mass_kg_from_collision_mesh"}},
      {"heavy_orange", {"orange", "mass_kg_from_collision_mesh"}},
      {"sponge", {"sponge", "mass_kg_from_collision_mesh"}},
      {"spoon", {"bridge_spoon_generated_modified", "mass_kg_from_collision_mesh"}}};
  const plan::Plan plan = plan_of("google_variants");
  const plan::Tables& tables = plan.tables();
  std::size_t seen = 0;
  for (const plan::ObjectRecord& object : tables.objects) {
    const std::string name(plan.text(object.name));
    const auto found = theirs.find(name);
    CAPTURE(name);
    REQUIRE(found != theirs.end());
    const Json& entry = released[found->second.first];
    const auto masses = plan::slice_of(tables.masses, object.mass);
    REQUIRE(masses.size() == 1);
    CHECK(masses[0].mass ==
          doctest::Approx(entry[found->second.second].get<double>()).epsilon(1e-9));
    CHECK(object.friction == entry["static_friction"].get<double>());
    ++seen;
  }
  CHECK(seen == theirs.size());
}

TEST_CASE("what shines by visual matching weighs, and is called, as what does not") {
  const plan::Plan plain = plan_of("google_variants"), baked = plan_of("google_visual_matching");
  const auto find = [](const plan::Plan& plan, const std::string& name) {
    for (const plan::ObjectRecord& object : plan.tables().objects)
      if (plan.text(object.name) == name) return object;
    FAIL(name);
    return plan::ObjectRecord{};
  };
  std::size_t seen = 0;
  for (const plan::ObjectRecord& object : baked.tables().objects) {
    const std::string name(baked.text(object.name));
    CAPTURE(name);
    if (!name.starts_with("baked_")) {
      CHECK((name == "coke" || name == "bottle" || name == "orange"));
      continue;
    }
    const plan::ObjectRecord other =
        find(plain, name == "baked_7up" ? "seven_up" : name.substr(std::string("baked_").size()));
    const auto of = [](const plan::Plan& plan, const plan::ObjectRecord& record) {
      const auto masses = plan::slice_of(plan.tables().masses, record.mass);
      REQUIRE(masses.size() == 1);
      return masses[0].mass;
    };
    CHECK(of(baked, object) == of(plain, other));
    CHECK(object.friction == other.friction);
    CHECK(baked.text(object.text) == plain.text(other.text));
    CHECK(object.box_min == other.box_min);
    CHECK(object.box_max == other.box_max);
    ++seen;
  }
  CHECK(seen == 7);
}

TEST_CASE("the published rates of the Google suite are those of Table IV, to the digit") {
  std::ifstream file(VLAPROBE_SOURCE_DIR "/../shared/reference/google/google_table.csv");
  std::string line;
  if (!std::getline(file, line)) {
    MESSAGE("skipped: the published rates of the Google robot are not on this machine");
    return;
  }
  const std::vector<std::string> header = cells_of(line);
  std::map<std::string, double> rates;  // "visual_matching RT-1-X drawer_open", in percent
  while (std::getline(file, line)) {
    if (!line.starts_with("arXiv:2405.05941v1 Table IV,")) continue;
    const std::vector<std::string> cells = cells_of(line);
    Row row;
    for (std::size_t c = 0; c < std::min(cells.size(), header.size()); ++c)
      row[header[c]] = cells[c];
    if (row["metric"] != "success_rate") continue;
    const std::string part = row["subtask"] == "average" ? "" : "_" + row["subtask"];
    rates[row["protocol"] + " " + row["policy"] + " " + row["task"] + part] =
        100 * std::stod(row["value"]);
  }
  for (const auto& [protocol, name] : {std::pair{"visual_matching", "visual_matching"},
                                       std::pair{"variant_aggregation", "variants"}}) {
    std::ifstream ours(VLAPROBE_SOURCE_DIR "/suite/google/published_" + std::string(name) + ".csv");
    REQUIRE(std::getline(ours, line));
    const std::vector<std::string> columns = cells_of(line);
    std::size_t count = 0;
    while (std::getline(ours, line)) {
      const std::vector<std::string> cells = cells_of(line);
      REQUIRE(cells.size() == columns.size());
      for (std::size_t c = 2; c < cells.size(); ++c) {
        const auto theirs = rates.find(std::string(protocol) + " " + cells[0] + " " + columns[c]);
        CAPTURE(cells[0]);
        CAPTURE(columns[c]);
        REQUIRE(theirs != rates.end());
        CHECK(std::stod(cells[c]) == doctest::Approx(theirs->second).epsilon(1e-9));
        ++count;
      }
    }
    CHECK(count == 6 * 9);
  }
}

TEST_CASE(
    "each of the 42 registered environments of the Google robot is a task here, but for one") {
  const auto list = read_file(VLAPROBE_SOURCE_DIR "/../shared/reference/google/google_tasks.json");
  if (!list) {
    MESSAGE("skipped: the released environments of the Google robot are not on this machine");
    return;
  }
  // By the id without `InScene` and `-v0`: one of its tasks.
  const std::map<std::string, const char*> ours = {
      {"GraspSingleCustom", "pick_heavy_apple"},
      {"GraspSingleCustomOrientation", "pick_vertical"},
      {"GraspSingleRandomObject", "pick_eggplant"},
      {"GraspSingleCokeCan", "pick_full_coke"},
      {"GraspSingleOpenedCokeCan", "pick_horizontal"},
      {"GraspSingleAltDensityOpenedCokeCan", "pick_denser_coke"},
      {"GraspSingleOpenedCokeCanAltGoogleCamera", "pick_standing_lower"},
      {"GraspSingleOpenedCokeCanAltGoogleCamera2", "pick_standing_higher"},
      {"GraspSingleOpenedCokeCanDistractor", "pick_standing_among_more"},
      {"GraspSinglePepsiCan", "pick_full_pepsi"},
      {"GraspSingleOpenedPepsiCan", "pick_pepsi"},
      {"GraspSingle7upCan", "pick_full_seven_up"},
      {"GraspSingleOpened7upCan", "pick_seven_up"},
      {"GraspSingleSpriteCan", "pick_full_sprite"},
      {"GraspSingleOpenedSpriteCan", "pick_sprite"},
      {"GraspSingleFantaCan", "pick_full_fanta"},
      {"GraspSingleOpenedFantaCan", "pick_fanta"},
      {"GraspSingleRedBullCan", "pick_full_redbull"},
      {"GraspSingleOpenedRedBullCan", "pick_redbull"},
      {"GraspSingleBluePlasticBottle", "pick_bottle"},
      {"GraspSingleApple", "pick_heavy_apple"},
      {"GraspSingleOrange", "pick_heavy_orange"},
      {"GraspSingleSponge", "pick_sponge"},
      {"GraspSingleBridgeSpoon", "pick_spoon"},
      {"MoveNearGoogle", "coke_near_redbull_by_apple_alone"},
      {"MoveNearGoogleBakedTex", "coke_near_redbull_by_apple_baked"},
      {"MoveNearGoogleBakedTex-v1", "coke_near_redbull_by_apple_baked"},
      {"MoveNearAltGoogleCamera", "coke_near_redbull_by_apple_lower"},
      {"MoveNearAltGoogleCamera2", "coke_near_redbull_by_apple_higher"},
      {"OpenDrawerCustom", "open_bottom"},
      {"OpenTopDrawerCustom", "open_top"},
      {"OpenMiddleDrawerCustom", "open_middle"},
      {"OpenBottomDrawerCustom", "open_bottom"},
      {"CloseDrawerCustom", "close_bottom"},
      {"CloseTopDrawerCustom", "close_top"},
      {"CloseMiddleDrawerCustom", "close_middle"},
      {"CloseBottomDrawerCustom", "close_bottom"},
      {"PlaceIntoClosedDrawerCustom", "place_apple_bottom"},
      {"PlaceIntoClosedTopDrawerCustom", "place_apple"},
      {"PlaceIntoClosedMiddleDrawerCustom", "place_apple_middle"},
      {"PlaceIntoClosedBottomDrawerCustom", "place_apple_bottom"}};
  std::map<std::string, std::uint32_t> horizons;
  for (const char* suite : {"google", "google_variants_run", "google_visual_matching"}) {
    const plan::Plan plan = plan_of(suite);
    for (const plan::TaskRecord& task : plan.tables().tasks)
      horizons[std::string(plan.text(task.name))] = task.horizon;
  }
  std::size_t seen = 0;
  const Json released = Json::parse(*list)["registered_env_ids"];
  for (const Json& entry : released) {
    std::string id = entry["env_id"].get<std::string>();
    for (const char* end : {"-v0", "InScene"}) {
      if (const std::size_t at = id.find(end); at != id.npos) id.erase(at, std::string(end).size());
    }
    if (id == "GraspSingleDummy") continue;  // a robot in free space
    CAPTURE(id);
    REQUIRE(ours.contains(id));
    REQUIRE_MESSAGE(horizons.contains(ours.at(id)), ours.at(id));
    CHECK(horizons[ours.at(id)] == entry["max_steps"].get<std::uint32_t>());
    ++seen;
  }
  CHECK(seen == 41);
  CHECK(seen == ours.size());
}
