// Opening a drawer whose joint the test moves, with an arm that comes to every target at once.
#include "runtime/expert/joint_skill.h"

#include <doctest/doctest.h>

#include <numbers>
#include <utility>

#include "runtime/expert/free_way.h"
#include "runtime/robot/control.h"
#include "tests/runtime/expert/fake_table.h"

namespace probe::expert {
namespace {

class ExactArm {
 public:
  explicit ExactArm(const robot::Robot& robot)
      : reach_(made(Reach::create(robot))),
        controller_(made(robot::EeDeltaPoseController::create(*robot.model, robot.control))) {
    controller_.reset(q_);
    servo_.begin(reach_.chain(), arm());
  }
  Arm arm() const {
    return {reach_.chain().pose(std::span(q_).first(6)), q_, controller_.openness(q_)};
  }
  const Reach& reach() const { return reach_; }
  // Whether there was an action.
  bool decide(JointSkill& skill, const policy::Privileged& view) {
    const auto action = skill.act(view, arm(), servo_, reach_);
    if (!action) return false;
    const auto targets = controller_.targets(action->tool(), q_);
    REQUIRE(targets.ok());
    q_.assign(targets->begin(), targets->end());
    return true;
  }

 private:
  template <typename T>
  static T made(Result<T> result) {
    REQUIRE(result.ok());
    return std::move(result).value();
  }
  Reach reach_;
  robot::EeDeltaPoseController controller_;
  Servo servo_;
  std::vector<double> q_ = {-0.01840777, 0.0398835,  0.22242722, -0.00460194,
                            1.36524296,  0.00153398, 0.037,      0.037};
};

// It opens towards the base by 10 cm, under a top 8 cm over its front; nothing of it can be held.
policy::Privileged shut_drawer() {
  policy::Privileged view;
  policy::PrivilegedFixture drawer;
  drawer.name = "drawer";
  drawer.parts = {test::block({-0.10, -0.10, 0.00}, {0.10, 0.10, 0.01}),
                  test::block({-0.10, -0.10, 0.01}, {-0.09, 0.10, 0.06})};
  drawer.pose.position = {0.50, 0, 0.05};
  policy::PrivilegedFixture::Joint joint;
  joint.slides = true;
  joint.axis = -Vec3::UnitX();
  joint.upper = 0.10;
  drawer.joint = joint;
  policy::PrivilegedFixture top;
  top.name = "top";
  top.parts = {test::block({-0.10, -0.12, 0}, {0.10, 0.12, 0.02})};
  top.pose.position = {0.50, 0, 0.19};
  view.fixtures = {drawer, top};
  return view;
}

void move_to(policy::Privileged& view, double position) {
  policy::PrivilegedFixture& drawer = view.fixtures[0];
  drawer.pose.position.x() = 0.50 - position;
  drawer.joint->position = position;
}

}  // namespace

TEST_CASE(
    "half open is enough of a drawer that is drawn by its edge, and not of one that is held") {
  policy::Skill open;
  open.kind = policy::Skill::Kind::kOpen;
  open.fixture = 0;
  const auto opened_to = [&](double share, bool has_handle) {
    ExactArm arm(test::widowx());
    policy::Privileged seen = shut_drawer();
    JointSkill skill;
    skill.begin(open, arm.arm().tcp);
    // It does not move at first; what could be held comes while the hand is on its way back.
    while (arm.arm().openness > 0.5) REQUIRE(arm.decide(skill, seen));
    while (arm.arm().openness < 0.5) REQUIRE(arm.decide(skill, seen));
    if (has_handle)
      seen.fixtures[0].parts.push_back(test::block({-0.20, -0.03, 0.02}, {-0.18, 0.03, 0.045}));
    while (skill.lack().empty()) REQUIRE(arm.decide(skill, seen));
    move_to(seen, share * 0.10);
    for (int i = 0; i < 400 && arm.decide(skill, seen); ++i) {
    }
    return skill.reached();
  };
  CHECK(opened_to(0.6, false));
  CHECK_FALSE(opened_to(0.6, true));
  CHECK(opened_to(0.96, true));
}

TEST_CASE("fingers that turn are set before the hand goes where they would meet something else") {
  policy::Privileged view;
  view.objects = {
      test::object("post", {test::block({-0.01, -0.01, 0}, {0.01, 0.01, 0.4})}, {0.3, 0.08, 0}, 0)};
  view.surface_z = -1;
  const Surroundings around = surroundings_of(view);
  robot::HandShape hand;
  hand.tip_below = 0.02;
  hand.palm_above = 0.05;
  hand.finger_half = 0.01;
  hand.opening_half = 0.04;
  hand.outside_half = 0.10;
  hand.palm_half = 0.03;
  robot::FingersAt closed, open;
  closed.tip_below = open.tip_below = 0.02;
  closed.inner.fill(0);
  closed.outer.fill(0.02);
  open.openness = 1;
  open.gap_half = 0.08;
  open.inner.fill(0.08);
  open.outer.fill(0.10);
  const Quat down = robot::from_rotation_vector({0, 0.5 * std::numbers::pi, 0});
  const Pose from{{0.15, 0, 0.2}, down}, past{{0.50, 0, 0.2}, down}, before{{0.2, 0, 0.2}, down};
  CHECK_FALSE(is_set_first(around, from, std::array{past}, hand, 1, 0));  // they slide
  hand.turning = {closed, open};
  CHECK(is_set_first(around, from, std::array{past}, hand, 1, 0));
  CHECK_FALSE(is_set_first(around, from, std::array{before}, hand, 1, 0));
  CHECK_FALSE(is_set_first(around, from, std::array{past}, hand, 0, 0));
  CHECK_FALSE(is_set_first(around, from, std::array{past}, hand, 0, 1));  // set, too, they do
  CHECK(hand.widest() == doctest::Approx(0.5));
  // Near enough is set, and what does not come there is not waited for.
  CHECK(are_set(0.52, 0.5, 0));
  CHECK_FALSE(are_set(0.6, 0.5, 9));
  CHECK(are_set(0.6, 0.5, 10));
}

}  // namespace probe::expert
