// All tasks of the benchmark, held against what was read by its own program.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/libero/bddl.h"
#include "runtime/libero/suites.h"
#include "tests/runtime/libero/reference.h"

namespace probe::libero {
namespace {

std::string lower(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

// [["on", "a", "b"]]
std::vector<std::vector<std::string>> facts_of(const std::vector<BddlFact>& facts) {
  std::vector<std::vector<std::string>> all;
  for (const BddlFact& fact : facts) {
    all.push_back({fact.predicate});
    all.back().insert(all.back().end(), fact.arguments.begin(), fact.arguments.end());
  }
  return all;
}

}  // namespace

TEST_CASE("130 tasks: instruction, horizon, goal, order, names, regions") {
  if (!test::has_reference()) {
    MESSAGE("skipped: no ../shared/reference/libero");
    return;
  }
  const auto text = read_file(test::reference() + "libero_tasks.json");
  REQUIRE(text.ok());
  const Json tasks = Json::parse(*text)["tasks"];
  REQUIRE(tasks.size() == 130);
  std::size_t at = 0, differ = 0, odd = 0;
  for (const Suite& suite : suites()) {
    const std::string folder = test::reference() + "bddl_files/" + std::string(suite.folder);
    std::vector<std::string> stems;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      stems.push_back(entry.path().stem().string());
    const TaskOrder order = order_tasks(suite, stems);
    CHECK(order.missing.empty());
    CHECK(order.strange.empty());
    REQUIRE(order.stems.size() == suite.tasks);
    for (std::size_t index = 0; index < suite.tasks; ++index) {
      const Json& task = tasks[at++];
      CAPTURE(at);
      CHECK(task["suite"].text() == suite.folder);
      CHECK(task["index"].get<std::size_t>() == index);
      CHECK(task["file"].text() == order.stems[index] + ".bddl");
      CHECK(task["horizon"].get<std::size_t>() == suite.horizon);
      CHECK(task["language"].text() == instruction_of(order.stems[index]));
      const std::string path = folder + "/" + order.stems[index] + ".bddl";
      const auto bddl = read_file(path);
      REQUIRE(bddl.ok());
      const BddlRead read = read_bddl(*bddl, path);
      for (const Failure& mistake : read.mistakes) FAIL_CHECK(to_text(mistake));
      odd += read.oddities.size();
      const BddlProblem& problem = read.problem;
      CHECK(lower(task["problem"].text()) == problem.problem_class);
      CHECK(lower(task["bddl_language"].text()) == lower(problem.language));
      const bool is_same = lower(problem.language) == instruction_of(order.stems[index]);
      CHECK(task["language_differs"].get<bool>() != is_same);
      differ += is_same ? 0 : 1;
      CHECK(task["init"].get<std::vector<std::vector<std::string>>>() == facts_of(problem.init));
      CHECK(task["goal"].get<std::vector<std::vector<std::string>>>() == facts_of(problem.goal));
      CHECK(task["obj_of_interest"].get<std::vector<std::string>>() == problem.interest);
      REQUIRE(task["objects"].size() == problem.objects.size());
      for (std::size_t i = 0; i < problem.objects.size(); ++i) {
        const auto& [name, said] = task["objects"].items()[i];
        CHECK(name == problem.objects[i].name);
        CHECK(said["category"].text() == problem.objects[i].category);
      }
      for (const auto& [name, said] : task["fixtures"].items()) {
        const BddlThing* fixture = problem.find_fixture(name);
        REQUIRE(fixture != nullptr);
        CHECK(said["category"].text() == fixture->category);
      }
      for (const auto& [name, said] : task["regions"].items()) {
        const BddlRegion* region = problem.find_region(name);
        REQUIRE(region != nullptr);
        CHECK(said["target"].text() == region->target);
        std::vector<std::vector<double>> ranges;
        for (const auto& range : region->ranges) ranges.emplace_back(range.begin(), range.end());
        CHECK(said["ranges"].get<std::vector<std::vector<double>>>() == ranges);
        const std::array<double, 2> yaw = region->yaw.value_or(std::array<double, 2>{});
        CHECK(said["yaw_rotation"].get<std::vector<double>>() ==
              std::vector<double>(yaw.begin(), yaw.end()));
      }
      CHECK(task["regions"].size() == problem.regions.size());
    }
  }
  CHECK(differ == 29);
  MESSAGE(odd << " oddities");
}

}  // namespace probe::libero
