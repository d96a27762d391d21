// Conventions of servers against the simulator's.
#include "runtime/servers/conversion.h"

#include "runtime/servers/meaning.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "runtime/base/sha256.h"
#include "runtime/policy/sent_prompt.h"
#include "runtime/robot/control.h"
#include "runtime/robot/rotation.h"
#include "runtime/servers/profile_check.h"
#include "runtime/servers/profile_library.h"
#include "runtime/servers/profile_words.h"
#include "runtime/servers/server_policy.h"
#include "tests/runtime/robot/test_robots.h"

namespace probe::servers {
using namespace probe::policy;
namespace {

constexpr double kPi = 3.14159265358979323846;

std::string refused(const Profile& profile, const RawAction& raw) {
  const auto action = to_action(profile, raw);
  REQUIRE_FALSE(action.ok());
  return action.failure().message;
}

}  // namespace

TEST_CASE("numbers that already are ours come back bit for bit") {
  const RawAction raw{0.012345678901234567, -0.1, 1e-300, 0.3, -0.2, 0.1, -0.73};
  const auto action = to_action(Profile{}, raw);
  REQUIRE(action.ok());
  CHECK(RawAction(action->begin(), action->end()) == raw);
}

// transforms3d: euler2axangle(0.1, 0.2, 0.3, 'sxyz') = axis * angle.
TEST_CASE("roll pitch yaw becomes a rotation vector") {
  Profile profile;
  profile.action_rotation = RotationForm::kEuler;
  const auto action = to_action(profile, {0, 0, 0, 0.1, 0.2, 0.3, 1});
  REQUIRE(action.ok());
  const double roll = 0.1, pitch = 0.2, yaw = 0.3;
  const Mat3 expected =
      (Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(pitch, Vec3::UnitY()) *
       Eigen::AngleAxisd(roll, Vec3::UnitX()))
          .toRotationMatrix();
  const Vec3 vector((*action)[3], (*action)[4], (*action)[5]);
  CHECK((robot::from_rotation_vector(vector).toRotationMatrix() - expected).norm() < 1e-12);
  CHECK(std::abs(vector.x() - 0.1) > 0.01);  // it is another one than roll pitch yaw
}

TEST_CASE("the gripper opens above the threshold, and the other way round where it is inverted") {
  Profile profile;
  const auto gripper = [&](GripperRange range, std::optional<double> threshold, double raw) {
    profile.action_gripper = range;
    profile.action_threshold = threshold;
    const auto action = to_action(profile, {0, 0, 0, 0, 0, 0, raw});
    REQUIRE(action.ok());
    return (*action)[6];
  };
  CHECK(gripper(GripperRange::kUnit, 0.5, 0.9) == 1);
  CHECK(gripper(GripperRange::kUnit, 0.5, 0.5) == -1);
  CHECK(gripper(GripperRange::kUnit, std::nullopt, 0.75) == 0.5);
  CHECK(gripper(GripperRange::kUnitInverted, 0.5, 0.9) == -1);
  CHECK(gripper(GripperRange::kUnitInverted, std::nullopt, 0) == 1);
  CHECK(gripper(GripperRange::kSignedInverted, 0.0, 0.2) == -1);
  CHECK(gripper(GripperRange::kSignedInverted, std::nullopt, 1) == -1);
  CHECK(gripper(GripperRange::kSigned, 0.0, 0.2) == 1);
  CHECK(gripper(GripperRange::kSigned, std::nullopt, 1.02) == 1);
}

TEST_CASE("raw numbers are taken back by the profile's statistics") {
  Profile profile;
  profile.action_statistics.kind = Normalisation::kBound;
  profile.action_statistics.low = {-0.02, -1, -1, -1, -1, -1, 0};
  profile.action_statistics.high = {0.06, 1, 1, 1, 1, 1, 1};
  profile.action_statistics.mask = {1, 1, 1, 1, 1, 1, 0};
  auto action = to_action(profile, {0.5, 0, 0, 0, 0, 0, 0.25});
  REQUIRE(action.ok());
  CHECK((*action)[0] == doctest::Approx(0.04));
  CHECK((*action)[6] == 0.25);
  profile.action_statistics.kind = Normalisation::kGaussian;
  profile.action_statistics.mean.assign(7, 0.01);
  profile.action_statistics.std.assign(7, 0.1);
  action = to_action(profile, {1, 0, 0, 0, 0, 0, 0.25});
  REQUIRE(action.ok());
  CHECK((*action)[0] == doctest::Approx(0.11));
}

TEST_CASE("what cannot be metres, radians or a gripper is refused with the field at fault") {
  CHECK(refused(Profile{}, {0.9, 0.9, 0, 0, 0, 0, 1}).find("`action.limit_m`") !=
        std::string::npos);
  CHECK(refused(Profile{}, {0, 0, 0, 0, 7, 0, 1}).find("`action.limit_rad`") != std::string::npos);
  CHECK(refused(Profile{}, {0, 0, 0, 0, 0, 0, 255}).find("`action.gripper`") != std::string::npos);
}

TEST_CASE("states come in every layout") {
  Proprioception measured;
  measured.tcp_in_base = {{0.1, 0.2, 0.3}, robot::from_rpy({0.1, 0.2, 0.3})};
  measured.openness = 0.75;
  measured.joints = {1, 2, 3, 4, 5, 6, 0.02, 0.03};
  measured.finger_joints = 2;
  Profile profile;
  const auto state = [&](StateLayout layout) {
    profile.state_layout = layout;
    const auto numbers = to_state(profile, measured);
    REQUIRE(numbers.ok());
    return *numbers;
  };
  CHECK(state(StateLayout::kNone).empty());
  const Quat q = measured.tcp_in_base.rotation;
  CHECK(state(StateLayout::kXyzWxyzOpenness) ==
        std::vector<double>{0.1, 0.2, 0.3, q.w(), q.x(), q.y(), q.z(), 0.75});
  const auto padded = state(StateLayout::kXyzRpyPadOpenness);
  REQUIRE(padded.size() == 8);
  CHECK(padded[3] == doctest::Approx(0.1));
  CHECK(padded[5] == doctest::Approx(0.3));
  CHECK(padded[6] == 0);
  CHECK(state(StateLayout::kXyzRpyOpenness).size() == 7);
  CHECK(state(StateLayout::kXyzXyzwClosedness) ==
        std::vector<double>{0.1, 0.2, 0.3, q.x(), q.y(), q.z(), q.w(), 0.25});
  CHECK(state(StateLayout::kClosedness) == std::vector<double>{0.25});
  CHECK(state(StateLayout::kXyzRotvecFingers).back() == 0.03);
  CHECK(state(StateLayout::kJoints) == measured.joints);
  CHECK(state(StateLayout::kJointsOpenness) == std::vector<double>{1, 2, 3, 4, 5, 6, 0.75});
  measured.joints.clear();
  profile.state_layout = StateLayout::kJointsOpenness;
  CHECK_FALSE(to_state(profile, measured).ok());
}

TEST_CASE("the joints that move fingers are as many as the robot has") {
  Proprioception measured;
  measured.joints = {1, 2, 3, 0.01, 0.02, 0.03};
  const auto state = [&](StateLayout layout, std::size_t fingers) {
    measured.finger_joints = fingers;
    Profile profile;
    profile.state_layout = layout;
    return to_state(profile, measured);
  };
  using Numbers = std::vector<double>;
  CHECK(state(StateLayout::kFingers, 1).value() == Numbers{0.03});
  CHECK(state(StateLayout::kFingers, 3).value() == Numbers{0.01, 0.02, 0.03});
  CHECK(state(StateLayout::kArmJoints, 1).value() == Numbers{1, 2, 3, 0.01, 0.02});
  CHECK(state(StateLayout::kArmJoints, 3).value() == Numbers{1, 2, 3});
  CHECK(state(StateLayout::kXyzRotvecFingers, 3).value().size() == 9);
  for (const StateLayout layout : {StateLayout::kFingers, StateLayout::kArmJoints,
                                   StateLayout::kJointsOpenness, StateLayout::kXyzRotvecFingers}) {
    const auto refused = state(layout, 0);
    REQUIRE(!refused.ok());
    CHECK(refused.failure().message.find("the robot has none") != std::string::npos);
  }
}

TEST_CASE("Bridge counts rotations from the tool pointing down") {
  Mat3 down;
  down << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  Proprioception measured;
  measured.tcp_in_base.rotation =
      Quat(Eigen::AngleAxisd(0.4, Vec3::UnitZ()).toRotationMatrix() * down);
  Profile profile;
  profile.state_layout = StateLayout::kXyzRpyOpenness;
  profile.state_frame = StateFrame::kTopDown;
  const auto state = to_state(profile, measured);
  REQUIRE(state.ok());
  CHECK((*state)[3] == doctest::Approx(0).epsilon(1e-9));
  CHECK((*state)[4] == doctest::Approx(0).epsilon(1e-9));
  CHECK((*state)[5] == doctest::Approx(0.4));
}

TEST_CASE("a normalised state is clipped and has as many numbers as the statistics") {
  Proprioception measured;
  measured.tcp_in_base.position = {0.5, 5, 0};
  Profile profile;
  profile.state_layout = StateLayout::kXyzRpyOpenness;
  profile.state_statistics = {Normalisation::kBound,
                              {0, 0, -1, -kPi, -kPi, -kPi, 0},
                              {1, 1, 1, kPi, kPi, kPi, 1},
                              {},
                              {},
                              {}};
  const auto state = to_state(profile, measured);
  REQUIRE(state.ok());
  CHECK(*state == std::vector<double>{0, 1, 0, 0, 0, 0, 1});
  profile.state_layout = StateLayout::kXyzRpyPadOpenness;
  CHECK(to_state(profile, measured).failure().message ==
        "the profile has statistics of 7 numbers, the state has 8");
}

TEST_CASE("prompts follow the profile's text rule") {
  Profile profile;
  CHECK(to_prompt(profile, "Put carrot on plate") == "Put carrot on plate");
  profile.prompt_case = PromptCase::kLower;
  profile.prompt_full_stop = FullStop::kWith;
  CHECK(to_prompt(profile, "Put carrot on plate") == "put carrot on plate.");
  profile.prompt_full_stop = FullStop::kWithout;
  CHECK(to_prompt(profile, "Put carrot on plate.") == "put carrot on plate");
}

TEST_CASE("however a profile writes an instruction, a stored run takes it for that one") {
  Profile profile;
  for (const auto& letters : words_of(PromptCase{})) {
    for (const auto& stop : words_of(FullStop{})) {
      profile.prompt_case = letters.value;
      profile.prompt_full_stop = stop.value;
      for (const char* prompt : {"Put Carrot on Plate.", "put Carrot on plate"}) {
        const Sha256 sent = sha256(to_prompt(profile, prompt));
        CHECK(policy::can_be_sent_as(prompt, to_hex(sent)));
      }
    }
  }
}

TEST_CASE("answers of every honest shape are actions, others say what was expected") {
  const std::vector<double> row{1, 2, 3, 4, 5, 6, 7};
  const wire::Array flat = wire::array_f64({7}, row);
  CHECK(to_actions(flat)->size() == 1);
  CHECK(to_actions(wire::array_f32({1, 1, 7}, row))->size() == 1);
  CHECK(to_actions(wire::List{flat, flat, flat})->size() == 3);
  CHECK(to_actions(wire::List{1, 2, 3, 4, 5, 6, 7})->front()[6] == 7);
  const auto wrong = to_actions(wire::array_f64({6}, {1, 2, 3, 4, 5, 6}));
  REQUIRE_FALSE(wrong.ok());
  CHECK(wrong.failure().message ==
        "expected actions of 7 numbers, an array 7 or N x 7; got an array 6 of <f8");
  CHECK_FALSE(to_actions(wire::Value("text")).ok());
  CHECK_FALSE(to_actions(wire::List{}).ok());
  CHECK_FALSE(to_actions(wire::array_f64({0, 7}, {})).ok());
  CHECK_FALSE(to_actions(wire::array_f64({2, 1, 7}, std::vector<double>(14))).ok());
  CHECK_FALSE(to_actions(wire::List{flat, wire::List{1, 2}}).ok());
  const auto infinite = to_actions(
      wire::array_f64({7}, {0, 0, std::numeric_limits<double>::quiet_NaN(), 0, 0, 0, 0}));
  REQUIRE_FALSE(infinite.ok());
  CHECK(infinite.failure().message == "number 3 of action 1 of 1 is not a number");
}

TEST_CASE("a server's text is shown by its last lines, on one and without control characters") {
  CHECK(last_lines("Traceback (most recent call last):\n  File \"a.py\", line 3\n    x = "
                   "o['k']\nKeyError: 'k'\n\n") ==
        "File \"a.py\", line 3 | x = o['k'] | KeyError: 'k'");
  CHECK(last_lines("").empty());
  CHECK(last_lines("a\x1b[2Jb\n") == "a [2Jb");
  CHECK(last_lines(std::string(10000, 'x')).size() == 303);  // with "..."
}

TEST_CASE("shares of a step are held to their range and scaled, in a box or in a ball") {
  Profile profile;
  profile.action_scale_m = 0.075;
  profile.action_scale_rad = 0.15;
  const RawAction raw{3, 0, 4, 0.5, -2, 0, 1};
  profile.action_units = ActionUnits::kBox;
  CHECK(denormalised(profile, raw) == RawAction{0.075, 0, 0.075, 0.5 * 0.15, -0.15, 0, 1});
  profile.action_units = ActionUnits::kBall;
  const RawAction ball = denormalised(profile, raw);
  CHECK(ball[0] == doctest::Approx(0.6 * 0.075));
  CHECK(ball[2] == doctest::Approx(0.8 * 0.075));
  CHECK(std::hypot(ball[3], ball[4]) == doctest::Approx(0.15));
  CHECK(ball[6] == 1);
}

TEST_CASE("a pose to be at becomes the change that brings the controller's target there") {
  Draws draws(7);
  const auto small = [&] { return 0.4 * draws.uniform() - 0.2; };
  for (const RotationForm form : {RotationForm::kEuler, RotationForm::kVector}) {
    Profile profile;
    profile.action_form = ActionForm::kAbsolute;
    profile.action_rotation = form;
    for (int i = 0; i < 100; ++i) {
      const Pose target{{0.3 + small(), small(), 0.2 + small()},
                        robot::from_rpy({7 * small(), 5 * small(), 7 * small()})};
      const Vec3 measured = target.position + Vec3(small(), small(), small()) / 10;
      const RawAction raw{0.3 + small(), small(), 0.2 + small(), 7 * small(), 5 * small(),
                          7 * small(),   1};
      const auto action = to_action(profile, raw, {target, measured});
      REQUIRE_MESSAGE(action.ok(), to_text(action.failure()));
      const Pose there =
          robot::moved_target(target, measured, {(*action)[0], (*action)[1], (*action)[2]},
                              {(*action)[3], (*action)[4], (*action)[5]});
      const Vec3 angles{raw[3], raw[4], raw[5]};
      const Pose wanted{{raw[0], raw[1], raw[2]},
                        form == RotationForm::kEuler ? robot::from_rpy(angles)
                                                     : robot::from_rotation_vector(angles)};
      CHECK(robot::pose_error(there, wanted).position < 1e-12);
      CHECK(robot::pose_error(there, wanted).rotation < 1e-7);
    }
  }
}

TEST_CASE("joints that are asked for become the change to the pose that they bring the tool to") {
  const robot::RobotModel model = robot::test::widowx();
  const auto chain = robot::Chain::create(model, "ee_gripper_link", robot::test::kArm);
  REQUIRE_MESSAGE(chain.ok(), to_text(chain.failure()));
  const std::vector<double> joints(robot::test::kTableStart.begin(),
                                   robot::test::kTableStart.begin() + 6);
  const Pose at = chain->pose(joints);
  Draws draws(3);
  for (int i = 0; i < 50; ++i) {
    RawAction steps, positions;
    for (const double joint : joints) {
      steps.push_back(0.4 * draws.uniform() - 0.2);
      positions.push_back(joint + steps.back());
    }
    const Pose wanted = chain->pose(positions);
    steps.push_back(1);
    positions.push_back(1);
    RawAction shares = steps;
    for (std::size_t k = 0; k < 6; ++k) shares[k] /= 0.2;
    // The arm lags behind what its controller aims at.
    const ArmNow arm{
        {at.position + Vec3(0.01, 0, -0.02), at.rotation}, at.position, joints, &*chain};
    Profile profile;
    const auto check = [&](ActionForm form, ActionUnits units, const RawAction& raw) {
      profile.action_form = form;
      profile.action_units = units;
      profile.action_scale_rad = units == ActionUnits::kBox ? 0.2 : 1;
      const auto action = to_action(profile, raw, arm);
      REQUIRE_MESSAGE(action.ok(), to_text(action.failure()));
      const policy::Action& a = *action;
      const Pose there = robot::moved_target(arm.target, arm.tool_measured, {a[0], a[1], a[2]},
                                             {a[3], a[4], a[5]});
      CHECK(robot::pose_error(there, wanted).position < 1e-12);
      CHECK(robot::pose_error(there, wanted).rotation < 1e-7);
      CHECK(a[6] == 1);
    };
    check(ActionForm::kJoints, ActionUnits::kMetric, positions);
    check(ActionForm::kJointSteps, ActionUnits::kMetric, steps);
    check(ActionForm::kJointSteps, ActionUnits::kBox, shares);
  }

  Profile profile;
  profile.action_form = ActionForm::kJoints;
  const ArmNow arm{at, at.position, joints, &*chain};
  const auto refused_of = [&](const RawAction& raw) {
    const auto action = to_action(profile, raw, arm);
    REQUIRE_FALSE(action.ok());
    return action.failure().message;
  };
  RawAction degrees = {-1.05, 2.3, 12.7, -0.3, 78.2, 0.1, 1};
  CHECK(refused_of(degrees).starts_with("joint 3 is to be at 12.7"));
  CHECK(refused_of(degrees).find("`action.form`") != std::string::npos);
  CHECK(refused_of({0, 0, 0, 0, 0, 0, 0, 1})
            .starts_with("an action of 7 joints and a gripper, for an arm of 6"));
  profile.action_statistics = {Normalisation::kBound, {0, 0}, {1, 1}, {}, {}, {}};
  CHECK(refused_of({0, 0, 0, 0, 0, 0, 1})
            .starts_with("the profile's statistics are of 2 numbers, an action has 7"));
}

TEST_CASE("states beside the first go under their own keys") {
  const auto droid = find_profile("openpi_droid");
  REQUIRE_MESSAGE(droid.ok(), to_text(droid.failure()));
  Profile profile = *droid;
  profile.images.resize(1);
  const std::vector<std::uint8_t> bytes(4 * 4 * 3, 9);
  Observation seen;
  seen.image = {4, 4, bytes};
  seen.proprioception.openness = 0.25;
  seen.proprioception.joints = {1, 2, 3, 4, 5, 6, 7, 0.02, 0.02};
  seen.proprioception.finger_joints = 2;
  const auto request = to_request(profile, seen);
  REQUIRE_MESSAGE(request.ok(), to_text(request.failure()));
  CHECK(request->state == std::vector<double>{1, 2, 3, 4, 5, 6, 7});
  CHECK(request->action_size == 8);  // seven joints and the gripper
  REQUIRE(request->more_states.size() == 1);
  CHECK(request->more_states[0].first == "observation/gripper_position");
  CHECK(request->more_states[0].second == std::vector<double>{0.75});
  profile.more_states[0].key = profile.state_key;
  CHECK(find_key_conflict(profile).has_value());
  CHECK(parse_profile(to_text(*droid), "again").value().more_states == droid->more_states);
}

TEST_CASE("joints go as they are to a robot that is told them, and nothing else does") {
  const robot::RobotModel model = robot::test::widowx();
  const auto chain = robot::Chain::create(model, "ee_gripper_link", robot::test::kArm);
  REQUIRE(chain.ok());
  robot::ActionSpace space{robot::ActionLayout::kJoints, robot::test::kArm,
                           std::vector<bool>(6, false)};
  const std::vector<double> joints(robot::test::kTableStart.begin(),
                                   robot::test::kTableStart.begin() + 6);
  ArmNow arm;
  arm.joints = joints;
  arm.chain = &*chain;
  arm.space = &space;
  Profile profile;
  profile.action_gripper = GripperRange::kUnit;
  const auto said = [&](ActionForm form, const RawAction& raw) {
    profile.action_form = form;
    return to_action(profile, raw, arm);
  };
  const RawAction raw = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 1};
  const auto positions = said(ActionForm::kJoints, raw);
  REQUIRE_MESSAGE(positions.ok(), to_text(positions.failure()));
  CHECK(*positions == policy::Action{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 1});
  CHECK(said(ActionForm::kJointSteps, raw).failure().message ==
        "the robot is told positions of its joints, and the actions are none (profile field "
        "`action.form`)");
  CHECK(said(ActionForm::kDelta, raw).failure().message.find("told positions") !=
        std::string::npos);
  CHECK(said(ActionForm::kJoints, {0.1, 0.2, 1}).failure().message ==
        "an action of 2 joints and a gripper, for an arm of 6 (profile field `action.form`)");
  CHECK(said(ActionForm::kJoints, {9, 0, 0, 0, 0, 0, 1}).failure().message.find("joint 1") == 0);

