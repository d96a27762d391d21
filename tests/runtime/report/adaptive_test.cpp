// A run that stops by what it finds, wherever rates are shown: intervals that hold whenever it
// stopped, and no test of a fixed number of episodes.
#include <doctest/doctest.h>

#include <algorithm>

#include "runtime/adaptive/sampled.h"
#include "runtime/report/agreement.h"
#include "runtime/report/compare_folders.h"
#include "runtime/report/gate.h"
#include "runtime/report/models.h"
#include "runtime/report/page_data.h"
#include "runtime/report/table_text.h"
#include "runtime/report/tables.h"
#include "tests/runtime/report/fake_runs.h"

namespace probe::report {
namespace {

const std::vector<std::string> kTasks = {"carrot_on_plate", "carrot_on_plate_lang_action"};
const std::string kEach = "width 10 % of each task", kAll = "width 10 % of all tasks";

// Start after start, the seeds of each together.
std::vector<store::OrderedEpisode> order_of(const std::vector<std::string>& tasks,
                                            const std::vector<int>& seeds = {42}) {
  std::vector<store::OrderedEpisode> order;
  for (int episode = 0; episode < 24; ++episode) {
    for (const std::string& task : tasks) {
      for (const int seed : seeds) order.push_back({{task, episode, seed}, {}});
    }
  }
  return order;
}

// All of the first task, 8 episodes of the other.
std::vector<store::OrderedEpisode> unlike_order() {
  auto order = order_of({kTasks[0]});
  for (const auto& one : order_of({kTasks[1]})) order.push_back(one);
  return order;
}

Outcome half(const std::string& task, int episode, int) {
  return {task == kTasks[1] || episode % 2 == 0};
}

Benchmark must_load(const std::vector<std::string>& dirs) {
  auto benchmark = load(dirs);
  REQUIRE_MESSAGE(benchmark.ok(), to_text(benchmark.failure()));
  return std::move(*benchmark);
}

Comparison compared(const Benchmark& benchmark, int a, int b,
                    const std::vector<std::string>& metrics = {}) {
  auto comparison = compare(benchmark, a, b, {.metrics = metrics});
  REQUIRE_MESSAGE(comparison.ok(), to_text(comparison.failure()));
  return std::move(*comparison);
}

TEST_CASE("rates of a run that stops by itself have its intervals, and are what all would find") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  fake_run(folder / "a", plan, "pi0",
           {.tasks = kTasks, .until = kEach, .order = unlike_order(), .run = 32}, half);
  const Benchmark benchmark = must_load({folder / "a"});
  REQUIRE(benchmark.is_adaptive(0));
  CHECK(benchmark.policies[0].label == "pi0 (until width 10 % of each task)");
  const int success = benchmark.find_metric("success");
  const auto one = estimate(benchmark, 0, success, {benchmark.find_task(kTasks[1])});
  const stats::Interval expected = stats::rate_of_drawn({24, 8, 0, 0});
  CHECK(one->interval.low == doctest::Approx(expected.low));
  CHECK(one->interval.high == doctest::Approx(expected.high));
  CHECK_FALSE(one->weighted);
  const auto all = estimate(
      benchmark, 0, success, {benchmark.find_task(kTasks[0]), benchmark.find_task(kTasks[1])});
  CHECK(all->count.k == 20);
  CHECK(all->count.n == 32);
  CHECK(all->rate() == doctest::Approx(0.75));  // not 20 of 32
  CHECK(rate_text(*all) == "75.0");
  CHECK(to_json(all).dump().find(",0.75]") != std::string::npos);

