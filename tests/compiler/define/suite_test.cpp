#include <doctest/doctest.h>

#include <algorithm>

#include "tests/compiler/small_suite.h"

using namespace probe;
using test::analyze_with_suite;

namespace {

std::unique_ptr<test::Analysis> with_prefix(const std::string& prefix,
                                            const std::string& more = "") {
  return analyze_with_suite(more + "suite s { tasks { red_on_tray }; prefix \"" + prefix +
                            "\"; seeds 1 }");
}

}  // namespace

TEST_CASE("a prefix is the beginning of a name") {
  for (const char* good : {"widowx_", "google_robot_", "a", "v2_"}) {
    CAPTURE(good);
    CHECK(with_prefix(good)->codes() == "");
  }
  for (const char* bad :
       {"", " ", "my suite ", "a/b_", "..", "2_", "_", "\u00e9_", "a\u200b_", "*"}) {
    CAPTURE(bad);
    const auto a = with_prefix(bad);
    CHECK(a->codes() == "P0304");
    CHECK(a->underlined() == std::string("\"") + bad + "\"");
  }
}

TEST_CASE("a prefix makes no task's name that of another task") {
  const std::string other = "variant dark_red_on_tray of red_on_tray { light night }\n";
  const auto a = with_prefix("dark_", other);
  CHECK(a->codes() == "P0203");
  CHECK_MESSAGE(
      a->said().find("with it, `red_on_tray` is called `dark_red_on_tray` as another task is") !=
          std::string::npos,
      a->said());
  CHECK(with_prefix("darker_", other)->codes() == "");
}

namespace {

const std::string kVariants =
    "variants of red_on_tray { a { horizon 61 steps }; b { horizon 62 steps } }\n"
    "variant c of a { horizon 63 steps }\n"
    "layout far like pairs { cells spots = grid 2 x 2 at (2cm, 0cm) spread (10cm, 10cm) }\n"
    "variant moved of red_on_tray { layout far }\n";

const sema::Suite& suite_of(const test::Analysis& a, std::string_view name) {
  for (const sema::Suite& suite : a.model.suites) {
    if (suite.name == name) return suite;
  }
  FAIL("no such suite");
  return a.model.suites[sema::SuiteId{}];
}

// Of each member in order, "a: 1 4".
std::string drawn(const test::Analysis& a, std::string_view name = "s") {
  std::string text;
  for (const sema::TaskId id : suite_of(a, name).members) {
    const sema::Task& task = a.model.tasks[id];
    text += (text.empty() ? "" : "; ") + task.name + ":";
    for (const std::uint32_t start : suite_of(a, name).starts_of(id, task))
      text += " " + std::to_string(start);
  }
  return text;
}

std::unique_ptr<test::Analysis> sampled(const std::string& body, const std::string& more = "") {
  return analyze_with_suite(kVariants + more + "suite s { " + body + "; seeds 1 }");
}

std::size_t episodes_of(const test::Analysis& a) {
  std::size_t count = 0;
  for (const auto& [id, starts] : suite_of(a, "s").drawn) count += starts.size();
  return count;
}

}  // namespace

TEST_CASE("a suite runs some episodes of tasks, the same ones whatever else there is") {
  const std::string five = "tasks { red_on_tray }; sample 5 episodes of { a, b } seed 7";
  const auto a = sampled(five);
  CHECK_MESSAGE(a->codes() == "", a->said());
  CHECK(episodes_of(*a) == 5);
  CHECK(drawn(*a) == drawn(*sampled(five)));
  CHECK(drawn(*a) !=
        drawn(*sampled("tasks { red_on_tray }; sample 5 episodes of { a, b } seed 8")));
  // What a further task takes is at most what it is given.
  const auto more = sampled("tasks { red_on_tray }; sample 5 episodes of { a, b, d } seed 7",
                            "variant d of red_on_tray { horizon 64 steps }\n");
  CHECK(episodes_of(*more) == 5);
  std::size_t kept = 0;
  for (const auto& [id, starts] : suite_of(*a, "s").drawn) {
    const auto now = suite_of(*more, "s").drawn.find(id);
    if (now == suite_of(*more, "s").drawn.end()) continue;
    for (const std::uint32_t start : starts)
      kept += std::count(now->second.begin(), now->second.end(), start) > 0 ? 1 : 0;
  }
  CHECK(kept >= 2);
  // `red_on_tray` is run whole.
  CHECK(suite_of(*a, "s").drawn.size() <= 2);
  CHECK(suite_of(*a, "s").members.front() == suite_of(*more, "s").members.front());
  CHECK(sampled("sample 5 episode of { a, b } seed 7")->codes() == "P0101");
}

