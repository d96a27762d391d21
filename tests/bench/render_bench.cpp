// Frames a second on one core: RGB, depth and segmentation of the table scene with the arm moving
// every frame, from a camera that stands and from one on the wrist.
#include <benchmark/benchmark.h>

#include "runtime/base/trig.h"
#include "runtime/stage/scene_view.h"
#include "tests/bench/plan_fixture.h"

namespace {

using probe::bench::need;

// The arm swings about its start and the carrot turns with it, so that no block of the picture is
// reused by luck.
void render(benchmark::State& state, const probe::bench::Fixture& fixture, std::size_t camera,
            int width, int height) {
  const probe::plan::Plan& plan = fixture.plan;
  const std::uint32_t task = fixture.task;
  const auto view = need(probe::stage::SceneView::create(plan, task, fixture.assets,
                                                         probe::stage::ImageSize{width, height}));
  const auto& record = plan.tasks()[task];
  const auto start = plan.joints(plan.scenes()[record.scene]);
  std::vector<double> q(start.begin(), start.end());
  std::vector<probe::Pose> objects;
  for (const auto& placement : plan.placements(plan.episodes(record)[0])) {
    const auto& p = placement.position;
    const auto& r = placement.rotation;
    objects.push_back({probe::Vec3(p[0], p[1], plan.scenes()[record.scene].surface_z + 0.019),
                       probe::Quat(r[0], r[1], r[2], r[3])});
  }
  double phase = 0;
  for (auto _ : state) {
    phase += 0.05;
    const double swing = probe::portable_sin(phase);
    q[0] = start[0] + 0.3 * swing;
    q[1] = start[1] + 0.2 * swing;
    q[5] = start[5] + swing;
    const auto frame = view->render(q, objects, camera);
    if (!frame.ok()) state.SkipWithError(frame.failure().message.c_str());
  }
  state.counters["rate"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
void from_afar(benchmark::State& state, int width, int height) {
  render(state, probe::bench::one_camera(), 0, width, height);
}
// The camera moves with the arm: nothing of the picture before is of use.
void wrist(benchmark::State& state) { render(state, probe::bench::two_cameras(), 1, 224, 224); }

BENCHMARK_CAPTURE(from_afar, bench, 640, 480)
    ->Name("render/640x480")
    ->Unit(benchmark::kMillisecond)
    ->MinTime(1);
BENCHMARK_CAPTURE(from_afar, small, 224, 224)
    ->Name("render/224x224")
    ->Unit(benchmark::kMillisecond)
    ->MinTime(1);
BENCHMARK(wrist)->Name("render/wrist_224x224")->Unit(benchmark::kMillisecond)->MinTime(1);

}  // namespace
