// vla-eval's messages byte by byte, and its client against a server of the same rules.
#include "runtime/base/json.h"
#include "runtime/servers/protocols/vlaeval_messages.h"

#include <doctest/doctest.h>

#include "runtime/robot/control.h"
#include "runtime/robot/rotation.h"
#include "runtime/scene/image.h"
#include "runtime/servers/servers.h"
#include "tests/hex.h"
#include "tests/runtime/servers/asking.h"

namespace probe::servers {
using namespace probe::policy;
namespace {

using json = probe::Json;

using test::PythonServer;

Request request_of(std::int64_t height, std::int64_t width, wire::Bytes pixels) {
  Request request;
  request.prompt = "put carrot on plate";
  request.images.push_back({"primary", wire::array_u8({height, width, 3}, std::move(pixels))});
  return request;
}

Profile simpler_profile() {
  Profile profile;
  profile.prompt_key = "task_description";
  profile.state_key = "states";
  return profile;
}

// The transport alone, opened against a server whose hello asks for `params`.
std::unique_ptr<Transport> opened(const PythonServer& server, const std::string& options = "") {
  auto choice = choose_server(Protocol::kVlaEval, "//127.0.0.1:" + server.port() + options);
  REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
  auto transport = make_transport(*choice);
  REQUIRE(transport.ok());
  const auto open = (*transport)->open({});
  REQUIRE_MESSAGE(open.ok(), to_text(open.failure()));
  return std::move(transport).value();
}

}  // namespace

TEST_CASE("a vla-eval observation has the bytes that Python's client sends") {
  const auto payload = vlaeval::observation(simpler_profile(), request_of(1, 2, {0, 1, 2, 3, 4, 5}),
                                            "t", vlaeval::PictureCoding::kRaw, false);
  REQUIRE(payload.ok());
  // msgpack.packb(..., default=encode_ndarray, use_bin_type=True) of the same, python3-msgpack
  // 1.0.3.
  CHECK(
      vlaeval::to_bytes({"observation", *payload, 3}, 1.5) ==
      test::from_hex(
          "84a474797065ab6f62736572766174696f6ea77061796c6f616483a6696d6167657381a77072696d61727984"
          "ab5f5f6e6461727261795f5fc3a464617461c406000102030405a56474797065a37c7531a573686170659301"
          "0203b07461736b5f6465736372697074696f6eb370757420636172726f74206f6e20706c617465a97461736b"
          "5f6e616d65a174a373657103a974696d657374616d70cb3ff8000000000000"));
}

TEST_CASE("a picture as PNG is the picture, as JPEG nearly, and says its shape") {
  wire::Bytes pixels;
  for (int i = 0; i < 16 * 8 * 3; ++i) pixels.push_back(static_cast<std::uint8_t>(i / 3));
  for (const auto coding : {vlaeval::PictureCoding::kPng, vlaeval::PictureCoding::kJpeg}) {
    const bool is_png = coding == vlaeval::PictureCoding::kPng;
    const auto payload =
        vlaeval::observation(simpler_profile(), request_of(8, 16, pixels), "t", coding, false);
    REQUIRE(payload.ok());
    const wire::Value& picture = *payload->find("images")->find("primary");
    CHECK(*picture.find("__image__") == wire::Value(true));
    CHECK(*picture.find("format") == wire::Value(is_png ? "png" : "jpeg"));
    CHECK(*picture.find("shape") == wire::Value(wire::List{8, 16, 3}));
    const auto decoded =
        scene::decode_image(std::as_bytes(std::span(*picture.find("data")->as<wire::Bytes>())), "");
    REQUIRE(decoded.ok());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const int difference = decoded->rgba[i / 3 * 4 + i % 3] - pixels[i];
      CHECK(std::abs(difference) <= (is_png ? 0 : 12));
    }
  }
}

