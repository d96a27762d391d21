// The openpi client against a server of the same rules, byte by byte and by what it does.
#include "runtime/servers/protocol.h"

#include <doctest/doctest.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "runtime/base/sha256.h"
#include "runtime/robot/kinematics.h"
#include "runtime/robot/robot.h"
#include "runtime/run/policies.h"
#include "runtime/servers/server_policy.h"
#include "runtime/servers/servers.h"
#include "runtime/servers/shared_model.h"
#include "runtime/wire/msgpack.h"
#include "tests/runtime/robot/test_robots.h"
#include "tests/runtime/servers/asking.h"
#include "tests/servers/python_server.h"

namespace probe::servers {
using namespace probe::run;
using namespace probe::policy;
namespace {

using test::PythonServer;

double first_number(Policy& policy, const Observation& seen) { return must_act(policy, seen)[0]; }

std::string hex(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

}  // namespace

TEST_CASE("openpi's request has its keys in order and its arrays with keys of bytes") {
  const ServerRecord record;
  const PythonServer server("openpi_server.py", {"openpi", record.option()});
  const auto policy = policy_at("openpi", server);
  must_begin(*policy);
  AskingPicture picture;
  CHECK(first_number(*policy, picture.observation()) == 0);
  const auto lines = record.lines();
  REQUIRE(lines.size() == 1);
  const std::string array_begin = "84c40b" + hex("__ndarray__") + "c3c404" + hex("data");
  const std::string u1 = "c405" + hex("dtype") + "a3" + hex("|u1") + "c405" + hex("shape");
  const std::string f4 = "c405" + hex("dtype") + "a3" + hex("<f4") + "c405" + hex("shape");
  std::string pixels;
  for (std::size_t i = 0; i < picture.bytes.size(); ++i) pixels += "07";
  // The pose of an observation without one: the identity, open.
  const std::string state =
      "000000000000000000000000"
      "0000803f"
      "000000000000000000000000"
      "0000803f";
  CHECK(lines[0] == "83b1" + hex("observation/image") + array_begin + "c490" + pixels + u1 +
                        "93060803" + "b1" + hex("observation/state") + array_begin + "c420" +
                        state + f4 + "9108" + "a6" + hex("prompt") + "b3" +
                        hex("put carrot on plate"));
}

TEST_CASE("a chunk is done without asking again, and the first request is proved") {
  const PythonServer server("openpi_server.py", {"openpi", "chunk=4"});
  const auto policy = policy_at("openpi", server);
  QueryMeter meter;
  must_begin(*policy);
  CHECK_FALSE(policy->delivery().has_value());
  AskingPicture picture;
  for (int step = 0; step < 6; ++step) {
    picture.bytes[0] = static_cast<std::uint8_t>(step);
    CHECK(first_number(*policy, picture.observation(step)) == step / 1000.0);
  }
  picture.bytes[0] = 0;
  REQUIRE(policy->delivery().has_value());
  CHECK(policy->delivery()->image_sha256 ==
        to_hex(sha256(std::as_bytes(std::span(picture.bytes)))));
  CHECK(policy->delivery()->prompt_sha256 == to_hex(sha256("put carrot on plate")));
  policy->end({true, true, 6});
  must_begin(*policy);  // what was left of the chunk is forgotten
  CHECK(first_number(*policy, picture.observation()) == 8 / 1000.0);
}

TEST_CASE(
    "openpi's policies for LIBERO get two pictures, and shares of a step are 5 cm and 0.5 rad") {
  const PythonServer server("openpi_server.py", {"libero", "seen=normalised", "chunk=5"});
  const auto policy = policy_at("openpi", server, "&profile=openpi_libero");
  must_begin(*policy);
  AskingPicture picture, wrist;
  wrist.bytes[0] = 9;
  Observation seen = picture.observation();
  const Image beside = wrist.observation().image;
  const CameraImage cameras[] = {{"front", seen.image}, {"wrist", beside}};
  seen.cameras = cameras;
  seen.proprioception.joints = {1, 2, 3, 4, 5, 6, 7, 0.02, 0.02};
  seen.proprioception.finger_joints = 2;
  const Action action = must_act(*policy, seen);
  double farthest = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const double most = i < 3 ? 0.05 : 0.5;
    CHECK(std::abs(action[i]) <= most);
    farthest = std::max(farthest, std::abs(action[i]) / most);
  }
  CHECK(farthest > 0.3);
  CHECK(action[6] == -1);  // there +1 is closed
}

TEST_CASE("INT-ACT hears the model first, infers, and a reset before and after each episode") {
  const ServerRecord record;
  const PythonServer server("openpi_server.py", {"intact", record.option()});
  const auto policy = policy_at("intact", server, "&model=/m");
  AskingPicture picture;
  for (int episode = 0; episode < 2; ++episode) {
    must_begin(*policy);
    CHECK(first_number(*policy, picture.observation()) == 0);
    CHECK(first_number(*policy, picture.observation(1)) == 1 / 1000.0);
    policy->end({true, false, 2});
  }
  const auto lines = record.lines();
  REQUIRE(lines.size() == 9);
  CHECK(lines[0] == "81ae6e65775f6d6f64656c5f70617468a22f6d");
  for (const std::size_t reset : {1u, 4u, 5u, 8u}) CHECK(lines[reset] == "81a57265736574c3");
  CHECK(lines[2].find("b1" + hex("observation.state") + "81a5" + hex("agent") + "81a7" +
                      hex("eef_pos") + "84c40b") != std::string::npos);
  CHECK(lines[2].find("a4" + hex("task") + "b3") != std::string::npos);
}

TEST_CASE("an episode after one that was killed is not done with the killed one's instruction") {
  AskingPicture picture;
  Observation carrot = picture.observation(), spoon = carrot;
  spoon.prompt = "put the spoon on the towel";
  Action fresh;
  {
    const PythonServer server("openpi_server.py", {"intact", "seen=keeps"});
    const auto policy = policy_at("intact", server, "&model=/m");
    must_begin(*policy);
    const Action action = must_act(*policy, spoon);
    fresh = action;
  }
  const PythonServer server("openpi_server.py", {"intact", "seen=keeps"});
  {
    const auto killed = policy_at("intact", server, "&model=/m");
    must_begin(*killed);
    const Action action = must_act(*killed, carrot);
    CHECK(action != fresh);
  }  // without an end: the process is gone
  const auto policy = policy_at("intact", server, "&model=/m");
  must_begin(*policy);
  const Action action = must_act(*policy, spoon);
  CHECK(action == fresh);
}

TEST_CASE("INT-ACT's chunks are bare arrays") {
  const PythonServer server("openpi_server.py", {"intact", "chunk=4"});
  const auto policy = policy_at("intact", server, "&model=/m&profile=pi0_bridge");
  must_begin(*policy);
  AskingPicture picture;
  for (int step = 0; step < 5; ++step) {
    CHECK(first_number(*policy, picture.observation(step)) == step / 1000.0);
  }
  CHECK(make_policy("intact://localhost:1").failure().message.find("?model=PATH") !=
        std::string::npos);
}

TEST_CASE(
    "RoboArena's server says what it wants, and hears a reset before and after each episode") {
  const ServerRecord record;
  const PythonServer server("openpi_server.py", {"roboarena", record.option()});
  const auto policy = policy_at("roboarena", server);
  AskingPicture picture;
  for (int episode = 0; episode < 2; ++episode) {
    must_begin(*policy);
    CHECK(first_number(*policy, picture.observation()) == 0);
    // A share of 0.075 m.
    CHECK(first_number(*policy, picture.observation(1)) == 1 / 1000.0 * 0.075);
    policy->end({true, false, 2});
  }
  std::string said;
  std::set<std::string> sessions;
  for (const std::string& line : record.lines()) {
    const bool is_reset = line.find(hex("endpoint") + "a5" + hex("reset")) != std::string::npos;
    said += is_reset ? "reset " : "infer ";
    const std::size_t key = line.find("aa" + hex("session_id"));
    REQUIRE(key != std::string::npos);
    sessions.insert(line.substr(key + 22, 60));
  }
  CHECK(said == "reset infer infer reset reset infer infer reset ");
  CHECK(sessions.size() == 2);
}

TEST_CASE("what RoboArena's server calls its actions is what is done with them") {
  const auto with_space = [](const std::string& space) {
    return "meta={\"image_resolution\": [224, 224], \"needs_wrist_camera\": false, "
           "\"needs_session_id\": true" +
           space + "}";
  };
  AskingPicture picture;
  Observation seen = picture.observation();
  seen.proprioception.tcp_in_base.position = {0.3, 0.05, 0.14};
  const auto act = [&](const std::string& habit, const std::string& space,
                       const EpisodeStart& start) {
    const PythonServer server("openpi_server.py",
                              {"roboarena", "seen=" + habit, with_space(space)});
    const auto policy = policy_at("roboarena", server);
    if (start.robot != nullptr) {
      CHECK(policy->begin(asking_start()).failure().message ==
            "actions of joints need a robot, and there is none");
    }
    const auto begun = policy->begin(start);
    REQUIRE_MESSAGE(begun.ok(), to_text(begun.failure()));
    return must_act(*policy, seen);
  };
  const auto shift_of = [](const Action& a) {
    return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  };
  const Action posed = act("poses", ", \"action_space\": \"cartesian_position\"", asking_start());
  // 2 cm around where the tool is, not 33 cm away.
  for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(posed[i]) <= 0.021);
  CHECK(shift_of(act("normalised", ", \"action_space\": \"cartesian_velocity\"", asking_start())) <=
        0.075 + 1e-9);
  // Joints, which are what a server means that says nothing, go through the robot's kinematics.
  const robot::RobotModel model = robot::test::widowx();
  robot::Robot widowx;
  widowx.model = &model;
  widowx.control = {"ee_gripper_link", robot::test::kArm, robot::test::kFingers};
  const auto chain = robot::Chain::create(model, "ee_gripper_link", robot::test::kArm);
  REQUIRE_MESSAGE(chain.ok(), to_text(chain.failure()));
  seen.proprioception.joints = robot::test::kTableStart;
  seen.proprioception.finger_joints = 2;
  seen.proprioception.tcp_in_base = chain->pose(std::span(robot::test::kTableStart).first(6));
  EpisodeStart with_robot = asking_start();
  with_robot.robot = &widowx;
  for (const char* space :
       {"", ", \"action_space\": \"joint_position\"", ", \"action_space\": \"joint_velocity\""}) {
    CAPTURE(std::string(space));
    const bool are_positions = std::string(space).find("velocity") == std::string::npos;
    // A hundredth of a radian, or a fifth, in each of six joints of an arm of 70 cm.
    const double farthest = are_positions ? 0.05 : 0.7;
    const double shift = shift_of(act(are_positions ? "joints" : "normalised", space, with_robot));
    CHECK(shift > 0);
    CHECK(shift < farthest);
  }
  const PythonServer velocities(
      "openpi_server.py", {"roboarena", with_space(", \"action_space\": \"joint_velocity\"")});
  CHECK(policy_at("roboarena", velocities, "&action.form=delta")
            ->begin(with_robot)
            .failure()
            .message ==
        "the server's `action_space` is joint_velocity, and the profile's `action.form` is of "
        "another");
  CHECK(policy_at("roboarena", velocities, "&action.units=ball")
            ->begin(with_robot)
            .failure()
            .message == "`action.units = ball` is of shifts and turns, not of joints");
  const PythonServer server("openpi_server.py",
                            {"roboarena", with_space(", \"action_space\": \"torque\"")});
  const auto begun = policy_at("roboarena", server)->begin(asking_start());
  REQUIRE_FALSE(begun.ok());
  CHECK(begun.failure().code == Fault::kUsage);
  CHECK(begun.failure().message.find("\"torque\"") != std::string::npos);
}

