// Observations a second of the whole loop at 640 x 480, also with a wrist camera of 224 x 224
// beside it: settle, render, act, 100 substeps, judge, hash, trace, store.
#include <benchmark/benchmark.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/run/run.h"
#include "runtime/servers/protocol.h"
#include "tests/bench/plan_fixture.h"
#include "tests/bench/slow_server.h"

namespace {

using probe::bench::need;
namespace fs = std::filesystem;

void run_all(benchmark::State& state, const probe::bench::Fixture& fixture,
             const std::string& policy, int jobs, const std::vector<int>& seeds = {42}) {
  const probe::plan::Plan& plan = fixture.plan;
  const auto& task = plan.tasks()[fixture.task];
  const fs::path dir = fs::temp_directory_path() / "vlaprobe-bench";
  const int episodes = 24 * static_cast<int>(seeds.size());
  probe::store::RunCall call;
  for (auto _ : state) {
    state.PauseTiming();
    fs::remove_all(dir);
    state.ResumeTiming();
    probe::run::RunOptions options;
    options.policy = policy;
    options.out = dir.string();
    options.suite = fixture.suite;
    options.jobs = jobs;
    options.assets = probe::bench::asset_root();
    options.tasks = std::string(plan.text(task.name));
    options.seeds = {seeds.begin(), seeds.end()};
    const auto summary = need(probe::run::run(plan, options));
    call = summary.call;
    if (summary.done != episodes || summary.invalid != 0)
      state.SkipWithError("an episode was not valid");
  }
  fs::remove_all(dir);
  const double steps = task.horizon;
  state.counters["rate"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * episodes * steps, benchmark::Counter::kIsRate);
  if (call.queries.queries == 0) return;
  state.counters["server_busy_percent"] = 100 * call.queries.busy_s / call.elapsed_s;
  state.counters["worlds_waiting_percent"] =
      100 * call.queries.waiting_s / (call.elapsed_s * call.worlds);
}

void loop(benchmark::State& state, const std::string& policy, int jobs) {
  run_all(state, probe::bench::one_camera(), policy, jobs);
}
void two_cameras(benchmark::State& state) {
  run_all(state, probe::bench::two_cameras(), "expert", 1);
}

// Over a real connection, pictures and all; `milliseconds` is the server's time an answer, which
// has four actions (vla-eval's one).
void served(benchmark::State& state, probe::servers::Protocol protocol, int milliseconds,
            int jobs) {
  const probe::bench::SlowServer server(protocol, std::chrono::milliseconds(milliseconds));
  loop(state, server.policy(), jobs);
}

// How busy eight worlds keep a server of 100 ms an answer, in each protocol: 96 episodes, as what
// is lost where all begin, end their first episodes and end together is lost once.
[[maybe_unused]] const bool kSlowServers = [] {
  for (const probe::servers::Protocol protocol : probe::servers::all_protocols()) {
    const std::string name = "loop/slow_server/" + std::string(probe::servers::to_word(protocol));
    benchmark::RegisterBenchmark(
        name.c_str(),
        [protocol](benchmark::State& state) {
          const probe::bench::SlowServer server(protocol, std::chrono::milliseconds(100));
          run_all(state, probe::bench::one_camera(), server.policy(), 8, {42, 43, 44, 45});
        })
        ->UseRealTime()
        ->Unit(benchmark::kSecond);
  }
  return true;
}();

BENCHMARK_CAPTURE(loop, one, "expert", 1)
    ->Name("loop/one_core")
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(loop, two, "expert", 2)
    ->Name("loop/two_cores")
    ->UseRealTime()
    ->Unit(benchmark::kSecond);
BENCHMARK(two_cameras)->Name("loop/one_core_two_cameras")->UseRealTime()->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(served, instant, probe::servers::Protocol::kOpenpi, 0, 2)
    ->Name("loop/served")
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

}  // namespace
