// The main job as a user runs it: one real task from source text to judged, recorded, replayed
// episodes.
#include <doctest/doctest.h>
#include <signal.h>

#include <chrono>
#include <map>
#include <thread>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

using json = probe::Json;

using probe::test::Outcome;
using probe::test::read_file;
using probe::test::Sandbox;
namespace fs = std::filesystem;

namespace {

json results(const Sandbox& box, const std::string& dir) {
  const Outcome outcome = box.vlaprobe("results " + dir + " --json");
  REQUIRE_MESSAGE(outcome.exit == 0, outcome.err);
  return json::parse(outcome.out);
}

int count(const json& rows, const char* metric) {
  int n = 0;
  for (const json& row : rows) n += row[metric].get<bool>() ? 1 : 0;
  return n;
}

// episode -> hash of its trace; fails on an episode that stands twice.
std::map<int, std::string> trace_hashes(const json& rows) {
  std::map<int, std::string> hashes;
  for (const json& row : rows) {
    CHECK(hashes.emplace(row["episode"].get<int>(), row["trace_sha256"].get<std::string>()).second);
  }
  return hashes;
}

void run_expert(const Sandbox& box, const std::string& dir, int jobs) {
  const Outcome outcome =
      box.vlaprobe("run $SUITE --tasks carrot_on_plate --policy expert --jobs " +
                   std::to_string(jobs) + " -o " + dir);
  REQUIRE_MESSAGE(outcome.exit == 0, outcome.err);
}

}  // namespace

TEST_CASE(
    "the expert solves carrot on plate, the same with one job and two, and every episode replays") {
  Sandbox box;
  run_expert(box, "one", 1);
  run_expert(box, "two", 2);
  const json rows = results(box, "one");
  REQUIRE(rows.size() == 24);
  for (const json& row : rows) {
    CHECK(row["task"] == "carrot_on_plate");
    CHECK(row["invalid"].is_null());
    CHECK(row["steps"] == 60);
    CHECK(fs::exists(row["trace"].get<std::string>()));
  }
  CHECK(count(rows, "intention") == 24);
  CHECK(count(rows, "grasp") == 24);
  CHECK(count(rows, "success") >= 22);
  CHECK(count(rows, "wrong") == 0);
  CHECK(trace_hashes(rows) == trace_hashes(results(box, "two")));
  for (int episode = 0; episode < 24; ++episode) {
    const Outcome outcome =
        box.vlaprobe("replay two carrot_on_plate " + std::to_string(episode) + " --verify");
    CHECK_MESSAGE(outcome.exit == 0, outcome.err);
  }
}

TEST_CASE("a run that is killed in the middle continues to the rows of an undisturbed one") {
  Sandbox box;
  run_expert(box, "undisturbed", 2);
  // A shell that execs the program, so that the kill reaches it and nothing else.
  const std::string dir = (box / "killed").string();
  int kills = 0;
  for (int attempt = 0; attempt < 3; ++attempt) {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      freopen("/dev/null", "w", stderr);
      execl(VLAPROBE_BINARY_DIR "/vlaprobe", "vlaprobe", "run",
            VLAPROBE_SOURCE_DIR "/suite/intact.probe", "--tasks", "carrot_on_plate", "--policy",
            "expert", "--jobs", "2", "-o", dir.c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(700 + 450 * attempt));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) ++kills;
  }
  CHECK(kills >= 1);
  run_expert(box, "killed", 2);
  const json rows = results(box, "killed");
  CHECK(rows.size() == 24);
  CHECK(trace_hashes(rows) == trace_hashes(results(box, "undisturbed")));
  // Nothing half-written is left beside the traces that rows name.
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(box / "killed/traces")) {
    if (entry.is_regular_file()) ++files;
  }
  CHECK(files == 24);
}

TEST_CASE("the 24 starts are those of the released benchmark") {
  const fs::path csv = VLAPROBE_SOURCE_DIR "/../shared/reference/intact_starts.csv";
  if (!fs::exists(csv)) {
    MESSAGE("SKIPPED: the released starts are not here");
    return;
  }
  Sandbox box;
  const Outcome outcome = box.vlaprobe("show $SUITE carrot_on_plate --json");
  REQUIRE_MESSAGE(outcome.exit == 0, outcome.err);
  const json starts = json::parse(outcome.out)["starts"];
  CHECK(starts.size() == 24);
  std::istringstream lines(read_file(csv));
  std::string line;
  int compared = 0;
  std::map<int, std::size_t> seen;
  while (std::getline(lines, line)) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    if (cells.size() < 8 || cells[0] != "widowx_carrot_on_plate") continue;
    const int episode = std::stoi(cells[1]);
    const json& object = starts[static_cast<std::size_t>(episode)][seen[episode]++];
    CHECK(object["object"] == cells[2]);
    const char* keys[] = {"x_m", "y_m", "roll_deg", "pitch_deg", "yaw_deg"};
    for (std::size_t k = 0; k < 5; ++k)
      CHECK(object[keys[k]].get<double>() == std::stod(cells[3 + k]));
    ++compared;
  }
  MESSAGE("object poses compared: ", compared);
  CHECK(compared == 48);
}
