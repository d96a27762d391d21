// Control steps a second that the judge reads with the suite's metrics.
#include <benchmark/benchmark.h>

#include "runtime/vm/judge.h"
#include "tests/bench/plan_fixture.h"

namespace {

using namespace probe;

// A carrot above the plate, held by both fingers: most conditions are looked at and none is
// trivial.
vm::StepSample sample_of(std::size_t bodies) {
  vm::StepSample sample;
  sample.bodies.resize(bodies);
  for (std::size_t i = 0; i < bodies; ++i) {
    const double x = 0.01 * static_cast<double>(i);
    sample.bodies[i].position = sample.bodies[i].origin = {x, -x, 0.9 + x};
  }
  const auto first_finger = static_cast<std::uint16_t>(3);
  sample.contacts = {{0, first_finger, {0, 0.03, 0}}, {0, 4, {0, -0.03, 0}}, {1, 2, {0, 0, -0.01}}};
  sample.tcp = {0, 0, 0.93};
  sample.grip = 0.6;
  sample.step = 1;
  sample.time = 0.2;
  return sample;
}

void judge_step(benchmark::State& state) {
  const plan::Plan& plan = bench::suite_plan();
  vm::Judge judge(plan, bench::bench_task());
  const std::size_t bodies = plan.bodies(plan.tasks()[bench::bench_task()]).size();
  std::vector<vm::BodyStart> starts(bodies);
  for (vm::BodyStart& start : starts) start.half = {0.05, 0.02, 0.02}, start.opening = {0, 1, 0};
  bench::need(judge.begin(starts));
  const vm::StepSample sample = sample_of(bodies);
  for (auto _ : state) {
    bench::need(judge.step(sample));
    benchmark::DoNotOptimize(judge.value(0));
  }
  state.counters["rate"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(judge_step)->Name("judge/step")->Unit(benchmark::kMicrosecond);

}  // namespace
