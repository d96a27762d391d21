// A scene of fixtures with joints: a cabinet with three drawers, a stove, a microwave, five objects
// and the arm. `physics`: simulated seconds per CPU second while a drawer slides out and the arm
// swings, beside the same without fixtures. `pictures`: control steps a second with two pictures of
// 256 x 256 each.
#include <benchmark/benchmark.h>

#include <memory>

#include "runtime/stage/stage.h"
#include "tests/bench/plan_fixture.h"

namespace {

using probe::bench::Fixture;
using probe::bench::need;

constexpr int kSteps = 40;  // control steps of 0.2 s: the drawer is on its way all the time

const Fixture& fixture(bool with_fixtures) {
  static const std::string file = VLAPROBE_SOURCE_DIR "/tests/bench/kitchen.probe";
  static const Fixture furnished = probe::bench::make_fixture(file, "", "pulled");
  static const Fixture bare = probe::bench::make_fixture(file, "", "bare");
  return with_fixtures ? furnished : bare;
}

// To and fro above the objects.
probe::policy::Action swing(int step) {
  const double way = step / 5 % 2 == 0 ? 0.01 : -0.01;
  return {0, way, 0, 0, 0, 0, 1};
}

void run(benchmark::State& state, bool with_fixtures, bool pictures) {
  const Fixture& f = fixture(with_fixtures);
  auto stage = need(probe::stage::Stage::create(f.plan, f.task, f.assets, {.pictures = pictures}));
  need(stage->reset(0));
  const auto begun = stage->save();
  for (auto _ : state) {
    state.PauseTiming();
    need(stage->restore(begun));
    state.ResumeTiming();
    for (int step = 0; step < kSteps; ++step) {
      need(stage->step(swing(step)));
      if (pictures) need(stage->observe());
    }
  }
  const double steps = kSteps * static_cast<double>(state.iterations());
  const double control_hz = 5;
  state.counters["sim_s_per_s"] =
      benchmark::Counter(steps / control_hz, benchmark::Counter::kIsRate);
  state.counters["steps_per_s"] = benchmark::Counter(steps, benchmark::Counter::kIsRate);
  if (with_fixtures) state.counters["drawer_cm"] = 100 * stage->sample().joints[8].position;
}

void physics(benchmark::State& state) { run(state, true, false); }
void physics_without(benchmark::State& state) { run(state, false, false); }
void pictures(benchmark::State& state) { run(state, true, true); }

BENCHMARK(physics)->Name("kitchen/physics")->Unit(benchmark::kMillisecond)->MinTime(1);
BENCHMARK(physics_without)
    ->Name("kitchen/physics_without_fixtures")
    ->Unit(benchmark::kMillisecond)
    ->MinTime(1);
BENCHMARK(pictures)->Name("kitchen/pictures")->Unit(benchmark::kMillisecond)->MinTime(1);

}  // namespace
