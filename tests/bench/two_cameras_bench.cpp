// Control steps a second with two pictures of 256 x 256 each, and what physics and each picture
// take of a step: the tasks of suite/kitchen.probe, the same under lamps that light vertices, and
// LIBERO's, where VLAPROBE_LIBERO names the folder of an import.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>

#include "runtime/stage/stage.h"
#include "tests/bench/plan_fixture.h"

namespace {

using probe::bench::Fixture;
using probe::bench::need;

constexpr int kSteps = 40;

// Over the table and down a little, with the hand closing: what moves is the arm.
probe::policy::Action reach(int step) {
  const double way = step / 10 % 2 == 0 ? 0.4 : -0.4;
  return {0.3, way, -0.15, 0, 0, 0.1, step < 20 ? -1.0 : 1.0};
}

// Of this thread alone: other programs may have the core in between.
double cpu_seconds_of(const auto& work) {
  const auto now = [] {
    timespec at{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &at);
    return static_cast<double>(at.tv_sec) + 1e-9 * static_cast<double>(at.tv_nsec);
  };
  const double begin = now();
  work();
  return now() - begin;
}

void run(benchmark::State& state, const Fixture& f) {
  auto stage = need(probe::stage::Stage::create(f.plan, f.task, f.assets));
  need(stage->reset(0));
  const auto begun = stage->save();
  double physics = 0, pictures = 0;
  for (auto _ : state) {
    state.PauseTiming();
    need(stage->restore(begun));
    need(stage->observe());
    state.ResumeTiming();
    for (int step = 0; step < kSteps; ++step) {
      physics += cpu_seconds_of([&] { need(stage->step(reach(step))); });
      pictures += cpu_seconds_of([&] { need(stage->observe()); });
    }
  }
  const double steps = kSteps * static_cast<double>(state.iterations());
  state.counters["steps_per_s"] = benchmark::Counter(steps, benchmark::Counter::kIsRate);
  state.counters["step_ms"] = 1000 * physics / steps;
  state.counters["pictures_ms"] = 1000 * pictures / steps;
}

void register_task(const std::string& name, const std::string& file, const std::string& task,
                   const std::string& assets) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 run(state, probe::bench::make_fixture(file, "", task, assets));
                               })
      ->Unit(benchmark::kMillisecond)
      ->MinTime(1);
}

[[maybe_unused]] const bool kTasks = [] {
  const std::string own = VLAPROBE_SOURCE_DIR;
  register_task("two_cameras/kitchen", own + "/suite/kitchen.probe", "bowl_on_the_plate", "");
  register_task("two_cameras/lamplit", own + "/tests/bench/vertex.probe", "lamplit_bowl", "");
  const char* imported = std::getenv("VLAPROBE_LIBERO");
  if (imported == nullptr) return true;
  const std::string folder = imported;
  const std::pair<const char*, const char*> tasks[] = {
      {"goal", "put_the_bowl_on_the_plate"},
      {"object", "pick_up_the_alphabet_soup_and_place_it_in_the_basket"},
      {"10", "kitchen_scene4_put_the_black_bowl_in_the_bottom_drawer_of_the_cabinet_and_close_it"}};
  for (const auto& [suite, task] : tasks)
    register_task(std::string("two_cameras/libero_") + suite,
                  folder + "/libero_" + suite + ".probe", task, folder);
  return true;
}();

}  // namespace
