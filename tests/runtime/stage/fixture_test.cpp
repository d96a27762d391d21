// Fixtures with joints in a stage: they are touched by name, seen, shown to policies that see
// everything, and stay where settling left them.
#include "runtime/stage/fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/runtime/stage/cabinet.h"

namespace probe::stage {
namespace {

using test::open_with_cabinet;

void need(const Status& status) {
  REQUIRE_MESSAGE(status.ok(), (status.ok() ? "" : to_text(status.failure())));
}

std::uint16_t body(const Stage& stage, const std::string& name) {
  const auto& names = stage.body_names();
  const auto found = std::find(names.begin(), names.end(), name);
  REQUIRE_MESSAGE(found != names.end(), name);
  return static_cast<std::uint16_t>(found - names.begin());
}

bool touch(const Stage& stage, const std::string& one, const std::string& other) {
  const std::uint16_t a = body(stage, one), b = body(stage, other);
  return std::ranges::any_of(stage.sample().contacts, [&](const vm::ContactSample& contact) {
    return contact.a == std::min(a, b) && contact.b == std::max(a, b);
  });
}

constexpr policy::Action kStay{0, 0, 0, 0, 0, 0, 1};
constexpr StageOptions kBlind{.pictures = false};

TEST_CASE("what lies on a drawer touches it by its name") {
  const auto stage = open_with_cabinet(kBlind);
  need(stage->reset(0));
  need(stage->step(kStay));
  CHECK(touch(*stage, "carrot", "cabinet.tray"));
  CHECK(!touch(*stage, "carrot", "surface"));
  CHECK(!touch(*stage, "carrot", "cabinet.post"));
  // It lies 2 cm and half a tray above the table.
  CHECK(stage->sample().bodies[0].origin.z() > 0.87 + 0.035);
}

TEST_CASE("bodies and joints of fixtures follow those of the plan and the robot") {
  const plan::Plan& plan = test::suite_plan();
  const auto stage = open_with_cabinet(kBlind);
  need(stage->reset(0));
  const auto bodies = plan.bodies(plan.tasks()[stage->task()]);
  REQUIRE(stage->body_names().size() == bodies.size() + 3);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    CHECK(stage->body_names()[i] == plan.text(bodies[i].name));
  }
  const std::vector<std::string> last(stage->body_names().end() - 3, stage->body_names().end());
  CHECK(last == std::vector<std::string>{"cabinet.post", "cabinet.tray", "cabinet.button"});
  const auto joints = stage->joint_names();
  REQUIRE(joints.size() == 10);
  CHECK(joints[0] == "waist");
  CHECK(joints[8] == "cabinet.slide");
  CHECK(joints[9] == "cabinet.press");
  CHECK(stage->q().size() == 10);
  CHECK(stage->sample().joints.size() == 10);
  CHECK(stage->sample().bodies.size() == stage->body_names().size());
  CHECK(stage->body_starts().size() == stage->body_names().size());
  // A policy has the robot's joints alone.
  const auto seen = stage->observe();
  REQUIRE(seen.ok());
  CHECK(seen->proprioception.joints.size() == 8);
}

TEST_CASE("a passive joint begins where settling left it, its spring rests where it was made") {
  const auto stage = open_with_cabinet(kBlind);
  need(stage->reset(0));
  const double sunk = -test::kButtonMass * 9.81 / test::kButtonStiffness;  // m
  CHECK(stage->q()[9] == doctest::Approx(sunk).epsilon(0.01));
  const double begun = stage->q()[9];
  for (int i = 0; i < 10; ++i) need(stage->step(kStay));
  CHECK(std::abs(stage->q()[9] - begun) < 1e-4);
}

TEST_CASE("a sample says where links of fixtures are and how fast they move") {
  // Its rails lean by 30 degrees and nothing brakes the tray but its damping.
  const plan::Plan& plan = test::suite_plan();
  Fixture leaning = test::cabinet(Vec3(-0.5, 0.6, plan.scenes()[0].surface_z + 0.4), 0.0);
  leaning.base.rotation = Quat(0.9659258262890683, 0, 0.25881904510252074, 0);
  leaning.joints[0] = {.joint = "slide", .damping = 40};
  const auto stage = test::open_furnished({leaning}, kBlind);
  need(stage->reset(0));
  const double begun = stage->q()[8];
  CHECK(begun > 0.05);  // it slid while objects settled
  CHECK(begun < 0.19);
  need(stage->step(kStay));
  const vm::BodySample& tray = stage->sample().bodies[body(*stage, "cabinet.tray")];
  const vm::JointSample& slide = stage->sample().joints[8];
  const Vec3 along = leaning.base.rotation * Vec3::UnitX();
  CHECK((tray.position - (leaning.base.position + along * slide.position)).norm() < 1e-12);
  CHECK((tray.velocity - along * slide.rate).norm() < 1e-12);
  CHECK(slide.rate ==
        doctest::Approx(0.5 * 9.81 * 0.5 / 40).epsilon(0.05));  // m/s, weight = damping
  CHECK(tray.spin.norm() == 0);
}

TEST_CASE("a drawer is drawn where its joint is and segmented as its body") {
  const auto pixels_of = [](Stage& stage, const std::string& name) {
    const auto seen = stage.observe();
    REQUIRE(seen.ok());
    const std::uint16_t id = static_cast<std::uint16_t>(1 + body(stage, name));
    const auto& frame = stage.frames()[0].frame;
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < frame.segmentation.size(); ++i) {
      if (frame.segmentation[i] != id) continue;
      ++count;
      sum += double(i % std::size_t(frame.width));
    }
    return std::pair(count, count == 0 ? 0.0 : sum / double(count));
  };
  const StageOptions small{.image = {160, 120}};
  const auto stage = open_with_cabinet(small);
  need(stage->reset(0));
  const auto [count, middle] = pixels_of(*stage, "cabinet.tray");
  CHECK(count > 300);
  CHECK(pixels_of(*stage, "cabinet.button").first > 5);
  // The same rails, the tray all the way in: another place in the picture.
  const plan::Plan& plan = test::suite_plan();
  Fixture shut = test::cabinet(test::below_source(plan, stage->task()));
  shut.positions[0] = 0;
  const auto other = test::open_furnished({shut}, small);
  need(other->reset(0));
  const auto [shut_count, shut_middle] = pixels_of(*other, "cabinet.tray");
  CHECK(shut_count > 300);
  CHECK(std::abs(shut_middle - middle) > 5);
}

