#include "runtime/report/event_tables.h"

#include "runtime/report/episode_documents.h"
#include "runtime/report/tables.h"
#include "tests/runtime/report/fake_runs.h"

namespace probe::report {
namespace {

constexpr char kBase[] = "carrot_on_plate";
constexpr char kVariant[] = "carrot_on_plate_lang_action";

struct Made {
  RunsFolder folder;
  Benchmark benchmark;
  ToldEvents events;
  // Every episode of the variant drops its carrot but the first eight; nobody tips anything.
  Made() {
    const plan::Plan plan = suite_plan();
    fake_run(folder / "a", plan, "pi0", {.tasks = {kBase, kVariant}},
             [](const std::string&, int, int) { return Outcome{.success = true}; });
    const std::vector<std::string> dirs = {folder / "a"};
    auto loaded = load(dirs);
    REQUIRE(loaded.ok());
    benchmark = std::move(loaded).value();
    events.metrics = {.events = {"dropped", "tipped"}, .subgoals = {"reached_it", "placed_it"}};
    for (const Episode& e : benchmark.episodes) {
      rejudge::EpisodeEvents told;
      const bool drops = benchmark.tasks[static_cast<std::size_t>(e.task)].name == kVariant && e.start >= 8;
      told.counts = {{"dropped", drops ? 2 : 0}, {"tipped", 0}};
      told.firsts = {{"reached_it", 5}, {"placed_it", drops ? 0 : 9}};
      told.subgoals = 2;
      told.reached = drops ? 1 : 2;
      told.motion = rejudge::motion_of(std::vector<Vec3>{{0, 0, 0}, {0.1, 0, 0}}, 5);
      told.hand_over.why_not = "never placed";
      told.to_grasp.value = 2;
      events.told.emplace_back(std::move(told));
    }
  }
};

}  // namespace

TEST_CASE("events are summed by task with intervals, and a variant is paired with its baseline") {
  const Made made;
  const Benchmark told = benchmark_of_events(made.benchmark, made.events);
  const int dropped = told.find_metric("dropped"), placed = told.find_metric("placed_it");
  const int task = told.find_task(kVariant);
  const auto e = estimate(told, 0, dropped, {task});
  REQUIRE(e);
  CHECK(e->count.k == 16);
  CHECK(e->count.n == 24);
  CHECK(estimate(told, 0, placed, {task})->count.k == 8);
  const Contrast c = variant_contrast(told, 0, dropped, task);
  CHECK(c.pairs.only_a == 16);
  CHECK(c.here.p == doctest::Approx(2.0 / 65536));
  const Json json = events_json(made.benchmark, made.events);
  CHECK(json["names"][2]["label"] == "reached it");
  CHECK(json["names"][2]["subgoal"] == true);
  REQUIRE(json["main"].size() == 4);
  CHECK(json["main"][0]["all"][0] == 16);
  REQUIRE(json["deltas"].size() == 4);
  CHECK(json["deltas"][0]["on_these_starts"]["real"] == true);
  CHECK(json["by_task"]["tipped"][0][0][0] == 0);
  // Time to the grasp has a number everywhere, the time from there nowhere.
  CHECK(json["numbers"][0]["rows"].size() == 2);
  CHECK(json["numbers"][0]["rows"][0][2] == 2.0);
  CHECK(json["numbers"][1]["rows"].empty());
}

TEST_CASE("an episode of which nothing is told counts nowhere, and a task lacks what it lacks") {
  Made made;
  made.events.told[0].reset();
  made.events.told[1]->untold = "invalid: gone";
  for (std::size_t i = 2; i < made.events.told.size(); ++i) {
    if (made.benchmark.episodes[i].task == made.benchmark.find_task(kBase)) made.events.told[i]->counts.pop_back();
  }
  const Benchmark told = benchmark_of_events(made.benchmark, made.events);
  const int first = made.benchmark.episodes[0].task;
  CHECK(estimate(told, 0, told.find_metric("dropped"), {first})->count.n == 22);
  CHECK(!estimate(told, 0, told.find_metric("tipped"), {told.find_task(kBase)}));
}

TEST_CASE("of a run that stops by what it finds, an episode of which nothing is told may have been either") {
  const plan::Plan plan = suite_plan();
  RunsFolder folder;
  std::vector<store::OrderedEpisode> order;
  for (int start = 0; start < 24; ++start) order.push_back({{kBase, start, 42}, {}});
  fake_run(folder / "a", plan, "pi0",
           {.tasks = {kBase}, .until = "width 10 % of each task", .order = order, .run = 24}, always(true));
  const auto benchmark = load(std::vector<std::string>{folder / "a"});
  REQUIRE(benchmark.ok());
  ToldEvents events;
  events.metrics.events = {"dropped"};
  rejudge::EpisodeEvents told;
  told.counts = {{"dropped", 0}};
  events.told.assign(24, told);
  events.told[3].reset();
  const Benchmark made = benchmark_of_events(*benchmark, events);
  const auto rate = estimate(made, 0, made.find_metric("dropped"), {made.find_task(kBase)});
  REQUIRE(rate);
  CHECK(rate->interval.low == doctest::Approx(0));
  CHECK(rate->interval.high == doctest::Approx(1.0 / 24));
}

TEST_CASE("where nothing happened, or nothing was read, there is no table") {
  Made made;
  for (auto& told : made.events.told) {
    for (auto& count : told->counts) count.value = 0;
    told->reached = 0;
  }
  CHECK(events_json(made.benchmark, made.events).is_null());
  CHECK(events_json(made.benchmark, {}).is_null());
}

TEST_CASE("the marks of a timeline are steps with the bodies whose they are") {
  rejudge::EpisodeEvents events;
  events.marks = {{.name = "reached_it", .step = 5, .bodies = "carrot", .of = {0}},
                  {.name = "dropped", .step = 7, .bodies = "carrot", .of = {0}},
                  {.name = "dropped", .step = 9, .bodies = "carrot, plate", .of = {0, 1}}};
  CHECK(encode_events(events, std::vector<std::string>{"dropped", "tipped", "reached_it"}) ==
        "e0:7.0,9.0.1;e2:5.0");
}

}  // namespace probe::report
