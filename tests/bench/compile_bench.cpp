// Suites a second: diagnosing the INT-ACT suite's text, and building its plan, with reading of
// files and assets.
#include <benchmark/benchmark.h>

#include "compiler/emit/compile.h"
#include "tests/bench/need.h"

namespace {

using probe::bench::need;

void finish(benchmark::State& state) {
  state.counters["rate"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void check_suite(benchmark::State& state) {
  const std::string files[] = {probe::bench::suite_path()};
  for (auto _ : state) {
    if (!need(probe::check(files, {.asset_root = probe::bench::asset_root(), .suite = ""})).ok) {
      state.SkipWithError("the suite has errors");
    }
  }
  finish(state);
}
BENCHMARK(check_suite)->Name("check/suite")->Unit(benchmark::kMillisecond);

// Phrases of place, proved in every start of thousands of derived tasks.
void check_spatial(benchmark::State& state) {
  const std::string files[] = {VLAPROBE_SOURCE_DIR "/tests/bench/spatial.probe"};
  for (auto _ : state) {
    const auto checked =
        need(probe::check(files, {.asset_root = probe::bench::asset_root(),
                                  .suite = "",
                                  .library_folders = {VLAPROBE_SOURCE_DIR "/dsl"}}));
    if (!checked.ok) state.SkipWithError("the text has errors");
  }
  finish(state);
}
BENCHMARK(check_spatial)->Name("check/spatial_5000")->Unit(benchmark::kMillisecond);

void build_suite(benchmark::State& state) {
  const std::string files[] = {probe::bench::suite_path()};
  for (auto _ : state) {
    if (need(probe::build(files, {.asset_root = probe::bench::asset_root(), .suite = ""}))
            .plan.empty()) {
      state.SkipWithError("the suite has errors");
    }
  }
  finish(state);
}
BENCHMARK(build_suite)->Name("build/suite")->Unit(benchmark::kMillisecond);

}  // namespace