TEST_CASE("a vla-eval message without one of its fields is refused with what it has") {
  const wire::Bytes whole = vlaeval::to_bytes({"action", wire::Map{{"actions", 1}}, 7}, 0);
  const auto read = vlaeval::from_bytes(whole);
  REQUIRE(read.ok());
  CHECK(read->type == "action");
  CHECK(read->seq == 7);
  CHECK(vlaeval::from_bytes(vlaeval::to_bytes({"action", "text", 7}, 0)).failure().message ==
        "expected a map with `type`, `payload` and `seq`, got a map with keys type, payload, seq, "
        "timestamp");
}

TEST_CASE("a vla-eval episode is announced, asked and ended") {
  const ServerRecord record;
  const PythonServer server("vlaeval_server.py",
                            {record.option(), "bridge=1", R"(params={"send_state": true})"});
  const auto policy = policy_at("vlaeval", server);
  AskingPicture picture;
  must_begin(*policy);
  CHECK(must_act(*policy, picture.observation(0)) == Action{0, 0, 0, 0, 0, 0, 1});
  CHECK(must_act(*policy, picture.observation(1))[0] == 0.001);
  policy->end({.completed = true, .success = true, .steps = 2});
  // The next episode's answer shows that the server has read all that went before.
  must_begin(*policy);
  CHECK(must_act(*policy, picture.observation(0))[0] == 0);
  std::vector<json> said;
  for (const std::string& line : record.lines()) said.push_back(json::parse(line));
  REQUIRE(said.size() == 7);
  CHECK(said[0]["type"] == "hello");
  CHECK(said[0]["keys"] == json{"benchmark", "harness_version", "protocol_version"});
  CHECK(said[1]["payload"]["task"]["name"] == "carrot_on_plate");
  CHECK(said[2]["images"]["primary"] == json{6, 8, 3});
  CHECK(said[2]["state"] == json{0, 0, 0, 1, 0, 0, 0, 1});
  CHECK(said[2]["keys"] ==
        json{"base_pose", "images", "states", "task_description", "task_name", "tcp_pose"});
  CHECK(said[4]["type"] == "episode_end");
  CHECK(said[4]["payload"]["metrics"]["success"] == true);
  CHECK(said[4]["payload"]["steps"] == 2);
}

TEST_CASE("a state goes only to who asks, or where the user says so; pictures in three forms") {
  const ServerRecord record;
  const PythonServer server("vlaeval_server.py", {record.option()});
  AskingPicture picture;
  for (const char* options : {"", "&pictures=png", "&pictures=jpeg", "&send_state=true"}) {
    const auto policy = policy_at("vlaeval", server, options);
    must_begin(*policy);
    must_act(*policy, picture.observation());
  }
  std::vector<json> seen;
  for (const std::string& line : record.lines()) {
    const json said = json::parse(line);
    if (said["type"] == "observation") seen.push_back(said);
  }
  REQUIRE(seen.size() == 4);
  for (std::size_t i = 0; i < 3; ++i) CHECK(seen[i]["state"].is_null());
  CHECK(seen[3]["state"].size() == 8);
  CHECK(make_policy("vlaeval://h?pictures=gif").failure().message ==
        "`pictures` is raw, png or jpeg, not `gif`");
}

