// Stored tables of what suites give scripted policies name the plans that they were measured of:
// each is the plan that this tree compiles, with as many trials.
#include <doctest/doctest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/plan/plan.h"
#include "tests/runtime/run/plan_of_text.h"

using namespace probe;

namespace {

const std::string kSuites = VLAPROBE_SOURCE_DIR "/suite/";

// A table begins with lines `# plan ROOT`, or `# plan ROOT FILE SUITE` where it is of several.
struct FloorTable {
  const char *file, *text, *suite;
};
constexpr FloorTable kTables[] = {
    {"google/floors.csv", "google/one_colouring.probe", "google_one_colouring"},
    {"google/expert.csv", "", ""},
    {"kitchen/floors.csv", "kitchen.probe", "kitchen"},
};

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream parts(line);
  for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

TEST_CASE("tables of floors and ceilings are of the suites as they are now") {
  for (const FloorTable& table : kTables) {
    CAPTURE(table.file);
    std::ifstream in(kSuites + table.file);
    REQUIRE(in.good());
    std::map<std::string, std::size_t> trials;  // by suite
    std::string line;
    while (std::getline(in, line) && line.starts_with("#")) {
      std::istringstream words(line);
      std::string mark, kind, root, text = table.text, suite = table.suite;
      words >> mark >> kind;
      if (kind != "plan") continue;
      words >> root;
      if (text.empty()) words >> text >> suite;
      const plan::Plan plan = run::plan_of_file(kSuites + text, suite);
      CAPTURE(suite);
      CHECK(root == to_hex(plan.root()));
      trials[suite] = plan.episode_count(plan.suites().front());
    }
    CHECK(!trials.empty());
    // Of tables of several suites: rows `suite,family,trials,..`.
    const std::vector<std::string> names = cells_of(line);
    REQUIRE(!names.empty());
    if (names[0] != "suite") continue;
    REQUIRE(names == std::vector<std::string>{"suite", "family", "trials", "played", "success"});
    std::map<std::string, std::size_t> counted;
    while (std::getline(in, line)) {
      const std::vector<std::string> cells = cells_of(line);
      REQUIRE(cells.size() == names.size());
      counted[cells[0]] += std::stoul(cells[2]);
      CAPTURE(line);
      CHECK(std::stoul(cells[3]) <= std::stoul(cells[2]));  // played
      CHECK(std::stoul(cells[4]) <= std::stoul(cells[3]));  // solved
    }
    CHECK(counted == trials);
  }
}
