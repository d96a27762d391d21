// What authors are shown works as shown: every example runs, and the commands of the reference's
// first task do what the page says.
#include <doctest/doctest.h>

#include <regex>
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

// All blocks of a kind on a page.
std::vector<std::string> blocks(const std::string& page, const std::string& kind) {
  const std::string open = "```" + kind + "\n";
  std::vector<std::string> out;
  for (std::size_t at = page.find(open); at != std::string::npos; at = page.find(open, at)) {
    at += open.size();
    out.push_back(page.substr(at, page.find("```", at) - at));
  }
  return out;
}

// The tasks that a text writes out; those of a `derive` are other words or other lights of one of
// them.
std::vector<std::string> tasks_of(const std::string& text) {
  static const std::regex kDeclared(R"(^(?:task|variant) (\w+))");
  static const std::regex kListed(R"(^  (\w+)\s*\{)");
  std::vector<std::string> names;
  std::istringstream lines(text);
  bool in_list = false;
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (std::regex_search(line, found, kDeclared) || (in_list && std::regex_search(line, found, kListed)))
      names.push_back(found[1]);
    if (line.starts_with("variants of ")) in_list = !line.ends_with("}");
    if (line.starts_with("}")) in_list = false;
  }
  return names;
}

}  // namespace

// What a page shows is copied; a task that nobody can do teaches nothing.
TEST_CASE("the expert does every task that the pages of the language write out") {
  Sandbox box;
  std::size_t done = 0;
  for (const char* page : {"/dsl/reference.md", "/dsl/std/README.md"}) {
    for (const std::string& text : blocks(read_file(std::string(VLAPROBE_SOURCE_DIR) + page), "probe")) {
      std::string names;
      for (const std::string& name : tasks_of(text)) names += (names.empty() ? "" : ", ") + name;
      // One drawer, open, leaves the expert's hand no room at the next; the page says so.
      if (names.empty() || contains(names, "open_two")) continue;
      const bool is_whole = contains(text, "use \"");
      write_file(box / "shown.probe", (is_whole ? "" : "use \"suite/intact.probe\"\n") + text +
                                          "\nsuite shown_here { tasks { " + names + " }; seeds 0 }\n");
      const std::string out = "shown_" + std::to_string(done);
      const Outcome run = box.vlaprobe("run shown.probe --suite shown_here --policy expert "
                                       "--episodes 0-0 --jobs 2 -o " + out);
      CHECK_MESSAGE(run.exit == 0, names, ": ", run.err);
      const auto rows = probe::Json::parse(box.vlaprobe("results " + out + " --json").out);
      CHECK_MESSAGE(rows.size() >= tasks_of(text).size(), names);
      for (const auto& row : rows) {
        if (row.contains("delay")) continue;  // it does not plan ahead
        CHECK_MESSAGE(row["success"] == true, row.dump(1));
      }
      ++done;
    }
  }
  CHECK(done >= 20);
}

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