  space.layout = robot::ActionLayout::kJointSteps;
  const auto steps = said(ActionForm::kJointSteps, {0.01, 0, 0, 0, 0, -0.01, 0});
  REQUIRE_MESSAGE(steps.ok(), to_text(steps.failure()));
  CHECK(*steps == policy::Action{0.01, 0, 0, 0, 0, -0.01, -1});
  CHECK(said(ActionForm::kJoints, raw).failure().message.find("told steps") != std::string::npos);
}

TEST_CASE("each control law takes the forms that it can carry out") {
  using robot::ControlKind;
  const auto takes = [](ActionForm form, ControlKind control) {
    return check_form(Profile{}, form, control, "server").ok();
  };
  for (const ActionForm form : {ActionForm::kDelta, ActionForm::kAbsolute, ActionForm::kJoints,
                                ActionForm::kJointSteps, ActionForm::kUnsaid}) {
    const bool is_unsaid = form == ActionForm::kUnsaid;
    CHECK(takes(form, ControlKind::kEeDeltaPose));
    CHECK(takes(form, ControlKind::kOscPose) == (is_unsaid || form == ActionForm::kDelta));
    CHECK(takes(form, ControlKind::kJointDelta) == (is_unsaid || form == ActionForm::kJointSteps));
    CHECK(takes(form, ControlKind::kJointPosition) == (is_unsaid || form == ActionForm::kJoints));
  }
  Profile profile;
  profile.name = "mine";
  CHECK(check_form(profile, ActionForm::kDelta, ControlKind::kJointPosition, "server")
            .failure()
            .message ==
        "actions of profile `mine` are `delta` (`action.form`), and a robot of the run is "
        "controlled by `joint_position`, which takes positions of the arm's joints alone "
        "(`action.form = joints`)");
}

}  // namespace probe::servers
