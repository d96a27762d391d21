// The stored table of floors and ceilings against what holds by construction: these are tests of
// the metrics.
#include <doctest/doctest.h>

#include <array>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/parity/published.h"

using namespace probe;

namespace {

struct Counts {
  int episodes = 0, intention = 0, grasp = 0, success = 0, wrong = 0;
};
// By policy, then by task.
using Table = std::map<std::string, std::map<std::string, Counts>>;

Table read_floors() {
  std::ifstream in(std::string(VLAPROBE_SOURCE_DIR) + "/suite/floors.csv");
  REQUIRE(in.good());
  Table table;
  std::string line;
  std::getline(in, line);  // the plan
  std::getline(in, line);
  REQUIRE(line == "task,policy,episodes,intention,grasp,success,wrong");
  while (std::getline(in, line)) {
    std::stringstream cells(line);
    std::string task, policy;
    std::getline(cells, task, ',');
    std::getline(cells, policy, ',');
    std::array<int, 5> numbers{};
    for (int& number : numbers) {
      std::string cell;
      std::getline(cells, cell, ',');
      number = std::stoi(cell);
    }
    table[policy][task] = {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]};
  }
  return table;
}

}  // namespace

TEST_CASE("every task of the suite has its floors and its ceiling over all 24 starts") {
  const Table table = read_floors();
  for (const char* policy : {"expert", "null", "random", "reach", "wrong"}) {
    CAPTURE(policy);
    REQUIRE(table.contains(policy));
    CHECK(table.at(policy).size() == 50);
    for (const auto& [task, counts] : table.at(policy)) {
      CAPTURE(task);
      CHECK(counts.episodes == 24);
    }
  }
}

TEST_CASE("the table is of the suite as it is now") {
  std::ifstream in(VLAPROBE_SOURCE_DIR "/suite/floors.csv");
  std::string line;
  REQUIRE(std::getline(in, line));
  CHECK(line == "# plan " + to_hex(test::suite_plan().root()));
}

TEST_CASE("who stays where he is intends nothing and succeeds nowhere") {
  const auto floors = read_floors()["null"];
  for (const auto& [task, counts] : floors) {
    CAPTURE(task);
    CHECK(counts.intention + counts.grasp + counts.success + counts.wrong == 0);
  }
}

TEST_CASE("who goes to the source and never closes intends always and grasps never") {
  const auto floors = read_floors()["reach"];
  for (const auto& [task, counts] : floors) {
    CAPTURE(task);
    CHECK(counts.intention == counts.episodes);
    CHECK(counts.grasp == 0);
    CHECK(counts.success == 0);
  }
}

TEST_CASE("who takes a distractor touches the wrong object always, and stays still where none is") {
  const plan::Plan& plan = test::suite_plan();
  std::size_t crowded = 0;
  const auto floors = read_floors()["wrong"];
  for (const auto& [task, counts] : floors) {
    CAPTURE(task);
    const auto index = plan.find_task(task);
    REQUIRE(index);
    const bool has_distractor = plan.tasks()[*index].distractors > 0;
    crowded += has_distractor;
    CHECK(counts.wrong == (has_distractor ? counts.episodes : 0));
    CHECK(counts.intention + counts.grasp + counts.success == 0);
  }
  CHECK(crowded == 15);
}

TEST_CASE("every start can be solved") {
  int episodes = 0, successes = 0;
  const auto floors = read_floors()["expert"];
  for (const auto& [task, counts] : floors) {
    CAPTURE(task);
    CHECK(counts.success * 5 >= counts.episodes * 4);
    episodes += counts.episodes;
    successes += counts.success;
  }
  MESSAGE("expert: " << successes << " of " << episodes);
  CHECK(successes * 100 >= episodes * 97);
}

namespace {

// By column, of the rows of one policy.
using Row = std::map<std::string, std::string>;
std::vector<Row> kitchen_rows(const std::string& policy) {
  std::ifstream in(VLAPROBE_SOURCE_DIR "/suite/kitchen/floors.csv");
  REQUIRE(in.good());
  std::string line, header;
  std::getline(in, line);  // the plan
  std::getline(in, header);
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    std::stringstream names(header), cells(line);
    std::string name, cell;
    Row row;
    while (std::getline(names, name, ',') && std::getline(cells, cell, ',')) row[name] = cell;
    if (row["policy"] == policy) rows.push_back(std::move(row));
  }
  return rows;
}

int sum(const std::vector<Row>& rows, const char* column) {
  int all = 0;
  for (const Row& row : rows) all += std::stoi(row.at(column));
  return all;
}

}  // namespace

TEST_CASE("in the kitchen the expert does 99 of 100 starts, and who understands nothing none") {
  const std::vector<Row> expert = kitchen_rows("expert");
  CHECK(expert.size() == 24);
  CHECK(sum(expert, "episodes") == 576);
  CHECK(sum(expert, "attempted") == 576);
  CHECK(sum(expert, "success") * 100 >= 576 * 99);
  for (const char* policy : {"null", "random", "reach", "wrong"}) {
    CAPTURE(policy);
    const std::vector<Row> rows = kitchen_rows(policy);
    CHECK(rows.size() == 24);
    CHECK(sum(rows, "episodes") == 576);
    CHECK(sum(rows, "success") == 0);
  }
  CHECK(sum(kitchen_rows("null"), "intention") == 0);
  CHECK(sum(kitchen_rows("wrong"), "intention") == 0);
  CHECK(sum(kitchen_rows("reach"), "intention") == 576);
}
