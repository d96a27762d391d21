// What a change of task costs, one worker that plays two tasks of different scenes in turns; and
// what a control step does.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <vector>

#include "runtime/stage/stage.h"
#include "tests/bench/plan_fixture.h"

namespace {

using probe::bench::need;

// Set up, settled and looked at once, at the cameras' own size.
void two_tasks(benchmark::State& state) {
  const probe::plan::Plan& plan = probe::bench::suite_plan();
  const std::array tasks{plan.find_task("carrot_on_plate").value(),
                         plan.find_task("put_eggplant_in_basket").value()};
  const auto assets =
      need(probe::stage::SharedAssets::load(plan, probe::bench::asset_root(), tasks));
  std::unique_ptr<probe::stage::Stage> stage;
  const auto open = [&](std::uint32_t task) {
    stage.reset();  // as a worker does
    stage = need(probe::stage::Stage::create(plan, task, assets));
    need(stage->reset(0));
    need(stage->observe());
  };
  for (const std::uint32_t task : tasks) open(task);  // the first time builds the ray structures
  for (auto _ : state) {
    for (const std::uint32_t task : tasks) open(task);
  }
  state.counters["changes"] = benchmark::Counter(2.0 * static_cast<double>(state.iterations()),
                                                 benchmark::Counter::kIsRate);
}

// The median control step without pictures, of the actions that python_bench.py gives, too.
void step(benchmark::State& state) {
  const auto stage =
      need(probe::stage::Stage::create(probe::bench::suite_plan(), probe::bench::bench_task(),
                                       probe::bench::suite_assets(), {.pictures = false}));
  std::vector<double> microseconds;
  for (auto _ : state) {
    state.PauseTiming();
    need(stage->reset(0));
    state.ResumeTiming();
    for (int number = 0; number < 60; ++number) {
      const auto begin = std::chrono::steady_clock::now();
      need(stage->step({number % 20 < 10 ? 0.005 : -0.005, 0, 0.001, 0, 0, 0, 1}));
      microseconds.push_back(
          std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin)
              .count());
    }
  }
  const auto middle = microseconds.begin() + static_cast<std::ptrdiff_t>(microseconds.size() / 2);
  std::nth_element(microseconds.begin(), middle, microseconds.end());
  state.counters["median_us"] = *middle;
}

BENCHMARK(two_tasks)->Name("stage/two_tasks")->Unit(benchmark::kMillisecond)->MinTime(1);
BENCHMARK(step)->Name("stage/step")->Unit(benchmark::kMillisecond)->Iterations(10);

}  // namespace
