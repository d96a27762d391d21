// Things that move by themselves in an episode: where they are, what a touch does, saved states.
#include <doctest/doctest.h>

#include "runtime/plan/moves.h"
#include "runtime/stage/stage.h"
#include "tests/runtime/run/plan_of_text.h"

namespace probe::stage {
namespace {

const char* const kMoving = R"(use "suite/intact.probe"
layout middle {
  place source at (-16cm, 4cm)
  place target at (-16cm, -8cm)
  place orange at (-28cm, 16cm)
  drop 0.5m settle 0.5s
}
task standing like carrot_on_plate { layout middle }
variants of standing {
  passes { moves orange along (24cm, 0cm) at 4cm/s }
  leaves { moves orange along (4cm, 0cm) at 4cm/s once }
  comes  { moves source around (0cm, -2cm) at 2cm/s }
}
suite mine { tasks { standing } | variants of { standing }; seeds 42 }
)";

const plan::Plan& moving() {
  static const plan::Plan plan = run::plan_of_text(kMoving);
  return plan;
}

std::unique_ptr<Stage> stage_of(const std::string& task) {
  const auto index = moving().find_task(task);
  REQUIRE_MESSAGE(index, task);
  const std::uint32_t tasks[] = {*index};
  auto assets = SharedAssets::load(moving(), VLAPROBE_SOURCE_DIR "/assets", tasks);
  REQUIRE_MESSAGE(assets.ok(), to_text(assets.failure()));
  auto stage = Stage::create(moving(), *index, *assets, {.image = {320, 240}, .pictures = false});
  REQUIRE_MESSAGE(stage.ok(), to_text(stage.failure()));
  const Status begun = (*stage)->reset(0);
  REQUIRE_MESSAGE(begun.ok(), to_text(begun.failure()));
  return std::move(stage).value();
}

constexpr policy::Action kStill = {0, 0, 0, 0, 0, 0, 1};
constexpr std::size_t kCarrot = 0, kOrange = 2;

void steps(Stage& stage, int count) {
  for (int i = 0; i < count; ++i) REQUIRE(stage.step(kStill).ok());
}

TEST_CASE("after each control step a thing that moves is where its way leads then") {
  const auto stage = stage_of("passes");
  const Vec3 begun = stage->objects()[kOrange].position;
  const auto legs =
      plan::moves_of(moving().tables(), moving().tasks()[*moving().find_task("passes")]);
  REQUIRE(legs.size() == 1);
  for (int step = 1; step <= 59; ++step) {
    steps(*stage, 1);
    const Vec3 way = stage->objects()[kOrange].position - begun;
    const auto [x, y] = plan::offset_at(legs[0], 0.2 * step);
    CAPTURE(step);
    CHECK(std::abs(way.x() - x) < 1e-9);
    CHECK(std::abs(way.y() - y) < 1e-9);
    CHECK(std::abs(way.z()) < 1e-9);
  }
}

TEST_CASE("at the end of its way it lies there like any other thing") {
  const auto stage = stage_of("leaves");
  const Vec3 begun = stage->objects()[kOrange].position;
  steps(*stage, 30);
  const Vec3 way = stage->objects()[kOrange].position - begun;
  CHECK(way.x() == doctest::Approx(0.04).epsilon(0.02));
  CHECK(std::abs(way.z()) < 1e-4);
}

TEST_CASE("a saved state on the way goes on bit for bit, in a stage that was never reset, too") {
  const auto stage = stage_of("comes");
  steps(*stage, 7);
  const StageState state = stage->save();
  steps(*stage, 9);
  const Sha256 there = stage->state_hash();
  const auto again = stage_of("comes");
  REQUIRE(again->restore(state).ok());
  steps(*again, 9);
  CHECK(again->state_hash() == there);
  const std::vector<std::byte> bytes = state.to_bytes();
  const auto read = StageState::from_bytes(bytes);
  REQUIRE(read.ok());
  REQUIRE(again->restore(*read).ok());
  steps(*again, 9);
  CHECK(again->state_hash() == there);
}

TEST_CASE("what moves by itself has not moved to the rules that ask, until somebody touches it") {
  const auto stage = stage_of("passes");
  const Vec3 begun = stage->objects()[kOrange].position;
  const auto wrong = stage->judge().find_metric("wrong");
  REQUIRE(wrong);
  steps(*stage, 30);
  CHECK((stage->objects()[kOrange].position - begun).norm() > 0.2);
  CHECK_FALSE(stage->judge().truth(*wrong));
  // Let go there it lies as others do; what moves it then has moved it.
  REQUIRE(stage->sample().own.size() == 1);
  const vm::OwnPlace& own = stage->sample().own[0];
  CHECK(own.body == kOrange);
  CHECK(own.position == stage->sample().bodies[kOrange].position);
  auto sample = stage->sample();
  const auto index = *moving().find_task("passes");
  const auto judged = [&] {
    vm::Judge judge(moving(), index);
    REQUIRE(judge.begin(stage->body_starts()).ok());
    const Status so = judge.step(sample);
    REQUIRE_MESSAGE(so.ok(), to_text(so.failure()));
    return judge.truth(*judge.find_metric("wrong"));
  };
  CHECK_FALSE(judged());
  sample.bodies[kOrange].position.y() -= 0.04;
  CHECK(judged());
  sample.own.clear();
  vm::Judge judge(moving(), index);
  REQUIRE(judge.begin(stage->body_starts()).ok());
  const Status refused = judge.step(sample);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().message == "a step does not say where its own motion has body 2");
}

TEST_CASE("at the end of its way it is compared with that") {
  const auto stage = stage_of("leaves");
  const Vec3 begun = stage->objects()[kOrange].position;
  steps(*stage, 30);
  REQUIRE(stage->sample().own.size() == 1);
  CHECK((stage->sample().own[0].position - stage->sample().bodies[kOrange].position).norm() < 1e-4);
  CHECK((stage->objects()[kOrange].position - begun).norm() > 0.035);
  CHECK_FALSE(stage->judge().truth(*stage->judge().find_metric("wrong")));
  const StageState state = stage->save();
  const Vec3 own = stage->sample().own[0].position;
  const auto again = stage_of("leaves");
  REQUIRE(again->restore(state).ok());
  CHECK(again->sample().own[0].position == own);
}

TEST_CASE("what moves is said to move to the judge, and its start is another than of what stands") {
  const auto index = [&](const char* name) { return *moving().find_task(name); };
  const auto start = [&](const char* name) {
    return moving().episodes(moving().tasks()[index(name)])[0].start_id;
  };
  CHECK(start("passes") != start("standing"));
  CHECK(start("passes") != start("leaves"));
  const auto stage = stage_of("comes");
  steps(*stage, 3);
  CHECK(stage->sample().bodies[kCarrot].velocity.norm() == doctest::Approx(0.02).epsilon(0.01));
}

}  // namespace
}  // namespace probe::stage