TEST_CASE("policies that see everything see fixtures where they are now") {
  const auto stage = open_with_cabinet(kBlind);
  need(stage->reset(0));
  const auto& fixtures = stage->privileged().fixtures;
  REQUIRE(fixtures.size() == 3);
  CHECK(fixtures[1].name == "cabinet.tray");
  REQUIRE(fixtures[1].parts.size() == 1);
  CHECK(fixtures[1].parts[0].size() == 8);
  const Vec3 tray = stage->sample().bodies[body(*stage, "cabinet.tray")].origin;
  CHECK((fixtures[1].pose.position - tray).norm() == 0);
  double lowest = 1e9;
  for (const Vec3& v : fixtures[1].parts[0]) {
    lowest = std::min(lowest, fixtures[1].pose.apply(v).z());
  }
  CHECK(lowest == doctest::Approx(0.87 + 0.005).epsilon(1e-6));
  const double button = fixtures[2].pose.position.z();
  CHECK(button == doctest::Approx(stage->sample().bodies.back().origin.z()));
}

TEST_CASE("a stage with a drawer is saved and restored bit for bit, also into a fresh one") {
  const auto stage = open_with_cabinet(kBlind);
  const auto fresh = open_with_cabinet(kBlind);
  need(stage->reset(0));
  const policy::Action down{0.01, 0, -0.02, 0, 0, 0, -1};
  for (int i = 0; i < 5; ++i) need(stage->step(down));
  const StageState saved = stage->save();
  need(fresh->restore(saved));
  for (int i = 0; i < 15; ++i) {
    need(stage->step(down));
    need(fresh->step(down));
    REQUIRE(stage->state_hash() == fresh->state_hash());
  }
  CHECK(std::ranges::equal(stage->q(), fresh->q()));
  CHECK(std::ranges::equal(stage->judge().values(), fresh->judge().values()));
}

TEST_CASE("a stage without fixtures refuses the state of one that has them") {
  const auto furnished = open_with_cabinet(kBlind);
  const auto bare = test::open_furnished({}, kBlind);
  need(furnished->reset(0));
  need(bare->reset(0));
  CHECK(!bare->restore(furnished->save()).ok());
  need(bare->reset(0));
  CHECK(!furnished->restore(bare->save()).ok());
}

TEST_CASE("fixtures that cannot be are refused by name") {
  const plan::Plan& plan = test::suite_plan();
  const std::uint32_t tasks[] = {plan.find_task(test::kCabinetTask).value()};
  const Fixture good = test::cabinet(Vec3(0, 0, 0.87));
  const auto refusal = [&](std::vector<Fixture> fixtures) {
    auto assets = SharedAssets::load(plan, VLAPROBE_SOURCE_DIR "/assets", tasks, fixtures);
    if (!assets) return to_text(assets.failure());
    auto stage = Stage::create(plan, tasks[0], *assets, kBlind);
    if (!stage) return to_text(stage.failure());
    const Status reset = (*stage)->reset(0);
    return reset ? std::string() : to_text(reset.failure());
  };
  const auto says = [](const std::string& text, const char* part) {
    CHECK_MESSAGE(text.find(part) != std::string::npos, text);
  };
  CHECK(refusal({good}).empty());
  says(refusal({good, good}), "two fixtures are called `cabinet`");
  Fixture bad = good;
  bad.urdf = "fixtures/none.urdf";
  says(refusal({bad}), "none.urdf");
  bad = good;
  bad.joints[1].joint = "lid";
  says(refusal({bad}), "lid");
  bad = good;
  bad.positions.pop_back();
  says(refusal({bad}), "fixture `cabinet`: 2 joints, initial positions of 1");
  bad = good;
  bad.positions[0] = 0.5;
  says(refusal({bad}), "beyond its limits");
  bad = good;
  bad.joints.pop_back();
  bad.positions.pop_back();
  says(refusal({bad}), "press");
}

}  // namespace
}  // namespace probe::stage
