#include "runtime/expert/expert.h"

#include <chrono>

#include "tests/runtime/expert/fake_table.h"

namespace probe::expert {
namespace {

std::unique_ptr<policy::Policy> expert(const ExpertOptions& options = {}) {
  auto made = make_expert(options);
  REQUIRE(made.ok());
  return std::move(made).value();
}

template <typename T>
std::string refusal(const T& result, Fault code = Fault::kPolicy) {
  REQUIRE(!result.ok());
  CHECK(result.failure().code == code);
  return result.failure().message;
}

// The whole episode; returns the step after which the source first lay on the target, -1 never.
int play(test::FakeTable& table, policy::Policy& policy) {
  REQUIRE(policy.begin(table.start()).ok());
  int solved = -1;
  for (int step = 0; step < 60; ++step) {
    const auto action = policy.act(table.observe(step));
    REQUIRE(action.ok());
    for (const double number : *action) REQUIRE(std::isfinite(number));
    REQUIRE(table.apply(*action).ok());
    if (!table.source_on_target()) solved = -1;
    if (table.source_on_target() && solved < 0) solved = step + 1;
  }
  return solved;
}

const std::vector<Vec2> kCells = {
    {-0.235, -0.075}, {-0.235, 0.075}, {-0.085, -0.075}, {-0.085, 0.075}};

TEST_CASE("where all was done and success is not true it says so, and of a success nothing") {
  for (const bool success : {true, false}) {
    test::FakeTable table(test::carrot(kCells[0].x(), kCells[0].y(), 180),
                          test::plate(kCells[3].x(), kCells[3].y()));
    const auto policy = expert();
    REQUIRE(play(table, *policy) > 0);
    policy->end({true, success, 60});
    const std::string remark = policy->remark().value_or("");
    CHECK(remark ==
          (success ? "" : "skill `put carrot on plate`: it was done, but `success` is not true"));
  }
}

TEST_CASE("every ordered pair of cells and both orientations is solved with steps to spare") {
  int latest = 0;
  for (std::size_t from = 0; from < 4; ++from) {
    for (std::size_t to = 0; to < 4; ++to) {
      if (from == to) continue;
      for (const double yaw : {180.0, -90.0}) {
        CAPTURE(from);
        CAPTURE(to);
        CAPTURE(yaw);
        test::FakeTable table(test::carrot(kCells[from].x(), kCells[from].y(), yaw),
                              test::plate(kCells[to].x(), kCells[to].y()));
        const auto policy = expert();
        const int solved = play(table, *policy);
        CHECK(solved > 0);
        CHECK(table.lowest_tip() > test::kSurface + 0.001);
        CHECK(table.openness() > 0.95);
        CHECK(table.tcp_in_world().position.z() > test::kSurface + 0.06);
        latest = std::max(latest, solved);
      }
    }
  }
  MESSAGE("the slowest takes ", latest, " steps");
  CHECK(latest <= 40);
}

TEST_CASE("a grasp that slips is tried again") {
  test::FakeTable table(test::carrot(-0.2, 0, 40), test::plate(-0.1, 0.1));
  table.lose_next_grasp();
  const auto policy = expert();
  CHECK(play(table, *policy) > 0);
}

TEST_CASE("a source that is pushed during the approach is followed") {
  test::FakeTable table(test::carrot(-0.235, -0.075, 0), test::plate(-0.085, 0.075));
  const auto policy = expert();
  REQUIRE(policy->begin(table.start()).ok());
  bool solved = false;
  for (int step = 0; step < 60; ++step) {
    if (step == 3) table.source().pose.position += Vec3(0.02, 0.03, 0);
    const auto action = policy->act(table.observe(step));
    REQUIRE(action.ok());
    REQUIRE(table.apply(*action).ok());
    solved = table.source_on_target();
  }
  CHECK(solved);
}

TEST_CASE("tall neighbours are passed above") {
  const auto can = test::object("can", {test::block({-0.03, -0.03, 0}, {0.03, 0.03, 0.12})},
                                {-0.16, 0, test::kSurface}, 0);
  test::FakeTable table(test::carrot(-0.235, -0.075, 0), test::plate(-0.085, 0.075), {can});
  const auto policy = expert();
  CHECK(play(table, *policy) > 0);
}

TEST_CASE("the one that only reaches stands at the source with open fingers") {
  test::FakeTable table(test::carrot(-0.235, -0.075, 180), test::plate(-0.085, 0.075));
  const auto policy = expert({.source = 0, .target = -1, .close = false});
  CHECK(play(table, *policy) == -1);
  CHECK(!table.was_held());
  CHECK((table.tcp_in_world().position - table.source().pose.position).norm() < 0.05);
  CHECK(table.openness() > 0.95);
}

TEST_CASE("the one that only reaches goes to the first thing that is not as it shall be") {
  policy::PrivilegedFixture drawer;
  drawer.name = "drawer";
  drawer.parts = {test::block({-0.1, -0.1, 0}, {0.1, 0.1, 0.05})};
  drawer.pose.position = {-0.30, 0.30, test::kSurface};
  drawer.joint.emplace();
  drawer.joint->slides = true;
  drawer.joint->upper = drawer.joint->position = 0.1;
  policy::Skill open, put;
  open.kind = policy::Skill::Kind::kOpen;
  open.fixture = 0;
  put.kind = policy::Skill::Kind::kPut;
  put.object = 0;
  put.to_object = 1;
  test::FakeTable table(test::carrot(-0.235, -0.075, 180), test::plate(-0.085, 0.075));
  table.view().fixtures = {drawer};
  table.view().solution = {open, put};
  const auto policy = expert({.source = 0, .target = -1, .close = false});
  CHECK(play(table, *policy) == -1);
  CHECK((table.tcp_in_world().position - table.source().pose.position).norm() < 0.05);
  // Nowhere, when all is.
  test::FakeTable done(test::carrot(-0.235, -0.075, 180), test::plate(-0.085, 0.075));
  done.view().fixtures = {drawer};
  done.view().solution = {open};
  const Vec3 before = done.tcp_in_world().position;
  CHECK(play(done, *policy) == -1);
  CHECK((done.tcp_in_world().position - before).norm() < 0.01);
}

TEST_CASE("where nothing is left to do the one that only reaches stays where it is, too") {
  test::FakeTable table(test::carrot(-0.235, -0.075, 180), test::plate(-0.085, 0.075));
  table.set_goal(policy::Goal::kNothing);
  table.view().source = -1;
  const Vec3 before = table.tcp_in_world().position;
  const auto policy = expert({.source = 0, .target = -1, .close = false});
  CHECK(play(table, *policy) == -1);
  CHECK((table.tcp_in_world().position - before).norm() < 0.01);
}

TEST_CASE("the roles can be others, as for taking a distractor") {
  const auto cube = test::object("cube", {test::block({-0.015, -0.015, 0}, {0.015, 0.015, 0.03})},
                                 {-0.235, 0.075, test::kSurface}, 0);
  test::FakeTable table(test::carrot(-0.235, -0.075, 0), test::plate(-0.085, 0.075), {cube});
  const auto policy = expert({.source = 2, .target = 1});
  REQUIRE(policy->begin(table.start()).ok());
  for (int step = 0; step < 18; ++step) {
    const auto action = policy->act(table.observe(step));
    REQUIRE(action.ok());
    REQUIRE(table.apply(*action).ok());
  }
  CHECK((table.tcp_in_world().position.head<2>() - Vec2(-0.235, 0.075)).norm() < 0.03);
}

TEST_CASE("what shall be anywhere but on the target is taken elsewhere and kept in hand") {
  for (const double x : {-0.235, -0.085}) {
    CAPTURE(x);
    test::FakeTable table(test::carrot(x, 0.075, 180), test::plate(-0.16, -0.075));
    table.set_goal(policy::Goal::kAway);
    const Vec2 before = table.source().pose.position.head<2>();
    const auto policy = expert();
    CHECK(play(table, *policy) < 0);
    CHECK(table.held());
    const Vec2 after = table.source().pose.position.head<2>();
    CHECK((after - before).norm() > 0.08);
    CHECK((after - table.target().pose.position.head<2>()).norm() > 0.10);
    CHECK(table.lowest_tip() > test::kSurface + 0.001);
  }
}

TEST_CASE("the same episode gets the same actions") {
  std::vector<policy::Action> runs[2];
  for (auto& run : runs) {
    test::FakeTable table(test::carrot(-0.2, 0, 70), test::plate(-0.1, 0.1));
    const auto policy = expert();
    REQUIRE(policy->begin(table.start()).ok());
    for (int step = 0; step < 60; ++step) {
      const auto action = policy->act(table.observe(step));
      REQUIRE(action.ok());
      run.push_back(*action);
      REQUIRE(table.apply(*action).ok());
    }
  }
  CHECK(runs[0] == runs[1]);
}

TEST_CASE("an action costs little") {
  test::FakeTable table(test::carrot(-0.235, -0.075, 180), test::plate(-0.085, 0.075));
  const auto policy = expert();
  REQUIRE(policy->begin(table.start()).ok());
  double longest = 0, total = 0;
  for (int step = 0; step < 60; ++step) {
    const auto begin = std::chrono::steady_clock::now();
    const auto action = policy->act(table.observe(step));
    const double took =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    longest = std::max(longest, took);
    total += took;
    REQUIRE(action.ok());
    REQUIRE(table.apply(*action).ok());
  }
  MESSAGE("mean ", 1e6 * total / 60, " us, longest ", 1e6 * longest, " us");
  CHECK(total / 60 < 0.01);
}

TEST_CASE("what shall only be picked up is lifted and kept in hand") {
  test::FakeTable table(test::carrot(-0.2, 0.02, 180), test::plate(-0.1, -0.1));
  table.set_goal(policy::Goal::kLifted);
  const double before = table.source().pose.position.z();
  const auto policy = expert();
  CHECK(play(table, *policy) == -1);
  CHECK(table.held());
  CHECK(table.source().pose.position.z() - before > 0.09);
}

TEST_CASE("where actions are late the expert attempts nothing") {
  test::FakeTable table(test::carrot(-0.2, 0, 0), test::plate(-0.1, 0.1));
  policy::EpisodeStart start = table.start();
  start.delay = 1;
  const auto begun = expert()->begin(start);
  REQUIRE_FALSE(begun.ok());
  CHECK(begun.failure().code == Fault::kNoSkill);
  CHECK(begun.failure().message == policy::kLateActions);
}

TEST_CASE("a goal that picking and placing does not reach is not attempted") {
  test::FakeTable table(test::carrot(-0.2, 0, 0), test::plate(-0.1, 0.1));
  table.set_goal(policy::Goal::kOther);
  const auto policy = expert();
  REQUIRE(policy->begin(table.start()).ok());
  CHECK(refusal(policy->act(table.observe(0)), Fault::kNoSkill) == policy::kNoSolution);
  // What only goes there needs no goal.
  const auto reach = expert({.source = 0, .target = -1, .close = false});
  REQUIRE(reach->begin(table.start()).ok());
  CHECK(reach->act(table.observe(0)).ok());
}

TEST_CASE("without what it needs the expert says so") {
  test::FakeTable table(test::carrot(-0.2, 0, 0), test::plate(-0.1, 0.1));
  auto policy = expert();
  CHECK(refusal(policy->act(table.observe(0))) ==
        "the expert was asked to act before an episode began");
  REQUIRE(policy->begin(table.start()).ok());
  policy::Observation blind = table.observe(0);
  blind.privileged = nullptr;
  CHECK(refusal(policy->act(blind)) == "the expert needs the privileged view and got none");
  policy::Observation stiff = table.observe(0);
  stiff.proprioception.joints.resize(3);
  CHECK(refusal(policy->act(stiff)) == "the expert needs 6 joint positions and got 3");
  policy = expert({.source = 0, .target = 5});
  REQUIRE(policy->begin(table.start()).ok());
  CHECK(refusal(policy->act(table.observe(0))) ==
        "the expert works on roles 0 and 5, the episode has 2 objects");
  CHECK(!make_expert({.source = 1, .target = 1}).ok());
  policy::EpisodeStart start = table.start();
  robot::Robot robot = test::widowx();
  start.robot = &robot;
  robot.tcp_link = "tool";
  CHECK(refusal(policy->begin(start), Fault::kUrdf) == "no link is named `tool`");
  CHECK(refusal(policy->act(table.observe(0))) ==
        "the expert was asked to act before an episode began");
  start.robot = nullptr;
  CHECK(refusal(policy->begin(start)) == "the expert was told of no robot");
}

TEST_CASE("a robot without two fingers that close on each other is refused by name") {
  const test::FakeTable table(test::carrot(-0.235, -0.075, 20), test::plate(-0.085, 0.075));
  auto policy = expert({});
  policy::EpisodeStart start = table.start();
  robot::Robot robot = test::widowx();
  start.robot = &robot;
  robot.hand.reset();
  CHECK(refusal(policy->begin(start), Fault::kNoSkill) ==
        "the expert grasps with two fingers that close on each other; the robot `wx250s` has "
        "others");
  robot.fingers.clear();
  CHECK(refusal(policy->begin(start), Fault::kNoSkill) ==
        "the expert grasps with two fingers that close on each other; the robot `wx250s` has no "
        "fingers");
}

}  // namespace
}  // namespace probe::expert
