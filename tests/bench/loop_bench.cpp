// Observations a second of the whole loop at 640 x 480: settle, render, act, 100 substeps, judge,
// hash, trace, store.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "runtime/run/run.h"
#include "tests/bench/plan_fixture.h"

namespace {

using probe::bench::need;
namespace fs = std::filesystem;

void loop(benchmark::State& state, const char* policy, int jobs) {
  const probe::plan::Plan& plan = probe::bench::suite_plan();
  const fs::path dir = fs::temp_directory_path() / "vlaprobe-bench";
  const int episodes = 24;
  for (auto _ : state) {
    state.PauseTiming();
    fs::remove_all(dir);
    state.ResumeTiming();
    probe::run::RunOptions options;
    options.policy = policy;
    options.out = dir.string();
    options.suite = "intact";
    options.jobs = jobs;
    options.assets = probe::bench::asset_root();
    const auto summary = need(probe::run::run(plan, options));
    if (summary.done != episodes || summary.invalid != 0)
      state.SkipWithError("an episode was not valid");
  }
  fs::remove_all(dir);
  const double steps = plan.tasks()[probe::bench::bench_task()].horizon;
  state.counters["rate"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * episodes * steps, benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(loop, one, "expert", 1)
    ->Name("loop/one_core")
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(loop, two, "expert", 2)
    ->Name("loop/two_cores")
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

}  // namespace