TEST_CASE("a traceback is shown by its last lines, and the next episode connects again") {
  const PythonServer server("openpi_server.py", {"openpi"});
  const auto policy = policy_at("openpi", server, "&state.layout=none");
  must_begin(*policy);
  AskingPicture picture;
  const auto action = policy->act(picture.observation());
  REQUIRE_FALSE(action.ok());
  CHECK(action.failure().where == "127.0.0.1:" + server.port());
  CHECK(action.failure().message.find("the server failed: ") == 0);
  CHECK(action.failure().message.find("AssertionError: {'") != std::string::npos);
  CHECK_FALSE(policy->act(picture.observation(1)).ok());
  policy->end({false, false, 0});
  must_begin(*policy);
}

TEST_CASE("a server that is not there is tried for as long as the profile says") {
  std::string port;
  {
    const PythonServer server("openpi_server.py", {"openpi"});
    port = server.port();
  }
  auto policy = make_policy("openpi://127.0.0.1:" + port + "?timeout.wait_s=0.4");
  REQUIRE(policy.ok());
  const auto begun = (*policy)->begin(asking_start());
  REQUIRE_FALSE(begun.ok());
  CHECK(begun.failure().message.find("Connection refused") != std::string::npos);
  CHECK(begun.failure().message.find("(tried 3 times)") != std::string::npos);
}

