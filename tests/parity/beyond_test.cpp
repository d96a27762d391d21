// The sweep beyond the paper: what it grows to from how few lines, and that its words are new.
#include <doctest/doctest.h>

#include <bit>
#include <set>

#include "runtime/plan/axes.h"
#include "tests/parity/published.h"

using namespace probe;

namespace {

const plan::Plan& beyond() {
  static const plan::Plan plan = test::compile_suite("beyond.probe");
  return plan;
}

std::string base_name(const plan::Plan& plan, const plan::TaskRecord& task) {
  return task.baseline == plan::kNone ? ""
                                      : std::string(plan.text(plan.tasks()[task.baseline].name));
}

std::size_t statements(const std::string& name) {
  std::ifstream in(std::string(VLAPROBE_SOURCE_DIR "/suite/") + name);
  std::size_t count = 0;
  for (std::string line; std::getline(in, line);)
    count += line.find_first_not_of(" ") != std::string::npos && line[0] != '#';
  return count;
}

}  // namespace

TEST_CASE("thousands of tasks come from fewer than 150 lines, each comparison on one axis") {
  const plan::Plan& plan = beyond();
  const plan::SuiteRecord& suite = plan.suites()[*plan.find_suite("beyond")];
  std::size_t episodes = 0;
  std::map<std::string, std::size_t> axes;
  for (const std::uint32_t t : plan.members(suite)) {
    const plan::TaskRecord& task = plan.tasks()[t];
    const std::string name(plan.text(task.name));
    episodes += task.episodes.count;
    if (task.baseline == plan::kNone) continue;
    CHECK_MESSAGE(std::popcount(task.axes) == 1, name);
    for (const std::string_view axis : plan::axis_names(task.axes)) {
      ++axes[std::string(axis)];
    }
  }
  const std::size_t lines = statements("beyond.probe") + statements("paraphrases.probe");
  std::string counts;
  for (const auto& [axis, count] : axes) counts += "\n  " + axis + " " + std::to_string(count);
  MESSAGE(suite.members.count << " tasks, " << episodes << " episodes from " << lines
                              << " lines:" << counts);
  CHECK(suite.members.count >= 2500);
  CHECK(lines < 150);
  for (const char* axis : {"object.source", "object.target", "distractors", "language.paraphrase",
                           "language.appearance", "language.commonsense", "language.negation",
                           "layout", "scene", "light", "camera"}) {
    CHECK_MESSAGE(axes[axis] > 0, axis);
  }
}

TEST_CASE("each verb has twenty other forms or more, none of them a published instruction") {
  const plan::Plan& plan = beyond();
  std::set<std::string> published;
  for (const char* name : {"intact"}) {
    for (const std::uint32_t t : plan.members(plan.suites()[*plan.find_suite(name)]))
      published.emplace(plan.text(plan.tasks()[t].prompt));
  }
  std::map<std::string, std::set<std::string>> forms;  // by the task that is said in other words
  for (const plan::TaskRecord& task : plan.tasks()) {
    if (task.axes != static_cast<std::uint32_t>(plan::Axis::kLanguageParaphrase)) continue;
    const std::string prompt(plan.text(task.prompt));
    CHECK_MESSAGE(!published.contains(prompt), prompt);
    forms[base_name(plan, task)].insert(prompt);
  }
  for (const char* base :
       {"carrot_to_plate", "stack_cube", "eggplant_into_basket", "carrot_carried"}) {
    CHECK_MESSAGE(forms[base].size() >= 20, base);
    MESSAGE(std::string(base) << ": " << forms[base].size() << " forms");
  }
}

TEST_CASE("crowding goes from no distractor to six") {
  const plan::Plan& plan = beyond();
  std::set<std::uint32_t> counts;
  for (const plan::TaskRecord& task : plan.tasks()) {
    const std::string name(plan.text(task.name));
    if (name.starts_with("carrot_on_plate_crowd")) counts.insert(task.distractors);
  }
  CHECK(counts == std::set<std::uint32_t>{0, 1, 2, 3, 4, 5, 6});
}
