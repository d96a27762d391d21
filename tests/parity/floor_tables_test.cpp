// Stored tables of what suites give scripted policies name the plans that they were measured of:
// each is the plan that this tree compiles, with as many trials.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
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

// The families of a column of suite/google/README.md's table, as "219 of 225"; empty where none is.
std::string solved_of(const std::string& suite, const std::vector<std::string>& families) {
  std::ifstream in(kSuites + "google/expert.csv");
  std::size_t played = 0, solved = 0;
  for (std::string line; std::getline(in, line);) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != 5 || cells[0] != suite) continue;
    if (std::ranges::find(families, cells[1]) == families.end()) continue;
    played += std::stoul(cells[3]);
    solved += std::stoul(cells[4]);
  }
  return played == 0 ? "" : std::to_string(solved) + " of " + std::to_string(played);
}

}  // namespace

TEST_CASE("what the Google suite's README says of the expert is what its table holds") {
  // The beginning of a row, and the suite in the table.
  constexpr std::array<std::pair<const char*, const char*>, 6> kRows{
      {{"| the environments", "google"},
       {"| variants, every place", "google_variants_places"},
       {"| variants, all 732 tasks", "google_variants_run"},
       {"| `google_clean`", "google_clean"},
       {"| probing questions, every place", "google_probing_places"},
       {"| probing questions, all 265 tasks", "google_probing"}}};
  const std::vector<std::vector<std::string>> columns = {
      {"can horizontal", "can vertical", "can standing"},
      {"move near"},
      {"open"},
      {"close"},
      {"apple"},
      {"other things"}};
  std::ifstream in(kSuites + "google/README.md");
  std::map<std::string, std::string> rows;  // the last that begins so: of the expert's table
  for (std::string line; std::getline(in, line);)
    for (const auto& [begin, suite] : kRows)
      if (line.starts_with(begin)) rows[suite] = line;
  for (const auto& [begin, suite] : kRows) {
    CAPTURE(begin);
    REQUIRE(rows.contains(suite));
    std::string wanted;
    for (const std::vector<std::string>& families : columns)
      wanted += "| " + solved_of(suite, families) + " ";
    std::string found = rows[suite].substr(rows[suite].find(" |", 1) + 1);
    const std::string full = solved_of(suite, {"full cans"});
    if (!full.empty()) {
      wanted.pop_back();
      wanted += "; full cans and `pick_denser_coke` " + full + " ";
    }
    for (std::size_t at = 0; (at = wanted.find("|  |", at)) != std::string::npos;)
      wanted.erase(at + 1, 1);  // an empty cell
    if (wanted.ends_with("|  ")) wanted.pop_back();
    CHECK(found == wanted + "|");
  }
}

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
