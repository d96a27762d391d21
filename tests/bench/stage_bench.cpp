// What a change of task costs: one worker that plays two tasks of different scenes in turns.
#include <benchmark/benchmark.h>

#include <array>
#include <memory>

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

BENCHMARK(two_tasks)->Name("stage/two_tasks")->Unit(benchmark::kMillisecond)->MinTime(1);

}  // namespace
