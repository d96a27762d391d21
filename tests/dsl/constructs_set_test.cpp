// Sets of tasks and suites. Each case begins with the productions it holds.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "tests/dsl/built.h"

using namespace probe;
using namespace probe::test;

namespace {

const char* const kVariants = R"(
object novel like red { unseen; name "novel block" }
scene dim like bench { light night }
template avoiding frame put "put {source} on {the target}, not {avoid the pale}"
variants of red_on_tray {
  said   { say take }
  seen   { refer source as by_color }
  known  { refer source as loved }
  crowd  { distractors pale }
  blue   { source blue }
  new    { source novel }
  dark   { light night }
  longer { horizon 61 steps }
}
variant not_pale of crowd { say avoiding }
variant crowd_said of crowd { say take }
metrics late { success = once height(source) > height(target) }
variant late of red_on_tray { metrics late }
)";

// The members of `set s = TEXT` behind the tasks above, in order.
std::string set_of(const std::string& text) {
  const auto a = analyze_with_suite(std::string(kVariants) + "set s = " + text + "\n");
  CHECK_MESSAGE(!a->diagnostics.has_errors(), a->said());
  return names_text(*a, named(a->model.sets, "s").members);
}

}  // namespace

TEST_CASE("set, t1: names in the order written, `tasks` in the order of the text") {
  CHECK(set_of("{ dark, said, dark }") == "dark said");
  CHECK(set_of("tasks") ==
        "red_on_tray said seen known crowd blue new dark longer not_pale crowd_said late");
  CHECK(set_of("variants of { red_on_tray }") == "said seen known crowd blue new dark longer late");
  CHECK(set_of("variants of variants of { red_on_tray }") == "not_pale crowd_said");
  CHECK(set_of("other\nset other = { said }") == "said");
  CHECK(analyze_with_suite("set a = b\nset b = a")->codes() == "P0207");
  CHECK(analyze_with_suite("set a = { red_on_try }")->codes() == "P0201");
}

TEST_CASE("t_op, taskset: union, intersection and difference from the left; `where` comes last") {
  CHECK(set_of("{ said, seen } | { seen, dark }") == "said seen dark");
  CHECK(set_of("{ said, seen } & { seen, dark }") == "seen");
  CHECK(set_of("{ said, seen } - { seen, dark }") == "said");
  CHECK(set_of("{ said, seen } | { dark } - { said }") == "seen dark");
  CHECK(set_of("{ said, seen } | ({ dark } - { said })") == "said seen dark");
  CHECK(set_of("{ said } | { dark, seen } where axis light") == "dark");
  CHECK(set_of("{ said } | ({ dark, seen } where axis light)") == "said dark");
}

TEST_CASE("cond, c_and, c_not: `not` before `and` before `or`") {
  CHECK(set_of("tasks where axis light or axis goal") == "dark longer late");
  CHECK(set_of("tasks where has distractors and uses action") == "crowd_said");
  CHECK(set_of("tasks where axis light or has distractors and uses action") == "dark crowd_said");
  CHECK(set_of("tasks where (axis light or has distractors) and uses action") == "crowd_said");
  CHECK(set_of("{ said, crowd, dark } where not has distractors and not axis light") == "said");
  CHECK(set_of("{ said, crowd, dark } where not (has distractors or axis light)") == "said");
}

TEST_CASE("c_not: axis is what moved against the baseline, uses is what the instruction does") {
  CHECK(set_of("tasks where axis object.source") == "blue new");
  CHECK(set_of("tasks where axis distractors") == "crowd");
  CHECK(set_of("tasks where axis language.action") == "said crowd_said");
  CHECK(set_of("tasks where axis language.appearance") == "seen");
  CHECK(set_of("tasks where axis language.commonsense") == "known");
  CHECK(set_of("tasks where axis language.negation") == "not_pale");
  CHECK(set_of("tasks where axis goal") == "longer late");
  CHECK(set_of("tasks where uses action") == "said crowd_said");
  CHECK(set_of("tasks where uses appearance") == "seen");
  CHECK(set_of("tasks where uses commonsense") == "known");
  CHECK(set_of("tasks where uses negation") == "not_pale");
  const auto a = analyze_with_suite("set s = tasks where axis language.acton");
  CHECK(a->codes() == "P0201");
  CHECK(a->underlined() == "language.acton");
}

