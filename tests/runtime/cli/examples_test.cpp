// What authors are shown works as shown: every example runs, and the commands of the reference's
// first task do what the page says.
#include <doctest/doctest.h>

#include <sstream>
#include <vector>

#include "runtime/base/json.h"
#include "tests/runtime/cli/program.h"

using probe::test::contains;
using probe::test::Outcome;
using probe::test::read_file;
using probe::test::Sandbox;
using probe::test::write_file;
namespace fs = std::filesystem;

namespace {

// The first block of a kind on a page.
std::string first_block(const std::string& page, const std::string& kind) {
  const std::size_t begin = page.find("```" + kind + "\n");
  REQUIRE(begin != std::string::npos);
  const std::size_t at = begin + kind.size() + 4;
  return page.substr(at, page.find("```", at) - at);
}

}  // namespace

TEST_CASE("every example runs: the first start of each of its tasks, with the policy that rests") {
  Sandbox box;
  std::size_t seen = 0;
  for (const auto& entry : fs::directory_iterator(VLAPROBE_SOURCE_DIR "/examples")) {
    if (entry.path().extension() != ".probe") continue;
    // Its robot is the user's own; tests/runtime/stage/my_robot_test.cpp makes one.
    if (entry.path().stem() == "my_robot") continue;
    const std::string name = entry.path().stem().string();
    const Outcome run = box.vlaprobe("run '" + entry.path().string() +
                                     "' --policy null --episodes 0-0 --jobs 2 -o " + name);
    CHECK_MESSAGE(run.exit == 0, name, ": ", run.err);
    const auto rows = probe::Json::parse(box.vlaprobe("results " + name + " --json").out);
    CHECK_MESSAGE(!rows.empty(), name);
    for (const auto& row : rows) CHECK_MESSAGE(row["invalid"].is_null(), name);
    ++seen;
  }
  CHECK(seen >= 15);
}

TEST_CASE("the first task of the reference goes through every verb that the page shows") {
  Sandbox box;
  const std::string page = read_file(VLAPROBE_SOURCE_DIR "/dsl/reference.md");
  write_file(box / "mine.probe", first_block(page, "probe"));
  std::istringstream lines(first_block(page, "sh"));
  std::size_t verbs = 0;
  for (std::string line; std::getline(lines, line);) {
    line.erase(std::min(line.find('#'), line.size()));
    std::string arguments = line.substr(line.find(' ') + 1);
    // One start of each task is enough here.
    if (arguments.starts_with("run ")) arguments += " --episodes 3-3 --jobs 2";
    const Outcome outcome = box.vlaprobe(arguments);
    CHECK_MESSAGE(outcome.exit == 0, arguments, "\n", outcome.err);
    ++verbs;
  }
  CHECK(verbs >= 9);
  CHECK(contains(box.vlaprobe("list mine.probe --suite mine").out, "put kitchenware"));
  CHECK(fs::exists(box / "starts.svg"));
}