  const Tables tables = make_tables(benchmark);
  CHECK(tables.deltas.empty());
  CHECK(tables.category_deltas.empty());
  CHECK(tables.gap.empty());
  const auto csv = table_text(benchmark, tables, {}, *table_format("csv"));
  CHECK(csv.find("pi0 (until width 10 % of each task),success,75.0") != std::string::npos);
  const auto json = table_text(benchmark, tables, {}, *table_format("json"));
  CHECK(json.find("hold whenever it stopped") != std::string::npos);
  CHECK(table_text(benchmark, tables, {}, *table_format("latex")).find("hold whenever it stopped") !=
        std::string::npos);
  const Json page = page_data(benchmark, tables, PageOptions{.title = "t"});
  CHECK(page.at("interval").text().find("hold whenever it stopped") != std::string::npos);
  CHECK(page.at("notes").dump().find("which tests and intervals of a fixed number do not allow for") !=
        std::string::npos);
  CHECK(page.at("tables").at("deltas").empty());
}

TEST_CASE("beside others it is in no difference, ranking or model") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  fake_run(folder / "a", plan, "pi0",
           {.tasks = kTasks, .until = kAll, .order = order_of(kTasks), .run = 30}, half);
  fake_run(folder / "b", plan, "octo", {.tasks = kTasks}, half);
  fake_run(folder / "c", plan, "rt1", {.tasks = kTasks}, always(false));
  const Benchmark benchmark = must_load({folder / "a", folder / "b", folder / "c"});
  const Tables tables = make_tables(benchmark);
  REQUIRE_FALSE(tables.policies.empty());
  for (const PolicyRow& row : tables.policies) {
    CHECK(row.a != 0);
    CHECK(row.b != 0);
  }
  CHECK(std::ranges::none_of(tables.deltas, [](const DeltaRow& row) { return row.policy == 0; }));
  const int success = benchmark.find_metric("success");
  for (const RankRow& row : ranking(benchmark, success)) CHECK(row.policy != 0);
  for (const SequentialRow& row : sequential(benchmark, success)) CHECK(row.a != 0);
  for (const MixedModel& model : mixed_models(benchmark, {success}))
    CHECK(model.rows <= 2 * 2 * 24);

  GateOptions options;
  const auto judged = gate(benchmark, options);
  REQUIRE_FALSE(judged.ok());
  CHECK(judged.failure().message.find("nothing is said: how many episodes were run") == 0);
  CHECK(judged.failure().where == folder / "a");
}

TEST_CASE("rows behind a gap do not count yet") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  std::vector<store::OrderedEpisode> order = order_of({kTasks[0]});
  std::swap(order[5], order[20]);  // the sixth place is missing
  fake_run(folder / "a", plan, "pi0",
           {.tasks = {kTasks[0]}, .until = kEach, .order = order, .run = 10}, always(true));
  const Benchmark before = must_load({folder / "a"});
  CHECK(before.episodes.size() == 10);
  std::rotate(order.begin() + 5, order.begin() + 6, order.end());
  std::vector<store::OrderedEpisode> with_gap = order;
  with_gap.insert(with_gap.begin() + 5, {{kTasks[0], 23, 42}, {}});
  with_gap.erase(std::find(with_gap.begin() + 6, with_gap.end(), with_gap[5]));
  {
    auto store = store::Store::open(folder / "a", *store::read_run_record(folder / "a"), {});
    REQUIRE((*store)->set_order(with_gap).ok());
  }
  const Benchmark after = must_load({folder / "a"});
  CHECK(after.episodes.size() == 5);
  CHECK(std::ranges::any_of(after.notes, [](const Note& note) {
    return note.text.find("rows do not count yet") != std::string::npos;
  }));
}

TEST_CASE("two runs are compared start by start, at any time, in whichever order they are named") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  fake_run(folder / "a", plan, "pi0",
           {.tasks = kTasks, .until = kAll, .order = order_of(kTasks), .run = 20}, always(true));
  fake_run(folder / "b", plan, "octo", {.tasks = kTasks}, always(false));
  const Benchmark benchmark = must_load({folder / "a", folder / "b"});
  const Comparison one = compared(benchmark, 0, 1), other = compared(benchmark, 1, 0);
  CHECK(one.rows.empty());
  REQUIRE(one.anytime.size() == 1);
  CHECK(one.anytime[0].won == 20);
  CHECK(other.anytime[0].lost == 20);
  CHECK(one.words[0].find("pi0 (until width 10 % of all tasks) is better on these starts (20 of 20 "
                          "(100.0 %) against 0 of 20 (0.0 %); of 20 starts") != std::string::npos);
  CHECK(other.words[0].find("pi0 (until width 10 % of all tasks) is better") != std::string::npos);
  CHECK(to_json(benchmark, one).at("at_any_time")[0].at("real").get<bool>());
  CHECK(to_text(benchmark, one).find("for starts never tried are left out") != std::string::npos);
  CHECK(compared(benchmark, 0, 1, {"success", "grasp"}).anytime.size() == 2);

  CHECK(one.words[0].find("left out") == std::string::npos);

  // Starts that only the run that stops has are no part of it, and said.
  fake_run(folder / "d", plan, "half", {.tasks = kTasks, .last = 5}, always(false));
  const Benchmark fewer = must_load({folder / "a", folder / "d"});
  for (const bool mirrored : {false, true}) {
    const Comparison with = compared(fewer, mirrored ? 1 : 0, mirrored ? 0 : 1);
    CHECK(with.anytime[0].starts == 12);
    CHECK(with.words[0].find("; 8 starts that half has not run are left out") != std::string::npos);
    CHECK(to_json(fewer, with).at("at_any_time")[0].at("left_out").get<int>() == 8);
  }

  // Alike: not decided.
  fake_run(folder / "c", plan, "rt1", {.tasks = kTasks}, always(true));
  const Benchmark alike = must_load({folder / "a", folder / "c"});
  CHECK(compared(alike, 0, 1).words[0].find("not decided on these starts") != std::string::npos);
}

