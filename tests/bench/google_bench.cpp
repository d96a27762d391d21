// The Google robot's control step: 171 substeps of 1/513 s and a picture of 640 x 512, of an arm
// that moves and of one that carries the can. Read beside loop/one_core, kitchen/pictures and
// stage/step of the same call.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "runtime/expert/expert.h"
#include "runtime/stage/stage.h"
#include "tests/bench/plan_fixture.h"

namespace {

using probe::bench::need;

constexpr int kSteps = 20;         // control steps between restores
constexpr int kUntilCarried = 45;  // control steps until the expert carries the can

const probe::bench::Fixture& fixture() {
  static const probe::bench::Fixture made = probe::bench::make_fixture(
      VLAPROBE_SOURCE_DIR "/suite/google.probe", "google", "pick_standing");
  return made;
}

std::unique_ptr<probe::stage::Stage> begun(bool pictures) {
  auto stage = need(probe::stage::Stage::create(fixture().plan, fixture().task, fixture().assets,
                                                {.pictures = pictures}));
  need(stage->reset(12));
  return stage;
}

void count(benchmark::State& state) {
  state.counters["steps_per_s"] = benchmark::Counter(
      kSteps * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

// To and fro, as a policy that answers at once would ask for it.
void moving(benchmark::State& state, bool pictures) {
  const auto stage = begun(pictures);
  const auto start = stage->save();
  for (auto _ : state) {
    state.PauseTiming();
    need(stage->restore(start));
    state.ResumeTiming();
    for (int step = 0; step < kSteps; ++step) {
      if (pictures) need(stage->observe());
      const double way = step / 5 % 2 == 0 ? 0.05 : -0.05;
      need(stage->step({0, way, 0, 0, 0, 0.1, step % 10 < 5 ? -0.5 : 0.5}));
    }
  }
  count(state);
}

// What the expert does from where it has the can in its hand.
void carrying(benchmark::State& state, bool pictures) {
  const auto stage = begun(pictures);
  const auto expert = need(probe::expert::make_expert({}));
  need(expert->begin(stage->introduction()));
  std::vector<probe::policy::Action> actions;
  const auto act = [&] {
    actions.push_back(need(expert->act(need(stage->observe()))));
    need(stage->step(actions.back()));
  };
  for (int step = 0; step < kUntilCarried; ++step) act();
  const auto start = stage->save();
  actions.clear();
  for (int step = 0; step < kSteps; ++step) act();
  for (auto _ : state) {
    state.PauseTiming();
    need(stage->restore(start));
    state.ResumeTiming();
    for (const probe::policy::Action& action : actions) {
      if (pictures) need(stage->observe());
      need(stage->step(action));
    }
  }
  count(state);
}

BENCHMARK_CAPTURE(moving, with_pictures, true)
    ->Name("google/moving")
    ->Unit(benchmark::kMillisecond)
    ->MinTime(1);
BENCHMARK_CAPTURE(moving, without, false)
    ->Name("google/moving_without_pictures")
    ->Unit(benchmark::kMillisecond)
    ->MinTime(1);
BENCHMARK_CAPTURE(carrying, with_pictures, true)
    ->Name("google/carrying")
    ->Unit(benchmark::kMillisecond)
    ->MinTime(1);

}  // namespace