TEST_CASE("a sample with baselines has the same starts of what is compared") {
  const auto a = sampled("sample 4 episodes of { b, c } seed 3 with baselines");
  CHECK_MESSAGE(a->codes() == "", a->said());
  const sema::Suite& suite = suite_of(*a, "s");
  CHECK(suite.cuts.empty());
  std::size_t pairs = 0;
  for (const auto& [id, starts] : suite.drawn) {
    const sema::TaskId baseline = a->model.tasks[id].baseline;
    if (baseline == sema::TaskId::kNone) continue;
    const std::vector<std::uint32_t>& there = suite.drawn.at(baseline);
    for (const std::uint32_t start : starts) {
      CHECK(std::count(there.begin(), there.end(), start) == 1);
      ++pairs;
    }
    // What it is compared with stands before it.
    CHECK(std::find(suite.members.begin(), suite.members.end(), baseline) <
          std::find(suite.members.begin(), suite.members.end(), id));
  }
  CHECK(pairs >= 4);
  // Where places differ no start is another's: all of the baseline's are run.
  const auto moved = sampled("sample 2 episodes of { moved } seed 3 with baselines");
  CHECK_MESSAGE(moved->codes() == "", moved->said());
  const std::size_t all = moved->model.tasks[suite_of(*moved, "s").members[0]].starts.size();
  CHECK(episodes_of(*moved) == all + 2);
}

TEST_CASE("a sample of episodes says which comparisons it cut") {
  const auto a = sampled("sample 4 episodes of { a, b } seed 3");
  CHECK(a->codes() == "P0706");
  CHECK_MESSAGE(a->said().find("runs 4 episodes of 2 variants of this sample without what they are "
                               "compared with") != std::string::npos,
                a->said());
  CHECK(sampled("tasks { red_on_tray }; sample 4 episodes of { a, b } seed 3")->codes() == "");
  const auto some = sampled(
      "sample 1 episodes of { red_on_tray } seed 3; "
      "sample 1 episodes of { a } seed 4");
  const sema::Suite& suite = suite_of(*some, "s");
  REQUIRE(suite.members.size() == 2);
  const bool same = suite.drawn.at(suite.members[0]) == suite.drawn.at(suite.members[1]);
  CHECK(some->codes() == (same ? "" : "P0706"));
}

TEST_CASE("what a sample of episodes cannot be") {
  CHECK(sampled("tasks { a, red_on_tray }; sample 4 episodes of { a } seed 3")->codes() == "P0203");
  CHECK(sampled("sample 4 episodes of { red_on_tray } seed 3; "
                "sample 2 episodes of { red_on_tray } seed 4")
            ->codes() == "P0203");
  CHECK(sampled("sample 4000 episodes of { red_on_tray } seed 3")->codes() == "P0304");
  CHECK(sampled("sample 0 episodes of { red_on_tray } seed 3")->codes().find("P0304") == 0);
  CHECK(sampled("sample 4 episodes of { nobody } seed 3")->codes() == "P0201");
  CHECK(
      sampled("sample 4 episodes of { red_on_tray } seed 3; expect 1 tasks, 4 episodes")->codes() ==
      "");
  CHECK(
      sampled("sample 4 episodes of { red_on_tray } seed 3; expect 1 tasks, 5 episodes")->codes() ==
      "P0504");
}
