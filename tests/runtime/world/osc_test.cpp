// `osc_pose` where the answer is known in closed form, and what it must never do.
#include <cmath>

#include <doctest/doctest.h>

#include "tests/runtime/world/panda.h"

namespace probe::world {
namespace {

using std::size_t;

std::unique_ptr<Panda> panda() {
  auto made = load_panda();
  REQUIRE_MESSAGE(made.ok(), (made.ok() ? std::string() : to_text(made.failure())));
  return std::move(made).value();
}

// Nothing brakes its joints.
std::unique_ptr<Panda> frictionless() {
  auto made = panda();
  for (JointSpec& joint : made->spec.joints) joint.friction = joint.damping = 0;
  made->spec.positions[7] = made->spec.positions[8] = 0.02;
  return made;
}

PandaAlone stand(const Panda& robot, const WorldSpec& spec) {
  auto made = stand_up(robot, spec);
  REQUIRE_MESSAGE(made.ok(), (made.ok() ? std::string() : to_text(made.failure())));
  return std::move(made).value();
}

WorldSpec in_vacuum(double dt = 0.002) {
  WorldSpec spec;
  spec.surface_z = -5;
  spec.dt = dt;
  return spec;
}

const std::vector<double> kStill{0, 0, 0, 0, 0, 0, 0};

TEST_CASE("an arm at home that is asked for nothing carries its weight and stays") {
  const auto robot = frictionless();
  PandaAlone arm = stand(*robot, in_vacuum());
  for (int i = 0; i < 40; ++i) REQUIRE(arm.act(kStill).ok());
  for (size_t j = 0; j < 9; ++j) {
    // The fingers hang a little askew on their springs.
    CHECK(std::abs(arm.world->joints()[j] - robot->spec.positions[j]) < (j < 7 ? 1e-9 : 1e-7));
  }
}

TEST_CASE("without efforts the arm falls as a pendulum does") {
  auto robot = frictionless();
  PandaAlone arm = stand(*robot, in_vacuum(0.001));
  const auto tool = arm.world->find_tool("tool", 7);
  REQUIRE(tool.ok());
  // Its first acceleration is that of its weight: M a = -bias, up to the fingers, which slide.
  robot::Dynamics at;
  arm.world->read_dynamics(*tool, &at);
  const robot::JointVector falls = at.mass.fullPivLu().solve(-at.bias);
  REQUIRE(arm.world->step(1).ok());
  for (Eigen::Index j = 0; j < 7; ++j) {
    const double u = arm.world->joint_speeds()[static_cast<size_t>(j)];
    CHECK(std::abs(u / 0.001 - falls[j]) < 1e-3 * falls.norm());
  }
}

// x'' = kp (g - x) - kd x' with kd = 2 sqrt(kp): x = g (1 - (1 + w t) exp(-w t)), w = sqrt(kp).
double largest_lag(double dt) {
  auto robot = frictionless();
  robot->law.uncouple = false;  // else shift and turn disturb each other
  PandaAlone arm = stand(*robot, in_vacuum(dt));
  const Vec3 start = arm.tool();
  // One long control step, in which the goal is set once.
  std::vector<double> up{0, 0, 0.02, 0, 0, 0, 0};  // 1 mm
  double worst = 0;
  const double w = std::sqrt(150.0);
  REQUIRE(arm.controller.begin(up, arm.world->joints(), {}, 1).ok());
  const auto tool = arm.world->find_tool("tool", 7);
  robot::Dynamics now;
  std::vector<double> efforts(9);
  for (double t = dt; t < 0.5; t += dt) {
    REQUIRE(arm.world
                ->step(1,
                       [&] {
                         arm.world->read_dynamics(*tool, &now);
                         arm.controller.efforts(now, efforts);
                         arm.world->set_efforts(0, efforts);
                       })
                .ok());
    const double x = arm.tool().z() - start.z();
    worst = std::max(worst, std::abs(x - 1e-3 * (1 - (1 + w * t) * std::exp(-w * t))));
  }
  return worst;
}

TEST_CASE("a step of the goal is answered as a critically damped spring answers it") {
  const double coarse = largest_lag(0.002), fine = largest_lag(0.001);
  MESSAGE("off the closed form of a 1 mm step by ", 1e3 * coarse, " mm at 2 ms, ", 1e3 * fine,
          " mm at 1 ms");
  CHECK(coarse < 2e-5);
  CHECK(fine < 0.6 * coarse);
}

TEST_CASE("what draws the joints home does not move the tool") {
  const auto robot = panda();
  PandaAlone arm = stand(*robot, in_vacuum());
  const auto tool = arm.world->find_tool("tool", 7);
  robot::Dynamics now;
  arm.world->read_dynamics(*tool, &now);
  const auto torques = [&](double null_kp) {
    robot::OscPose law = robot->law;
    law.null_kp = null_kp;
    law.home = {0.3, 0.1, -0.2, -2.1, 0.2, 2.0, 0.5};
    auto osc = robot::OscPoseController::create(robot->model, robot->joints, law);
    REQUIRE(osc.ok());
    REQUIRE(osc->restore({{now.position, Quat(now.axes)}, {0, 0}, true}).ok());
    std::array<double, 9> tau{};
    osc->efforts(now, tau);
    return robot::JointVector(Eigen::Map<const Eigen::Matrix<double, 7, 1>>(tau.data()));
  };
  const robot::JointVector drawn = torques(10) - torques(0);
  CHECK(drawn.norm() > 1);
  const robot::JointVector moves = now.mass.fullPivLu().solve(drawn);
  CHECK((now.jacobian * moves).norm() < 1e-9);
  CHECK(moves.norm() > 0.1);
}

TEST_CASE("with a straight arm and with no arm to turn torques stay finite and within limits") {
  const auto robot = panda();
  PandaAlone arm = stand(*robot, in_vacuum());
  const auto tool = arm.world->find_tool("tool", 7);
  auto made = robot::OscPoseController::create(robot->model, robot->joints, robot->law);
  REQUIRE(made.ok());
  robot::Dynamics now;
  const auto check = [&] {
    std::array<double, 9> tau{};
    made->efforts(now, tau);
    for (size_t j = 0; j < 7; ++j) {
      CHECK(std::isfinite(tau[j]));
      CHECK(std::abs(tau[j]) <= (j < 5 ? 80 : 12));
    }
  };
  // Straight up: the tool cannot move along the arm, and three axes are one.
  const std::vector<double> straight{0, 0, 0, 0, 0, 0, 0};
  arm.world->read_dynamics_at(*tool, straight, &now);
  check();
  now.jacobian.row(2).setZero();
  check();
  now.jacobian.setZero();
  check();
}

TEST_CASE("reaching beyond its reach the arm presses its joints' limits and stays within them") {
  const auto robot = panda();
  PandaAlone arm = stand(*robot, in_the_air());
  double beyond = 0, fastest = 0;
  for (const int axis : {0, 2, 4, 5}) {
    for (const double way : {1.0, -1.0}) {
      std::vector<double> action = kStill;
      action[static_cast<size_t>(axis)] = way;
      for (int i = 0; i < 60; ++i) {
        REQUIRE(arm.act(action).ok());
        for (size_t j = 0; j < 7; ++j) {
          const robot::Joint& joint = robot->model.joints[static_cast<size_t>(
              robot->model.find_joint(robot->spec.joints[j].joint))];
          const double q = arm.world->joints()[j];
          beyond = std::max({beyond, q - joint.upper, joint.lower - q});
          fastest = std::max(fastest, std::abs(arm.world->joint_speeds()[j]));
        }
      }
    }
  }
  MESSAGE("beyond a limit by ", beyond, " rad, fastest joint ", fastest, " rad/s");
  CHECK(beyond < 1e-3);
  CHECK(fastest < 20);
}

TEST_CASE("a string of shifts holds the last rotation, a shift begins where the tool is") {
  const auto robot = panda();
  auto made = robot::OscPoseController::create(robot->model, robot->joints, robot->law);
  REQUIRE(made.ok());
  PandaAlone arm = stand(*robot, in_vacuum());
  const auto tool = arm.world->find_tool("tool", 7);
  robot::Dynamics now;
  arm.world->read_dynamics_at(*tool, std::vector<double>{0.1, 0, 0, -2.2, 0, 2.1, 0.7}, &now);
  std::array<double, 9> tau{};
  const Quat first = made->goal().rotation;
  REQUIRE(made->begin(std::vector<double>{1, -2, 0.5, 0, 0, 0, 0}, 25).ok());
  made->efforts(now, tau);
  CHECK((made->goal().position - now.position - Vec3(0.05, -0.05, 0.025)).norm() < 1e-15);
  CHECK(made->goal().rotation.coeffs() == first.coeffs());
  REQUIRE(made->begin(std::vector<double>{0, 0, 0, 0, 0, 0.5, 0}, 25).ok());
  made->efforts(now, tau);
  const Quat turned = made->goal().rotation;
  CHECK(Quat(now.axes).angularDistance(turned) == doctest::Approx(0.25));
}

TEST_CASE("a ramp spreads a step of the goal over its share of the control step") {
  auto robot = panda();
  PandaAlone arm = stand(*robot, in_vacuum());
  const auto tool = arm.world->find_tool("tool", 7);
  robot::Dynamics now;
  arm.world->read_dynamics_at(*tool, robot->law.home, &now);
  const auto lift = [&](double ramp) {
    robot::OscPose law = robot->law;
    law.ramp = ramp;
    auto osc = robot::OscPoseController::create(robot->model, robot->joints, law);
    REQUIRE(osc.ok());
    std::vector<double> first;
    std::array<double, 9> tau{};
    REQUIRE(osc->begin(std::vector<double>{0, 0, 1, 0, 0, 0, 0}, 25).ok());
    for (int i = 0; i < 6; ++i) {
      osc->efforts(now, tau);
      first.push_back(tau[1]);
    }
    return first;
  };
  const std::vector<double> at_once = lift(0), ramped = lift(0.2);
  CHECK(ramped[0] != at_once[0]);
  CHECK(ramped[3] != at_once[3]);
  CHECK(ramped[4] == doctest::Approx(at_once[4]));  // the fifth of five substeps
  CHECK(ramped[5] == doctest::Approx(at_once[5]));
}

TEST_CASE("saved in the middle and restored in a fresh world the arm goes on bit for bit") {
  const auto robot = panda();
  PandaAlone arm = stand(*robot, in_the_air());
  const std::vector<double> there{0.4, -0.2, -0.6, 0.1, 0, 0.3, 1}, back{-0.3, 0.5, 0, 0, 0, 0, -1};
  for (int i = 0; i < 7; ++i) REQUIRE(arm.act(there).ok());
  const auto physics = arm.world->save();
  const robot::ControlState control = arm.controller.save();
  for (int i = 0; i < 30; ++i) REQUIRE(arm.act(back).ok());

  PandaAlone other = stand(*robot, in_the_air());
  REQUIRE(other.world->restore(physics).ok());
  REQUIRE(other.controller.restore(control).ok());
  for (int i = 0; i < 30; ++i) REQUIRE(other.act(back).ok());
  CHECK(other.world->state_hash() == arm.world->state_hash());
  CHECK(other.controller.save().joint_targets == arm.controller.save().joint_targets);
}

TEST_CASE("the fingers take a cube, lift it and do not let it slip") {
  auto robot = panda();
  REQUIRE(add_panda_hand(robot.get()).ok());
  robot->spec.positions[7] = robot->spec.positions[8] = 0.04;
  WorldSpec spec = in_the_air();
  const Vec3 tool = stand(*robot, spec).tool() + robot->spec.base.position;
  spec.surface_z = tool.z() - 0.02;
  spec.bodies.push_back(
      {"cube",
       std::make_shared<const scene::CollisionShape>(scene::make_box_shape(Vec3(0.02, 0.02, 0.02))),
       500, 0.5, Pose{tool, Quat::Identity()}});
  PandaAlone arm = stand(*robot, spec);
  const auto act = [&](double up, int steps) {
    for (int i = 0; i < steps; ++i) {
      const auto status = arm.act(std::vector<double>{0, 0, up, 0, 0, 0, 1});
      REQUIRE_MESSAGE(status.ok(), (status.ok() ? std::string() : to_text(status.failure())));
    }
  };
  act(0, 12);
  const double width = arm.world->joints()[7] + arm.world->joints()[8];
  CHECK(width == doctest::Approx(0.041).epsilon(0.02));
  act(0.5, 20);
  const double lifted = arm.world->body(0).pose.position.z() - tool.z();
  CHECK(lifted > 0.05);
  act(0, 10);
  const auto in_hand = [&] {
    return arm.world->frame_pose("hand").inverse().apply(arm.world->body(0).center);
  };
  const Vec3 before = in_hand();
  act(0, 100);
  const double slip = (in_hand() - before).norm();
  MESSAGE("lifted by ", lifted, " m; slip in 5 s ", 1e3 * slip, " mm");
  CHECK(slip < 1e-5);
}

TEST_CASE("what a law of efforts is given to drive must take efforts") {
  auto robot = panda();
  robot->spec.by_efforts = false;
  const auto refused = stand_up(*robot, in_vacuum());
  REQUIRE(!refused.ok());
  CHECK(refused.failure().message ==
        "`osc_pose` gives joints efforts, the world's robot takes targets");
  robot->spec.by_efforts = true;
  robot->spec.driven = false;
  CHECK(!stand_up(*robot, in_vacuum()).ok());
}

TEST_CASE("actions that mean nothing are refused, and change nothing") {
  const auto robot = panda();
  PandaAlone arm = stand(*robot, in_vacuum());
  const Sha256 before = arm.world->state_hash();
  const auto six = arm.act(std::vector<double>{0, 0, 0, 0, 0, 0});
  REQUIRE(!six.ok());
  CHECK(six.failure().message == "an action of 6 numbers, `osc_pose` wants 7");
  const auto none = arm.act(std::vector<double>{0, 0, std::nan(""), 0, 0, 0, 0});
  REQUIRE(!none.ok());
  CHECK(none.failure().message == "action[2] is nan, wanted a share of the largest shift, -1 to 1");
  CHECK(arm.world->state_hash() == before);
}

}  // namespace
}  // namespace probe::world