TEST_CASE("what a vla-eval server wishes is done or said") {
  const PythonServer server(
      "vlaeval_server.py",
      {R"(params={"send_state": true, "send_wrist_image": true, "max_episode_steps": 120, )"
       R"("success_mode": "early_stop", "deterministic_episodes": true, "quat_no_antipodal": true, )"
       R"("control_mode": "arm_pd_ee_target_delta_pose_align2_gripper_pd_joint_pos", )"
       R"("env_seed": 0, "camera_fps": 30})"});
  const auto transport = opened(server);
  const auto notes = transport->notes();
  REQUIRE(notes.size() == 5);
  CHECK(notes[0] ==
        "the server asks for send_wrist_image = true: none is sent; a line `image = CAMERA -> "
        "wrist` of a profile would");
  CHECK(notes[1] ==
        "the server asks for max_episode_steps = the number 120: episodes are as long as the plan "
        "says");
  CHECK(notes[2].starts_with("the server asks for success_mode = the text \"early_stop\": "));
  CHECK(notes[3] ==
        "the server asks for env_seed = the number 0: the plan fixes where things start");
  CHECK(notes[4] == "the server asks for camera_fps = the number 30: vlaprobe does not know it");
  CHECK(opened(server, "?send_state=false")->notes()[0] ==
        "the server asks for send_state = true: it is not sent, because `send_state` says so");
  const PythonServer plain("vlaeval_server.py");
  CHECK(opened(plain)->notes().empty());
}

TEST_CASE("a vla-eval server that answers poses has the arm go to them") {
  // X-VLA's hello: its control mode is of poses though its action_spec says otherwise.
  const PythonServer server(
      "vlaeval_server.py",
      {R"(params={"control_mode": "arm_pd_ee_target_base_pose_gripper_pd_joint_pos"})",
       R"(spec={"position": {"format": "delta_xyz"}, "rotation": {"format": "axis_angle"}})",
       "pose=[0.31, 0.02, 0.15, 0.2, -0.1, 0.3, 1]"});
  const auto policy = policy_at("vlaeval", server);
  AskingPicture picture;
  Observation seen = picture.observation();
  seen.proprioception.tcp_in_base.position = {0.3, 0.0, 0.14};
  must_begin(*policy);
  const Quat wanted = robot::from_rpy({0.2, -0.1, 0.3});
  Pose target = seen.proprioception.tcp_in_base;
  for (int step = 0; step < 3; ++step) {
    const Action a = must_act(*policy, seen);
    target = robot::moved_target(target, seen.proprioception.tcp_in_base.position,
                                 {a[0], a[1], a[2]}, {a[3], a[4], a[5]});
    CHECK((target.position - Vec3(0.31, 0.02, 0.15)).norm() < 1e-12);
    CHECK(robot::pose_error(target, {target.position, wanted}).rotation < 1e-7);
    CHECK(a[6] == 1);
    // The arm lags behind its target.
    seen.proprioception.tcp_in_base.position += Vec3(0.002, 0.001, 0.001);
  }
}