TEST_CASE("a decision takes a start with its seeds as one, and is called by whom it was against") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  const std::vector<int> seeds = {1, 2, 3};
  // 8 starts, and one seed of a ninth, whose others are under way.
  fake_run(folder / "a", plan, "pi0",
           {.tasks = {kTasks[0]},
            .seeds = seeds,
            .until = "decided against `octo` (outcomes 0123456789abcdef)",
            .order = order_of({kTasks[0]}, seeds),
            .run = 25},
           always(true));
  fake_run(folder / "b", plan, "octo", {.tasks = {kTasks[0]}, .seeds = seeds}, always(false));
  const Benchmark benchmark = must_load({folder / "a", folder / "b"});
  CHECK(benchmark.policies[0].label == "pi0 (until decided against `octo`)");
  const Comparison comparison = compared(benchmark, 0, 1);
  CHECK(comparison.anytime[0].starts == 8);
  CHECK(comparison.anytime[0].won == 8);
  CHECK(comparison.anytime[0].first.n == 24);
  CHECK(comparison.anytime[0].is_real());
}

TEST_CASE("what nobody knows of the other one counts against whatever is to be decided") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  fake_run(folder / "a", plan, "pi0",
           {.tasks = {kTasks[0]}, .until = kAll, .order = order_of({kTasks[0]}), .run = 12},
           always(true));
  const auto with_invalid = [](int invalid) {
    return [invalid](const std::string&, int episode, int) {
      Outcome outcome{false};
      if (episode < invalid) outcome.invalid = "policy: gone";
      return outcome;
    };
  };
  fake_run(folder / "few", plan, "few", {.tasks = {kTasks[0]}}, with_invalid(1));
  fake_run(folder / "many", plan, "many", {.tasks = {kTasks[0]}}, with_invalid(6));
  CHECK(compared(must_load({folder / "a", folder / "few"}), 0, 1).anytime[0].is_real());
  CHECK_FALSE(compared(must_load({folder / "a", folder / "many"}), 0, 1).anytime[0].is_real());
}

TEST_CASE("comparisons that nobody can vouch for are refused with the reason") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  fake_run(folder / "b", plan, "octo", {.tasks = kTasks, .seeds = {1, 2}}, half);
  fake_run(folder / "seeds", plan, "pi0",
           {.tasks = kTasks, .seeds = {1, 2}, .until = kAll, .order = order_of(kTasks, {1, 2}), .run = 21},
           half);
  const auto refusal = [&](const std::string& a, const std::string& b) {
    const auto refused = compare(must_load({folder / a, folder / b}), 0, 1);
    REQUIRE_FALSE(refused.ok());
    return refused.failure().message;
  };
  CHECK(refusal("seeds", "b").find("takes the seeds of a start apart") != std::string::npos);
  fake_run(folder / "each", plan, "rt1",
           {.tasks = kTasks, .until = kEach, .order = order_of(kTasks), .run = 20}, half);
  fake_run(folder / "all", plan, "rt2",
           {.tasks = kTasks, .until = kAll, .order = order_of(kTasks), .run = 20}, half);
  CHECK(refusal("each", "all").find("stops by what it finds, too, in another order") !=
        std::string::npos);
  fake_run(folder / "one", plan, "octo", {.tasks = kTasks}, half);
  {
    // A call with two worlds that was cut off.
    auto store = store::Store::open(folder / "each", *store::read_run_record(folder / "each"), {});
    store::RunCall call;
    call.worlds = 2;
    REQUIRE((*store)->write_call(call).ok());
  }
  CHECK(refusal("each", "one").find("were cut off") != std::string::npos);
}

TEST_CASE("real rates are held against no rate of a run that stops by itself") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  fake_run(folder / "a", plan, "pi0",
           {.tasks = kTasks, .until = kAll, .order = order_of(kTasks), .run = 30}, half);
  RateTable table;
  const auto left_out = add_runs(table, must_load({folder / "a"}));
  REQUIRE_FALSE(left_out.empty());
  CHECK(left_out[0].find("is left out: how many episodes were run") != std::string::npos);
}

}  // namespace
}  // namespace probe::report