TEST_CASE("a server that answers connecting with an error is told at once") {
  const PythonServer server("openpi_server.py", {"intact", "lacks=/nowhere"});
  // Trying again would take 100 s.
  auto made_here =
      make_policy("intact://127.0.0.1:" + server.port() + "?model=/nowhere&timeout.wait_s=100");
  REQUIRE_MESSAGE(made_here.ok(), to_text(made_here.failure()));
  const auto policy = std::move(made_here).value();
  const auto before = std::chrono::steady_clock::now();
  const auto begun = policy->begin(asking_start());
  REQUIRE_FALSE(begun.ok());
  CHECK(begun.failure().code == Fault::kPolicy);
  CHECK(begun.failure().message.find("FileNotFoundError: /nowhere") != std::string::npos);
  CHECK(begun.failure().message.find("tried") == std::string::npos);
  CHECK(std::chrono::steady_clock::now() - before < std::chrono::seconds(20));
}

TEST_CASE("the connections of a run have an INT-ACT server load its model once") {
  const ServerRecord record;
  const PythonServer server("openpi_server.py", {"intact", record.option()});
  PolicyContext context;
  context.model = std::make_shared<SharedModel>();
  const std::string address = "intact://127.0.0.1:" + server.port() + "?model=/m";
  AskingPicture picture;
  for (int world = 0; world < 3; ++world) {
    const auto policy = make_policy(address, context);
    REQUIRE_MESSAGE(policy.ok(), to_text(policy.failure()));
    must_begin(**policy);
    first_number(**policy, picture.observation());
  }
  int loads = 0;
  for (const std::string& line : record.lines()) loads += line.find(hex("new_model_path")) == 4;
  CHECK(loads == 1);
}