TEST_CASE(
    "what a vla-eval server wants of its actions is done or refused, and its words are said") {
  const auto refusal = [](const std::string& hello) {
    const PythonServer server("vlaeval_server.py", {hello});
    const auto policy = policy_at("vlaeval", server);
    const auto begun = policy->begin(asking_start());
    REQUIRE_FALSE(begun.ok());
    CHECK(begun.failure().code == Fault::kUsage);
    return begun.failure().message;
  };
  CHECK(refusal(R"(params={"control_mode": "pd_joint_delta_pos"})") ==
        "the server asks for control_mode = pd_joint_delta_pos, which is not done here");
  CHECK(refusal(R"(params={"gripper_mode": "sticky"})") ==
        "the server asks for gripper_mode = sticky, which is not done here");
  CHECK(refusal(R"(spec={"position": {"format": "joint_positions"}})") ==
        "the server asks for a position in the form = joint_positions, which is not done here");
  CHECK(refusal(R"(spec={"rotation": {"format": "rot6d_interleaved"}})") ==
        "the server asks for a rotation in the form = rot6d_interleaved, which is not done here");
  CHECK(refusal(R"(params={"image_history": 2})") ==
        "the server asks for image_history = the number 2, which is not done here");
  CHECK(refusal(R"(params={"send_wrist_image": true})")
            .find("`?send_wrist_image=false` runs "
                  "without") != std::string::npos);
  CHECK(refusal(R"(spec={"joints": {"format": "joint_delta_pos"}})") ==
        "the server asks for an action_spec with = joints, which is not done here");
  CHECK(refusal(R"(spec={"gripper": {"format": "binary_close_positive"}})")
            .find("the profile reads it the other way round") != std::string::npos);
  const PythonServer torn("vlaeval_server.py", {R"(params={"absolute_action": true})",
                                                R"(spec={"position": {"format": "delta_xyz"}})"});
  const auto unclear = policy_at("vlaeval", torn)->begin(asking_start());
  REQUIRE_FALSE(unclear.ok());
  CHECK(unclear.failure().message.find("say `action.form = absolute` or `delta`") !=
        std::string::npos);
  CHECK(policy_at("vlaeval", torn, "&action.form=absolute&action.rotation=vector")
            ->begin(asking_start())
            .ok());
  const PythonServer server("vlaeval_server.py",
                            {R"(spec={"position": {"format": "absolute_xyz"}, )"
                             R"("rotation": {"format": "euler_xyz"}})"});
  Profile adapted;
  adapted.images = {{"", "primary"}};
  REQUIRE(opened(server)->adapt(adapted).ok());
  CHECK(adapted.action_form == ActionForm::kAbsolute);
  CHECK(adapted.action_rotation == RotationForm::kEuler);
  const PythonServer euler("vlaeval_server.py", {R"(spec={"position": {"format": "delta_xyz"}, )"
                                                 R"("rotation": {"format": "euler_xyz"}})"});
  Profile as_published;
  as_published.images = {{"", "primary"}};
  const auto transport = opened(euler);
  // Which of the two is meant the profile must say.
  const auto unsaid = transport->adapt(as_published);
  REQUIRE_FALSE(unsaid.ok());
  CHECK(unsaid.failure().message.find("say `action.rotation = vector`, as published") !=
        std::string::npos);
  as_published.action_form = ActionForm::kUnsaid;
  as_published.action_rotation = RotationForm::kVector;
  REQUIRE(transport->adapt(as_published).ok());
  CHECK(as_published.action_form == ActionForm::kDelta);
  CHECK(as_published.action_rotation == RotationForm::kVector);
  REQUIRE(transport->notes().size() == 1);
  CHECK(transport->notes()[0].find("as vla-eval's own benchmark does") != std::string::npos);
}

TEST_CASE("another version of vla-eval's protocol is refused at once") {
  const PythonServer server("vlaeval_server.py", {"version=2"});
  const auto policy = policy_at("vlaeval", server);
  const auto begun = policy->begin(asking_start());
  REQUIRE_FALSE(begun.ok());
  CHECK(begun.failure().code == Fault::kUsage);
  CHECK(to_text(begun.failure()) ==
        "127.0.0.1:" + server.port() +
            ": the server's `protocol_version` is the number 2, vlaprobe speaks 1");
}

TEST_CASE("a server that gathers batches is told how many, and one that does not is refused") {
  AskingPicture picture;
  {
    const ServerRecord record;
    const PythonServer server("vlaeval_server.py", {"gathers=8", record.option()});
    const auto policy = policy_at("vlaeval", server, "&batch=8&batch_wait_ms=20");
    must_begin(*policy);
    must_act(*policy, picture.observation());
    const auto lines = record.lines();
    REQUIRE(!lines.empty());
    CHECK(lines[0].find("\"max_batch_size\": 8, \"max_wait_time\": 0.02") != std::string::npos);
  }
  for (const char* gathers : {"gathers=4", "version=1"}) {
    const PythonServer server("vlaeval_server.py", {gathers});
    const auto policy = policy_at("vlaeval", server, "&batch=8");
    const auto begun = policy->begin(asking_start());
    REQUIRE_FALSE(begun.ok());
    CHECK(begun.failure().code == Fault::kUsage);
    CHECK(begun.failure().message.find("the server does not gather batches of 8: /config is "
                                       "answered with HTTP ") == 0);
  }
}

}  // namespace probe::servers
