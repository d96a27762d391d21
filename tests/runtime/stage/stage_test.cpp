// A stage goes through an episode, and any moment of it can be kept and returned to.
#include "runtime/stage/stage.h"

#include <doctest/doctest.h>

#include <memory>
#include <string>
#include <vector>

#include "runtime/expert/expert.h"
#include "tests/parity/published.h"

namespace probe::stage {
namespace {

std::unique_ptr<Stage> open_stage(const std::string& name, const StageOptions& options = {}) {
  const plan::Plan& plan = test::suite_plan();
  const std::uint32_t task = plan.find_task(name).value();
  const std::uint32_t tasks[] = {task};
  auto assets = SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks);
  REQUIRE_MESSAGE(assets.ok(), (assets.ok() ? "" : to_text(assets.failure())));
  auto stage = Stage::create(plan, task, *assets, options);
  REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : to_text(stage.failure())));
  return std::move(*stage);
}

void need(const Status& status) {
  REQUIRE_MESSAGE(status.ok(), (status.ok() ? "" : to_text(status.failure())));
}

// What a trace holds of a moment: measurements, joints, verdicts, the world, the picture.
std::string moment(Stage& stage) {
  Hasher hash;
  const auto all = [&](const Vec3& v) { hash.f64s(std::span(v.data(), 3)); };
  const vm::StepSample& sample = stage.sample();
  for (const vm::BodySample& body : sample.bodies) {
    all(body.position), all(body.origin), all(body.velocity), all(body.spin);
    hash.f64s(std::span(body.rotation.coeffs().data(), 4));
  }
  for (const vm::ContactSample& contact : sample.contacts) {
    hash.u32(contact.a).u32(contact.b);
    all(contact.push);
  }
  all(sample.tcp);
  const double clock[] = {sample.grip, sample.step, sample.time};
  hash.f64s(clock).f64s(stage.q()).f64s(stage.u()).f64s(stage.judge().values());
  hash.hash(stage.state_hash());
  const auto seen = stage.observe();
  REQUIRE(seen.ok());
  hash.bytes(std::as_bytes(seen->image.rgb));
  for (const auto& object : seen->privileged->objects) {
    hash.u32(object.finger_contact[0]).u32(object.finger_contact[1]);
  }
  return to_hex(hash.finish());
}

// The expert's episode: the moment before each action, the actions, and the last moment.
struct Played {
  std::vector<std::string> moments;
  std::vector<policy::Action> actions;
};

Played play(Stage& stage, std::uint32_t start, int steps) {
  const auto expert = expert::make_expert({});
  REQUIRE(expert.ok());
  need(stage.reset(start));
  need((*expert)->begin(stage.introduction()));
  Played played;
  for (int step = 0; step < steps; ++step) {
    played.moments.push_back(moment(stage));
    const auto seen = stage.observe();
    REQUIRE(seen.ok());
    CHECK(seen->step == step);
    const auto action = (*expert)->act(*seen);
    REQUIRE(action.ok());
    played.actions.push_back(*action);
    need(stage.step(*action));
  }
  played.moments.push_back(moment(stage));
  return played;
}

constexpr StageOptions kSmall{.image = {80, 60}};

TEST_CASE("an episode saved at any step goes on bit for bit, in the same stage and in another") {
  const auto stage = open_stage("carrot_on_plate", kSmall);
  const int horizon = 60;
  const Played played = play(*stage, 3, horizon);
  CHECK(stage->judge().truth(stage->judge().find_metric("success").value()));

  const auto again = open_stage("carrot_on_plate", kSmall);
  const auto blind = open_stage("carrot_on_plate", {.pictures = false});
  need(again->reset(3));
  bool touched = false;
  for (int at = 0; at < horizon; ++at) {
    // Before the arm moves, with the carrot between the fingers, in the air and let go.
    if (at % 12 == 0) {
      const StageState saved = again->save();
      need(blind->restore(saved));
      CHECK(blind->state_hash() == again->state_hash());
      for (int step = at; step < horizon; ++step) {
        REQUIRE(moment(*again) == played.moments[static_cast<std::size_t>(step)]);
        need(again->step(played.actions[static_cast<std::size_t>(step)]));
        need(blind->step(played.actions[static_cast<std::size_t>(step)]));
        touched = touched || again->privileged().objects[0].finger_contact[0];
      }
      CHECK(moment(*again) == played.moments.back());
      CHECK(blind->state_hash() == again->state_hash());
      CHECK(std::ranges::equal(blind->judge().values(), again->judge().values()));
      need(again->restore(saved));
      CHECK(again->steps() == at);
    }
    need(again->step(played.actions[static_cast<std::size_t>(at)]));
  }
  CHECK(touched);
}

TEST_CASE("a stage without pictures has none and steps as one with them") {
  const auto blind = open_stage("carrot_on_plate", {.pictures = false});
  const auto seeing = open_stage("carrot_on_plate", kSmall);
  need(blind->reset(0));
  need(seeing->reset(0));
  const auto seen = blind->observe();
  REQUIRE(seen.ok());
  CHECK(seen->image.rgb.empty());
  CHECK(seen->cameras.empty());
  CHECK(blind->frames().empty());
  CHECK(seen->prompt == "put carrot on plate");
  CHECK(seeing->observe().ok());
  REQUIRE(seeing->frames().size() == 1);
  CHECK(seeing->frames()[0].frame.width == 80);
  need(blind->step({0.01, 0, -0.01, 0, 0, 0.05, -1}));
  need(seeing->step({0.01, 0, -0.01, 0, 0, 0.05, -1}));
  CHECK(blind->state_hash() == seeing->state_hash());
}

TEST_CASE("the state of another task is refused, and the stage can be reset") {
  const auto carrot = open_stage("carrot_on_plate", {.pictures = false});
  const auto stack = open_stage("carrot_on_plate_distract", {.pictures = false});
  need(carrot->reset(0));
  need(stack->reset(0));
  const Status refused = stack->restore(carrot->save());
  REQUIRE(!refused.ok());
  CHECK(refused.failure().code == Fault::kWorld);
  need(stack->reset(0));
  StageState damaged = stack->save();
  damaged.world.physics.resize(damaged.world.physics.size() / 2);
  CHECK(!stack->restore(damaged).ok());
  need(stack->reset(1));
  CHECK(stack->steps() == 0);
}

TEST_CASE("an action that is none is refused before anything moves") {
  const auto stage = open_stage("carrot_on_plate", {.pictures = false});
  need(stage->reset(0));
  const Sha256 before = stage->state_hash();
  const Status refused = stage->step({0, 0, 5000, 0, 0, 0, 1});
  REQUIRE(!refused.ok());
  CHECK(refused.failure().code == Fault::kPolicy);
  CHECK(refused.failure().message == "action[2] is 5000, wanted a shift in metres");
  CHECK(stage->state_hash() == before);
}

}  // namespace
}  // namespace probe::stage