TEST_CASE("why an INT-ACT server could not load its model is said with every later failure") {
  const ServerRecord record;
  const PythonServer server("openpi_server.py", {"intact", "lacks=/nowhere", record.option()});
  PolicyContext context;
  context.model = std::make_shared<SharedModel>();
  for (int world = 0; world < 3; ++world) {
    const auto policy =
        make_policy("intact://127.0.0.1:" + server.port() + "?model=/nowhere", context);
    REQUIRE_MESSAGE(policy.ok(), to_text(policy.failure()));
    const auto begun = (*policy)->begin(asking_start());
    REQUIRE_FALSE(begun.ok());
    CHECK(begun.failure().message.find("FileNotFoundError: /nowhere") != std::string::npos);
  }
  CHECK(record.lines().size() == 1);
}

TEST_CASE("an INT-ACT server that was restarted is told its model again") {
  const ServerRecord record;
  auto server = std::make_unique<PythonServer>("openpi_server.py",
                                               std::vector<std::string>{"intact", record.option()});
  PolicyContext context;
  context.model = std::make_shared<SharedModel>();
  const std::string port = server->port();
  const auto policy = make_policy("intact://127.0.0.1:" + port + "?model=/m", context);
  REQUIRE_MESSAGE(policy.ok(), to_text(policy.failure()));
  AskingPicture picture;
  must_begin(**policy);
  server->stop();
  CHECK_FALSE((*policy)->act(picture.observation()).ok());
  (*policy)->end({false, false, 0});
  server = std::make_unique<PythonServer>(
      "openpi_server.py", std::vector<std::string>{"intact", record.option(), "port=" + port});
  must_begin(**policy);
  CHECK(first_number(**policy, picture.observation()) == 0);
  std::string said;
  for (const std::string& line : record.lines()) {
    said += line.find(hex("new_model_path")) == 4 ? "model " : line.size() < 30 ? "reset " : "ask ";
  }
  // The first reset after the restart is refused.
  CHECK(said == "model reset reset model reset ask ");
}

