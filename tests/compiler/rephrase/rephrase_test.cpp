#include "compiler/rephrase/rephrase.h"

#include <doctest/doctest.h>

#include <map>
#include <set>

#include "compiler/rephrase/likeness.h"
#include "tests/compiler/small_suite.h"

using namespace probe;
using rephrase::Options;
using rephrase::Rephrased;

namespace {

const std::string kMore = R"(
template place frame put "place {the source} on {the target}"
template set_on frame put "set {the source} on {the target}"
template rest frame put "rest {the source} on {the target}"
template front frame put "on {the target}, put {the source}"
task toy_on_tray like red_on_tray { say "put {the source} on {target}"; refer source as toy }
task named like red_on_tray { distractors pale }
)";

const test::Analysis& suite() {
  static const auto analysis = test::analyze_with_suite(kMore);
  REQUIRE_MESSAGE(!analysis->diagnostics.has_errors(), analysis->said());
  return *analysis;
}

std::vector<sema::TaskId> tasks(const std::vector<std::string>& names) {
  std::vector<sema::TaskId> ids;
  for (const std::string& name : names) {
    for (std::size_t i = 0; i < suite().model.tasks.size(); ++i) {
      if (suite().model.tasks[suite().model.tasks.id(i)].name == name)
        ids.push_back(suite().model.tasks.id(i));
    }
  }
  REQUIRE(ids.size() == names.size());
  return ids;
}

Rephrased make(const std::vector<std::string>& names, const Options& options,
               const std::vector<rephrase::Evaluation>& not_in = {}) {
  return rephrase::rephrase(suite().model, tasks(names), not_in, options);
}

// By text: whether it is held out. The same text twice must agree.
std::map<std::string, bool> splits(const Rephrased& all) {
  std::map<std::string, bool> by_text;
  for (const auto& of_task : all.tasks) {
    for (const auto& line : of_task.lines)
      CHECK(by_text.try_emplace(line.wording.text, line.is_held_out).first->second ==
            line.is_held_out);
  }
  return by_text;
}

const std::vector<std::string> kAll = {"red_on_tray", "toy_on_tray", "named"};

}  // namespace

TEST_CASE("the splits share no wording across all tasks, not even up to articles and order") {
  std::map<std::string, bool> held_out;
  std::size_t out = 0;
  const std::map<std::string, bool> all = splits(make(kAll, {.held_out = 0.5}));
  for (const auto& [text, is_held_out] : all) {
    out += is_held_out ? 1 : 0;
    CHECK(held_out.try_emplace(rephrase::likeness(text), is_held_out).first->second == is_held_out);
  }
  CHECK(out > 0);
  CHECK(out < all.size());
}

TEST_CASE("a split depends on seed and words, not on which tasks are asked for, nor their order") {
  const Options half{.seed = 7, .held_out = 0.5};
  const std::map<std::string, bool> all = splits(make(kAll, half));
  CHECK(splits(make({"named", "toy_on_tray", "red_on_tray"}, half)) == all);
  for (const auto& [text, is_held_out] : splits(make({"named"}, half)))
    CHECK(all.at(text) == is_held_out);
  CHECK(splits(make(kAll, {.seed = 8, .held_out = 0.5})) != all);
}

TEST_CASE("shares of nothing and everything are that, but for instructions of the text") {
  for (const auto& of_task : make(kAll, {.held_out = 0}).tasks) {
    CHECK(of_task.held_out == 0);
    CHECK(of_task.train == of_task.lines.size());
  }
  // "put toy on the tray" is up to articles what `toy_on_tray` says.
  for (const auto& wording : splits(make(kAll, {.held_out = 1}))) {
    const std::string like = rephrase::likeness(wording.first);
    const bool is_said = like == rephrase::likeness("put toy on tray") ||
                         like == rephrase::likeness("put red block on tray");
    CHECK_MESSAGE(wording.second != is_said, wording.first);
  }
}

TEST_CASE("a cap keeps as many as it says, the same ones whatever else is asked for") {
  const Options capped{.held_out = 0.25, .per_task = 5};
  const Rephrased all = make(kAll, capped);
  for (const auto& of_task : all.tasks) {
    CHECK(of_task.lines.size() == 5);
    CHECK(of_task.candidates ==
          of_task.lines.size() + of_task.refused.total() + of_task.same_words + of_task.over_cap);
  }
  const Rephrased one = make({"named"}, capped);
  REQUIRE(one.tasks[0].lines.size() == 5);
  for (std::size_t i = 0; i < 5; ++i)
    CHECK(one.tasks[0].lines[i].wording.text == all.tasks[2].lines[i].wording.text);
}

TEST_CASE("probabilities of a task add up to one, and the preset gives the instruction a half") {
  const auto sum = [](const rephrase::TaskWordings& of_task) {
    double all = of_task.original_probability;
    for (const auto& line : of_task.lines) {
      CHECK((line.probability == 0) == line.is_held_out);
      all += line.probability;
    }
    return all;
  };
  const Rephrased even = make(kAll, {.held_out = 0.5});
  const Rephrased half = make(kAll, {.held_out = rephrase::kIntactHeldOut,
                                     .per_task = rephrase::kIntactPerTask,
                                     .keep_original = rephrase::kIntactKeepOriginal});
  for (const auto& of_task : even.tasks) {
    CHECK(sum(of_task) == doctest::Approx(1));
    CHECK(of_task.original_probability ==
          doctest::Approx(1 / (static_cast<double>(of_task.train) + 1)));
  }
  for (const auto& of_task : half.tasks) {
    CHECK(sum(of_task) == doctest::Approx(1));
    CHECK(of_task.original_probability == 0.5);
    CHECK(of_task.lines.size() == rephrase::kIntactPerTask);
  }
}

TEST_CASE("where everything is held out, the instruction is all there is to train on") {
  std::size_t seen = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Rephrased all =
        make({"named"}, {.seed = seed, .held_out = 1, .per_task = 1, .keep_original = 0.5});
    REQUIRE(all.tasks[0].lines.size() == 1);
    if (all.tasks[0].train > 0) continue;  // it is alike to an instruction of the text
    CHECK(all.tasks[0].original_probability == 1);
    CHECK(all.tasks[0].lines[0].probability == 0);
    ++seen;
  }
  CHECK(seen > 0);
}

TEST_CASE(
    "an instruction of a suite to be asked is told with wording, task and suite, or left out") {
  const std::vector<rephrase::Evaluation> asked = {
      {"asked.probe", {{"Place a red block on a tray!", "asked_task"}}}};
  const Rephrased told = make(kAll, {}, asked);
  REQUIRE(told.leaks.size() == 3);
  CHECK(told.leaks[0].wording == "place the red block on the tray");
  CHECK(told.leaks[0].leak.task == "asked_task");
  CHECK(told.leaks[0].leak.suite == "asked.probe");
  CHECK_FALSE(told.leaks[0].leak.is_exact);
  CHECK(make({"named"}, {}, {{"x", {{"place the red block on the tray", "t"}}}})
            .leaks[0]
            .leak.is_exact);

  const Rephrased dropped = make(kAll, {.drop_leaks = true}, asked);
  CHECK(dropped.leaks.empty());
  for (std::size_t i = 0; i < kAll.size(); ++i) {
    CHECK(dropped.tasks[i].leaks == 1);
    CHECK(dropped.tasks[i].lines.size() + 1 == told.tasks[i].lines.size());
    for (const auto& line : dropped.tasks[i].lines)
      CHECK(line.wording.text != "place the red block on the tray");
  }
}
