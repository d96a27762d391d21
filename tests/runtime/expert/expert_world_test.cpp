#include <cstdio>
#include <cstdlib>

#include "runtime/expert/expert.h"
#include "runtime/expert/footprint.h"
#include "tests/runtime/expert/world_table.h"

namespace probe::expert {
namespace {

using test::need;

const std::vector<Vec2> kCells = {
    {-0.235, -0.075}, {-0.235, 0.075}, {-0.085, -0.075}, {-0.085, 0.075}};

Pose dropped(const Vec2& xy, double yaw_deg) {
  constexpr double kDegree = 0.017453292519943295;
  return {Vec3(xy.x(), xy.y(), test::kTable + 0.5),
          robot::from_rotation_vector({0, 0, yaw_deg * kDegree})};
}

struct Episode {
  bool intention = false, grasp = false, success = false;
  int released = -1;  // step after which the source lies on the target and no finger touches it
};

Episode play(test::WorldTable& table, policy::Policy& policy, bool trace = false) {
  Episode out;
  const Status begun = policy.begin(table.start());
  REQUIRE(begun.ok());
  for (int step = 0; step < test::kHorizon; ++step) {
    const auto observation = table.observe(step);
    const policy::Action action = need(policy.act(observation));
    if (trace) {
      const Pose tcp = table.view().base * observation.proprioception.tcp_in_base;
      const auto& source = table.view().objects[0];
      const auto& target = table.view().objects[1];
      std::printf(
          "%2d tcp %.3f %.3f %.3f open %.2f src %.3f %.3f %.3f %d%d tgt %.3f %.3f %.3f "
          "act %.3f %.3f %.3f %.2f %.2f %.2f %.2f ik %d ok %d\n",
          step, tcp.position.x(), tcp.position.y(), tcp.position.z(),
          observation.proprioception.openness, source.pose.position.x(), source.pose.position.y(),
          source.pose.position.z(), source.finger_contact[0], source.finger_contact[1],
          target.pose.position.x(), target.pose.position.y(), target.pose.position.z(), action[0],
          action[1], action[2], action[3], action[4], action[5], action[6], table.reached(),
          table.success());
    }
    table.apply(action);
    const auto& source = table.view().objects[0];
    const bool lies = table.success() && !source.finger_contact[0] && !source.finger_contact[1];
    if (!lies) out.released = -1;
    if (lies && out.released < 0) out.released = step + 1;
  }
  out.intention = table.intention();
  out.grasp = table.grasp();
  out.success = table.success();
  return out;
}

std::vector<test::Thing> carrot_and_plate() {
  return {test::load_thing("carrot", 700, {0.0575, 0.016, 0.019}),
          test::load_thing("plate", 1000, {0.055, 0.055, 0.003})};
}

TEST_CASE("the expert solves carrot_on_plate from the suite's starts") {
  const test::Robot robot = test::load_robot();
  const auto things = carrot_and_plate();
  auto policy = need(make_expert({}));
  int episode = 0, intention = 0, grasp = 0, success = 0, latest = 0;
  const char* traced = std::getenv("PROBE_TRACE_EPISODE");
  for (std::size_t from = 0; from < 4; ++from) {
    for (std::size_t to = 0; to < 4; ++to) {
      if (from == to) continue;
      for (const double yaw : {180.0, -90.0}) {
        CAPTURE(episode);
        test::WorldTable table(robot, things, {dropped(kCells[from], yaw), dropped(kCells[to], 0)});
        const Episode e = play(table, *policy, traced && std::atoi(traced) == episode);
        intention += e.intention;
        grasp += e.grasp;
        success += e.success;
        latest = std::max(latest, e.released);
        CHECK(e.success);
        CHECK(e.released > 0);
        ++episode;
      }
    }
  }
  MESSAGE("intention ", intention, " grasp ", grasp, " success ", success,
          " of 24, the last is let go after ", latest, " steps");
  CHECK(intention == 24);
  CHECK(grasp == 24);
  CHECK(success >= 22);
}

TEST_CASE("other places and directions are solved as well") {
  const test::Robot robot = test::load_robot();
  const auto things = carrot_and_plate();
  auto policy = need(make_expert({}));
  const char* wanted = std::getenv("PROBE_RANDOM_STARTS");
  const int count = wanted ? std::atoi(wanted) : 20;
  policy::Draws draws(2024);
  int success = 0;
  for (int i = 0; i < count; ++i) {
    CAPTURE(i);
    // Anywhere in the suite's rectangle of cells, the plate at least 13 cm off.
    const auto place = [&] {
      return Vec2(-0.25 + 0.18 * draws.uniform(), -0.10 + 0.20 * draws.uniform());
    };
    const Vec2 carrot = place();
    Vec2 plate = place();
    while ((plate - carrot).norm() < 0.13) plate = place();
    const double yaw = 360 * draws.uniform();
    test::WorldTable table(robot, things, {dropped(carrot, yaw), dropped(plate, 0)});
    const Episode e = play(table, *policy);
    success += e.success;
    if (e.success) continue;
    MESSAGE("start ", i, ": carrot ", carrot.x(), " ", carrot.y(), " yaw ", yaw, " plate ",
            plate.x(), " ", plate.y(), " grasp ", e.grasp);
  }
  MESSAGE("success ", success, " of ", count);
  CHECK(success >= count - count / 20);
}

TEST_CASE("a carrot that is taken out of the fingers is fetched again") {
  const test::Robot robot = test::load_robot();
  const auto things = carrot_and_plate();
  auto policy = need(make_expert({}));
  for (const int when : {10, 13, 16}) {
    CAPTURE(when);
    test::WorldTable table(robot, things, {dropped(kCells[1], 180), dropped(kCells[2], 0)});
    REQUIRE(policy->begin(table.start()).ok());
    for (int step = 0; step < test::kHorizon; ++step) {
      if (step == when) {
        Pose away = dropped({-0.20, 0.09}, 50);
        away.position.z() = test::kTable + 0.02;
        table.world().set_body(0, away);
      }
      table.apply(need(policy->act(table.observe(step))));
    }
    CHECK(table.success());
  }
}

TEST_CASE("two millimetres of noise on every action are survived") {
  const test::Robot robot = test::load_robot();
  const auto things = carrot_and_plate();
  auto policy = need(make_expert({}));
  policy::Draws draws(3);
  // A sum of twelve uniforms: mean 0, deviation 1.
  const auto normal = [&] {
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += draws.uniform();
    return sum;
  };
  for (std::size_t i = 0; i < 4; ++i) {
    CAPTURE(i);
    test::WorldTable table(robot, things, {dropped(kCells[i], 180), dropped(kCells[3 - i], 0)});
    REQUIRE(policy->begin(table.start()).ok());
    for (int step = 0; step < test::kHorizon; ++step) {
      policy::Action action = need(policy->act(table.observe(step)));
      for (std::size_t k = 0; k < 6; ++k) action[k] += normal() * (k < 3 ? 0.002 : 0.006);
      table.apply(action);
    }
    CHECK(table.success());
  }
}

TEST_CASE("the one that only reaches touches or nears the source and takes nothing") {
  const test::Robot robot = test::load_robot();
  const auto things = carrot_and_plate();
  auto policy = need(make_expert({.source = 0, .target = 1, .close = false}));
  test::WorldTable table(robot, things, {dropped(kCells[0], 180), dropped(kCells[3], 0)});
  const Episode e = play(table, *policy);
  CHECK(e.intention);
  CHECK(!e.grasp);
  CHECK(!e.success);
}

TEST_CASE("neighbours are left where they are") {
  const test::Robot robot = test::load_robot();
  auto things = carrot_and_plate();
  for (const char* name : {"block", "tower"}) {
    const Vec3 half = name[0] == 'b' ? Vec3(0.02, 0.02, 0.02) : Vec3(0.025, 0.025, 0.06);
    things.push_back({name, 400, half,
                      std::make_shared<const scene::CollisionShape>(scene::make_box_shape(half))});
  }
  auto policy = need(make_expert({}));
  for (const double yaw : {180.0, -90.0}) {
    test::WorldTable table(robot, things,
                           {dropped(kCells[0], yaw), dropped(kCells[3], 0), dropped(kCells[1], 20),
                            dropped(kCells[2], 0)});
    const Vec3 block = table.view().objects[2].pose.position;
    const Vec3 tower = table.view().objects[3].pose.position;
    const Episode e = play(table, *policy);
    CHECK(e.success);
    CHECK((table.view().objects[2].pose.position - block).norm() < 0.001);
    CHECK((table.view().objects[3].pose.position - tower).norm() < 0.001);
  }
}

test::Thing solid(const std::string& name, double density, const Vec3& half, bool round) {
  if (!round) {
    return {name, density, half,
            std::make_shared<const scene::CollisionShape>(scene::make_box_shape(half))};
  }
  // A lying or standing drum: round about its y axis.
  std::vector<Vec3> rim;
  for (int i = 0; i < 16; ++i) {
    const Vec3 spoke =
        robot::axis_rotation(Vec3::UnitY(), i * 0.39269908169872414) * Vec3(half.x(), 0, 0);
    rim.push_back(spoke + Vec3(0, half.y(), 0));
    rim.push_back(spoke - Vec3(0, half.y(), 0));
  }
  return {name, density, half,
          std::make_shared<const scene::CollisionShape>(
              need(scene::make_collision_shape({rim}, name)))};
}

TEST_CASE("things of other shapes and sizes are put on others") {
  struct Job {
    test::Thing source, target;
    double yaw = 0, roll = 0;
  };
  const auto plate = carrot_and_plate()[1];
  const auto cube = solid("cube", 1000, {0.015, 0.015, 0.015}, false);
  const std::vector<Job> jobs = {
      {cube, solid("other cube", 1000, {0.015, 0.015, 0.015}, false), 0, 0},
      {cube, plate, 33, 0},
      {solid("can", 1000, {0.0165, 0.03075, 0.0165}, true), plate, 0, 90},
      {solid("can", 1000, {0.0165, 0.03075, 0.0165}, true), plate, 90, 0},
      {solid("juice", 300, {0.034, 0.013, 0.013}, false), plate, -90, 0},
      {solid("nut", 500, {0.018, 0.020, 0.008}, false), plate, 0, 0},
      {solid("tile", 700, {0.025, 0.025, 0.006}, false), cube, 0, 0},
      {cube, solid("keyboard", 1000, {0.076, 0.032, 0.005}, false), 0, 0},
  };
  const test::Robot robot = test::load_robot();
  auto policy = need(make_expert({}));
  int number = 0;
  const char* traced = std::getenv("PROBE_TRACE_JOB");
  for (const Job& job : jobs) {
    for (const auto& [from, to] : {std::pair{0, 3}, std::pair{3, 1}, std::pair{1, 0}}) {
      CAPTURE(number);
      CAPTURE(job.source.name);
      const std::vector<test::Thing> things{job.source, job.target};
      Pose start = dropped(kCells[std::size_t(from)], job.yaw);
      start.rotation =
          start.rotation * robot::from_rotation_vector({job.roll * 0.0174532925199, 0, 0});
      test::WorldTable table(robot, things, {start, dropped(kCells[std::size_t(to)], 0)});
      CHECK(play(table, *policy, traced && std::atoi(traced) == number).success);
      ++number;
    }
  }
}

TEST_CASE("the same start gives the same bits, whatever was played before") {
  const test::Robot robot = test::load_robot();
  const auto things = carrot_and_plate();
  const auto run = [&](policy::Policy& policy, double yaw) {
    test::WorldTable table(robot, things, {dropped(kCells[2], yaw), dropped(kCells[1], 0)});
    play(table, policy);
    return table.world().state_hash();
  };
  auto used = need(make_expert({})), fresh = need(make_expert({}));
  run(*used, -90);
  CHECK(run(*used, 180) == run(*fresh, 180));
}

}  // namespace
}  // namespace probe::expert