TEST_CASE("a request in which two things have one key is not sent") {
  Profile profile;
  profile.images = {{"", "prompt"}};
  for (const Protocol protocol : {Protocol::kOpenpi, Protocol::kRoboArena}) {
    auto transport = row_of(protocol).make(profile, {});
    REQUIRE(transport.ok());
    Request request;
    request.images.push_back({"prompt", wire::array_u8({1, 1, 3}, {1, 2, 3})});
    const auto answer = (*transport)->ask(request, {});
    REQUIRE_FALSE(answer.ok());
    CHECK(answer.failure().message ==
          "the request has the key `prompt` twice: one of the two would not arrive");
  }
  const wire::Value nested =
      wire::Map{{"a", wire::Map{{"x", 1}, {"x", 2}}}, {"b", wire::Map{{"x", 1}}}};
  CHECK_FALSE(check_distinct_keys(nested).ok());
  CHECK(check_distinct_keys(wire::Map{{"x", 1}, {"b", wire::Map{{"x", 1}}}}).ok());
}

TEST_CASE("a restarted server is found again at the next episode") {
  auto server =
      std::make_unique<PythonServer>("openpi_server.py", std::vector<std::string>{"openpi"});
  const auto policy = policy_at("openpi", *server);
  must_begin(*policy);
  AskingPicture picture;
  first_number(*policy, picture.observation());
  server->stop();
  CHECK_FALSE(policy->act(picture.observation(1)).ok());
  policy->end({false, false, 1});
  CHECK_FALSE(policy->begin(asking_start()).ok());
}

TEST_CASE("the key comes from the environment and is in no message") {
  const PythonServer server("openpi_server.py", {"openpi", "key=sesame-7"});
  // Long before the time to connect is over: declined is declined.
  const auto without = policy_at("openpi", server, "&timeout.connect_s=600");
  const auto refused = without->begin(asking_start());
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().message.find("/healthz says OK") != std::string::npos);
  setenv("VLAPROBE_API_KEY", "wrong-key-9", 1);
  const auto wrong = policy_at("openpi", server)->begin(asking_start());
  REQUIRE_FALSE(wrong.ok());
  CHECK(to_text(wrong.failure()).find("wrong-key-9") == std::string::npos);
  setenv("VLAPROBE_API_KEY", "sesame-7", 1);
  const auto policy = policy_at("openpi", server);
  must_begin(*policy);
  AskingPicture picture;
  first_number(*policy, picture.observation());
  unsetenv("VLAPROBE_API_KEY");
}

TEST_CASE("a camera that the scene does not have is named with those that it has") {
  const PythonServer server("openpi_server.py", {"openpi"});
  const auto policy = policy_at("openpi", server, "&image=wrist%20-%3E%20observation/image");
  must_begin(*policy);
  AskingPicture picture;
  Observation seen = picture.observation();
  const CameraImage cameras[] = {{"base", seen.image}, {"side", seen.image}};
  seen.cameras = cameras;
  CHECK(policy->act(seen).failure().message ==
        "the profile wants camera `wrist`, the scene has `base`, `side`");
}

}  // namespace probe::servers