TEST_CASE("c_not: ood, has and scene") {
  CHECK(set_of("tasks where ood source") == "new");
  CHECK(set_of("tasks where ood target").empty());
  CHECK(set_of("tasks where ood relation") == "blue");
  CHECK(set_of("tasks where has distractors") == "crowd not_pale crowd_said");
  CHECK(set_of("tasks where not has baseline") == "red_on_tray");
  CHECK(set_of("tasks where not scene bench").empty());
  CHECK(analyze_with_suite("set s = tasks where scene benc")->codes() == "P0201");
  CHECK(analyze_with_suite("set s = tasks where has distractor")->codes() == "P0201");
}

TEST_CASE("t1: a sample is fixed by its seed, keeps the order, and a new task moves at most one") {
  const std::string three = set_of("sample 3 of tasks seed 7");
  CHECK(std::count(three.begin(), three.end(), ' ') == 2);
  CHECK(set_of("sample 3 of tasks seed 7") == three);
  std::set<std::string> others;
  for (int seed = 0; seed < 8; ++seed)
    others.insert(set_of("sample 3 of tasks seed " + std::to_string(seed)));
  CHECK(others.size() > 4);
  CHECK(set_of("sample 2 of { dark, said } seed 1") == "dark said");
  CHECK(analyze_with_suite("set s = sample 2 of tasks seed 1")->codes() == "P0304");
}

TEST_CASE("suite, suite_st: tasks, prefix, seeds and training set as the plan has them") {
  const Built built(
      std::string(kVariants) +
      "suite s trained on lab { tasks { said, red_on_tray }; prefix \"lab_\"; seeds 7, 42\n"
      "  expect 2 tasks, 48 episodes }\nsuite t { tasks { dark }; seeds 0 }\n");
  const plan::Plan& plan = built.plan();
  REQUIRE(plan.suites().size() == 2);
  const plan::SuiteRecord& suite = plan.suites()[0];
  CHECK(plan.text(suite.prefix) == "lab_");
  CHECK(plan.text(suite.trained_on) == "lab");
  REQUIRE(plan.members(suite).size() == 2);
  CHECK(plan.text(plan.tasks()[plan.members(suite)[0]].name) == "said");
  CHECK(plan.seeds(suite)[0] == 7);
  CHECK(plan.seeds(suite)[1] == 42);
  CHECK(plan.find_task("lab_said") == plan.find_task("said"));
  CHECK(plan.text(plan.suites()[1].trained_on).empty());
  CHECK(analyze_with_suite("suite s { tasks tasks; seeds 1; expect 2 tasks, 24 episodes }")
            ->codes() == "P0504");
  CHECK(analyze_with_suite("suite s { tasks { base }; seeds 1 }")->codes() == "P0703");
  CHECK(analyze_with_suite("suite s { seeds 1 }")->codes() == "P0206");
  CHECK(analyze_with_suite(
            "suite s trained on lab { tasks { v }; seeds 1 }\nvariant v of red_on_tray { source "
            "untagged }\nobject untagged { mesh \"block\"; box 1cm x 1cm x 1cm; density "
            "500kg/m3; friction 1; name \"thing\"; rest roll 0deg yaw 0deg, roll 0deg yaw 90deg }")
            ->codes() == "P0705");
}

TEST_CASE("set: every set is a category of its tasks in the plan") {
  const Built built(std::string(kVariants) + "set worded = tasks where uses action\n");
  const plan::Plan& plan = built.plan();
  REQUIRE(plan.sets().size() == 1);
  CHECK(plan.text(plan.sets()[0].name) == "worded");
  CHECK(plan.members(plan.sets()[0]).size() == 2);
}
