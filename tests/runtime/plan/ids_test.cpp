#include "runtime/plan/ids.h"

#include <doctest/doctest.h>

#include <functional>

#include "runtime/plan/plan.h"
#include "tests/runtime/plan/small_plan.h"

using namespace probe;
using namespace probe::plan;

namespace {

struct Ids {
  std::array<std::uint8_t, 32> start{}, judge{}, episode{};
};

Ids ids_after(const std::function<void(Writer&)>& change) {
  Writer w = small_writer();
  change(w);
  const auto bytes = w.finish();
  REQUIRE_MESSAGE(bytes.ok(), to_text(bytes.failure()));
  return {w.records.episodes[0].start_id, w.records.tasks[0].judge_id,
          w.records.episodes[0].episode_id};
}

}  // namespace

TEST_CASE("a task that differs in language alone shares starts and judge, not episodes") {
  Writer w = small_writer();
  REQUIRE(w.finish().ok());
  const Records& r = w.records;
  CHECK(r.tasks[0].judge_id == r.tasks[1].judge_id);
  CHECK(r.episodes[0].start_id == r.episodes[2].start_id);
  CHECK(r.episodes[0].start_id != r.episodes[1].start_id);
  CHECK(r.episodes[0].episode_id != r.episodes[2].episode_id);
}

TEST_CASE("names, reach and sources are in no id") {
  const Ids base = ids_after([](Writer&) {});
  const auto same = [&](const std::function<void(Writer&)>& change) {
    const Ids ids = ids_after(change);
    return ids.start == base.start && ids.judge == base.judge && ids.episode == base.episode;
  };
  CHECK(same([](Writer& w) { w.records.tasks[0].name = w.text("other"); }));
  CHECK(same([](Writer& w) { w.records.objects[0].name = w.text("parsnip"); }));
  CHECK(same([](Writer& w) { w.records.scenes[0].name = w.text("desk"); }));
  CHECK(same([](Writer& w) { w.records.assets[0].path = w.text("moved/elsewhere.glb"); }));
  CHECK(same([](Writer& w) { w.records.robots[0].reach_max = 0.7; }));
  CHECK(same([](Writer& w) { w.records.spans.clear(); }));
}

TEST_CASE("steps of standing still are part of the start, with the law and rate of the robot") {
  const Ids base = ids_after([](Writer&) {});
  const auto idle = [](std::uint32_t steps, double hz) {
    return ids_after([&](Writer& w) {
      w.records.tasks[0].idle = steps;
      w.records.robots[0].control_hz = hz;
    });
  };
  CHECK(idle(0, 10).start == base.start);
  CHECK(idle(10, 5).start != base.start);
  CHECK(idle(10, 5).start != idle(11, 5).start);
  CHECK(idle(10, 5).start != idle(10, 10).start);
  CHECK(idle(10, 5).judge == base.judge);
}

TEST_CASE("what ends an episode is judged: it is part of the judge's id") {
  const Ids base = ids_after([](Writer&) {});
  const Ids ends = ids_after(
      [](Writer& w) { w.records.metrics[2].readout = static_cast<std::uint32_t>(Readout::kEnds); });
  CHECK(ends.judge != base.judge);
  CHECK(ends.start == base.start);
}

TEST_CASE("among several cameras names count; alone the camera does") {
  const Ids base = ids_after([](Writer&) {});
  const auto seen = [](const char* first, const char* second, bool photo) {
    return ids_after([&](Writer& w) {
      Records& r = w.records;
      r.views.push_back({w.text(first), 0, r.scenes[0].photo});
      r.views.push_back({w.text(second), 0, photo ? r.scenes[0].photo : kNone});
      for (TaskRecord& task : r.tasks) task.views = {0, 2};
    });
  };
  const Ids two = seen("outside", "wrist", false);
  CHECK(two.start != base.start);
  CHECK(two.judge == base.judge);
  CHECK(two.start == seen("outside", "wrist", false).start);
  CHECK(two.start != seen("wrist", "outside", false).start);
  CHECK(two.start != seen("outside", "wrist", true).start);
  CHECK(base.start ==
        ids_after([](Writer& w) { w.records.cameras[0].name = w.text("eye"); }).start);
}

TEST_CASE("whatever is physical or visible is in the start") {
  const Ids base = ids_after([](Writer&) {});
  const std::vector<std::function<void(Writer&)>> changes = {
      [](Writer& w) { w.records.assets[0].sha256[3] ^= 1; },  // a mesh
      [](Writer& w) { w.records.assets[1].sha256[3] ^= 1; },
      [](Writer& w) { w.records.assets[w.records.robots[0].urdf].sha256[0] ^= 1; },
      [](Writer& w) { w.records.assets[w.records.scenes[0].photo].sha256[0] ^= 1; },
      [](Writer& w) {
        w.records.assets[w.records.list[w.records.robots[0].meshes.first]].sha256[0] ^= 1;
      },
      [](Writer& w) { w.records.objects[0].density = 701; },
      [](Writer& w) { w.records.objects[1].friction = 0.6; },
      [](Writer& w) { w.records.objects[1].box_max[2] = 0.2; },
      [](Writer& w) { w.records.placements[0].position[1] = 0.11; },
      [](Writer& w) {
        w.records.placements[1].rotation = {0, 0, 0, 1};
      },
      [](Writer& w) { w.records.drives[0].stiffness = 1001; },
      [](Writer& w) { w.records.robots[0].finger_friction = 2; },
      [](Writer& w) { w.records.robots[0].tcp = w.text("another_link"); },
      [](Writer& w) { w.records.reals[0] = 0.2; },
      [](Writer& w) { w.records.scenes[0].base_position[0] = 0.1; },
      [](Writer& w) { w.records.scenes[0].surface_z = 0.88; },
      [](Writer& w) { w.records.scenes[0].physics_hz = 1000; },
      [](Writer& w) { w.records.cameras[0].fx = 601; },
      [](Writer& w) { w.records.suns[0].power = 1; },
      [](Writer& w) { w.records.lights[0].ambient = 0.2; },
      [](Writer& w) { w.records.tasks[0].drop = 0.4; },
      [](Writer& w) { w.records.tasks[0].settle = 0.4; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    CAPTURE(i);
    const Ids ids = ids_after(changes[i]);
    CHECK(ids.start != base.start);
    CHECK(ids.judge == base.judge);
    CHECK(ids.episode != base.episode);
  }
}

TEST_CASE("program, horizon and control are in the judge id") {
  const Ids base = ids_after([](Writer&) {});
  const std::vector<std::function<void(Writer&)>> changes = {
      [](Writer& w) { w.records.constants[0] = 0.06; },
      [](Writer& w) { w.records.states[1].n = 6; },
      [](Writer& w) { w.records.code[5].op = static_cast<std::uint8_t>(Op::kLE); },
      [](Writer& w) { w.records.metrics[0].name = w.text("close"); },
      [](Writer& w) { w.records.tasks[0].horizon = 61; },
      [](Writer& w) { w.records.robots[0].control_hz = 10; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    CAPTURE(i);
    const Ids ids = ids_after(changes[i]);
    CHECK(ids.judge != base.judge);
    CHECK(ids.start == base.start);
    CHECK(ids.episode != base.episode);
  }
}
