// GR00T's messages byte by byte, and its client against servers of the three forms.
#include "runtime/servers/protocols/gr00t.h"

#include <doctest/doctest.h>
#include <stdlib.h>

#include "runtime/base/sha256.h"
#include "runtime/servers/servers.h"
#include "runtime/wire/msgpack.h"
#include "tests/hex.h"
#include "tests/runtime/servers/asking.h"

namespace probe::servers {
using namespace probe::policy;
namespace {

using test::PythonServer;

Profile bridge_profile() {
  Profile profile;
  profile.prompt_key = "text";
  profile.state_key = "state";
  profile.state_layout = StateLayout::kXyzRpyOpenness;
  return profile;
}

Request small_request() {
  Request request;
  request.prompt = "go";
  request.images.push_back({"video.image_0", wire::array_u8({1, 2, 3}, {0, 1, 2, 3, 4, 5})});
  request.state = {0.5, 0, 0, 0, 0, 0, 1};
  return request;
}

wire::Value answer_of(std::size_t gripper_count = 2, double last = 14) {
  wire::Map map;
  double number = 0;
  for (const char* name : {"x", "y", "z", "roll", "pitch", "yaw"}) {
    map.emplace_back("action." + std::string(name),
                     wire::array_f32({1, 2, 1}, {number + 1, number + 2}));
    number += 2;
  }
  std::vector<double> gripper(gripper_count, 13);
  gripper.back() = last;
  map.emplace_back("action.gripper",
                   wire::array_f32({1, static_cast<std::int64_t>(gripper_count), 1}, gripper));
  return map;
}

}  // namespace

TEST_CASE("a GR00T observation has the bytes that Python's client sends") {
  const wire::Bytes bytes =
      wire::to_msgpack(gr00t_observation(Gr00tForm::kN16, bridge_profile(), small_request()),
                       wire::ArrayStyle::kNpy);
  // The same from python3-msgpack 1.0.3 and numpy.save of python3-numpy 1.24.2.
  CHECK(bytes.size() == 1385);
  const wire::Bytes begin = test::from_hex(
      "89ad766964656f2e696d6167655f3082b15f5f6e6461727261795f636c6173735f5fc3a661735f6e7079c486"
      "934e554d5059010076007b276465736372273a20277c7531272c2027666f727472616e5f6f72646572273a20"
      "46616c73652c20277368617065273a2028312c20312c20312c20322c2033292c207d");
  REQUIRE(bytes.size() > begin.size());
  CHECK(wire::Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(begin.size())) ==
        begin);
  CHECK(to_hex(sha256(std::as_bytes(std::span(bytes)))) ==
        "b697afe4eacbf7280ba3ad81badf54bea67a1632107e15621548262e02287a14");
}

TEST_CASE("GR00T's older form has one dimension less, the nested one maps of maps") {
  const wire::Value old = gr00t_observation(Gr00tForm::kN15, bridge_profile(), small_request());
  CHECK(wire::shape_of(*old.find("video.image_0")) == std::vector<std::int64_t>{1, 1, 2, 3});
  CHECK(wire::shape_of(*old.find("state.gripper")) == std::vector<std::int64_t>{1, 1});
  const wire::Value nested =
      gr00t_observation(Gr00tForm::kN16Nested, bridge_profile(), small_request());
  CHECK(wire::shape_of(*nested.find("video")->find("image_0")) ==
        std::vector<std::int64_t>{1, 1, 1, 2, 3});
  CHECK(nested.find("state")->find("x") != nullptr);
  CHECK(*nested.find("language")->find("text") == wire::Value(wire::List{wire::List{"go"}}));
}

TEST_CASE(
    "a policy of LIBERO behind GR00T gets its state of eight in seven entries, both fingers one") {
  for (const char* name : {"gr00t_libero", "gr00t_n15_libero"}) {
    CAPTURE(std::string(name));
    const auto choice =
        choose_server(Protocol::kGr00t, "//127.0.0.1:5555?profile=" + std::string(name));
    REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
    const Profile& profile = choice->profile;
    const bool is_old = profile.dialect == "n1.5";
    Request request;
    request.prompt = "turn on the stove";
    for (const auto& image : profile.images)
      request.images.push_back({image.key, wire::array_u8({1, 1, 3}, {1, 2, 3})});
    request.state = {0.1, 0.2, 0.3, 1.1, 1.2, 1.3, 0.02, -0.03};
    const wire::Value asked =
        gr00t_observation(is_old ? Gr00tForm::kN15 : Gr00tForm::kN16, profile, request);
    CHECK(asked.as<wire::Map>()->size() == 10);
    CHECK(asked.find("video.image") != nullptr);
    CHECK(asked.find("video.wrist_image") != nullptr);
    CHECK(*asked.find("annotation.human.action.task_description") ==
          wire::Value(wire::List{"turn on the stove"}));
    const std::vector<std::pair<std::string, double>> alone = {
        {"x", 0.1}, {"y", 0.2}, {"z", 0.3}, {"roll", 1.1}, {"pitch", 1.2}, {"yaw", 1.3}};
    using Shape = std::vector<std::int64_t>;
    for (const auto& [entry, number] : alone) {
      const wire::Value* sent = asked.find("state." + entry);
      REQUIRE(sent != nullptr);
      CHECK(wire::shape_of(*sent) == (is_old ? Shape{1, 1} : Shape{1, 1, 1}));
      CHECK(wire::to_numbers(*sent)->front() == doctest::Approx(number).epsilon(1e-7));
    }
    const wire::Value* fingers = asked.find("state.gripper");
    REQUIRE(fingers != nullptr);
    CHECK(wire::shape_of(*fingers) == (is_old ? Shape{1, 2} : Shape{1, 1, 2}));
    CHECK(wire::to_numbers(*fingers)->back() == doctest::Approx(-0.03).epsilon(1e-7));
  }
  // Open is 1 of 0 .. 1 in its answers, a turn a vector, a whole number 5 cm or 0.5 rad.
  const auto choice = choose_server(Protocol::kGr00t, "//127.0.0.1:5555?profile=gr00t_libero");
  CHECK(choice->profile.action_gripper == GripperRange::kUnit);
  CHECK(choice->profile.chunk_use == 8);
}

TEST_CASE("actions are rows of GR00T's columns, alone or beside an info map") {
  const std::vector<RawAction> rows{{1, 3, 5, 7, 9, 11, 13}, {2, 4, 6, 8, 10, 12, 14}};
  CHECK(*gr00t_actions(answer_of()) == rows);
  CHECK(*gr00t_actions(wire::List{answer_of(), wire::Map{}}) == rows);
  CHECK(gr00t_actions(answer_of(3)).failure().message ==
        "expected actions of one length, got 2 of `action.x` and 3 of `action.gripper`");
  CHECK(gr00t_actions(answer_of(2, 0.0 / 0.0)).failure().message ==
        "number 7 of action 2 of 2 is not a number");
  CHECK(gr00t_actions(wire::Map{{"action.x", 1}}).failure().message ==
        "expected `action.y` among others, got a map with keys action.x");
  CHECK(gr00t_actions(wire::Map{{"error", "KeyError: 'video'\n"}}).failure().message ==
        "the server failed: KeyError: 'video'");
  CHECK_FALSE(gr00t_actions(wire::List{}).ok());
  CHECK_FALSE(gr00t_actions("text").ok());
}

TEST_CASE("each of GR00T's forms is spoken") {
  for (const char* form : {"n1.6", "n1.6_nested", "n1.5"}) {
    CAPTURE(std::string(form));
    const PythonServer server("gr00t_server.py", {form, "bridge=1", "chunk=4"});
    const auto policy =
        policy_at("gr00t", server, "&dialect=" + std::string(form) + "&chunk.use=2");
    AskingPicture picture;
    must_begin(*policy);
    for (const double expected : {0.0, 0.001, 0.004, 0.005}) {
      const Action action = must_act(*policy, picture.observation());
      CHECK(action[0] == expected);
      CHECK(action[6] == 1);
    }
  }
}

TEST_CASE("GR00T's server hears of each new episode, and its refusals are shown") {
  const PythonServer server("gr00t_server.py", {"n1.6"});
  const auto policy = policy_at("gr00t", server, "&action.rotation=vector&action.gripper=signed");
  AskingPicture picture;
  must_begin(*policy);
  CHECK(must_act(*policy, picture.observation())[0] == 0);
  CHECK(must_act(*policy, picture.observation())[0] == 0.001);
  must_begin(*policy);
  CHECK(must_act(*policy, picture.observation())[0] == 0);
  const auto other = policy_at("gr00t", server, "&dialect=n1.5");
  must_begin(*other);
  const auto refused = other->act(picture.observation());
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().message.starts_with("the server failed: AssertionError"));
}

TEST_CASE("a GR00T server's token comes from the environment and stays out of messages") {
  const PythonServer server("gr00t_server.py", {"n1.6", "token=hunter2"});
  auto policy = policy_at("gr00t", server);
  setenv("VLAPROBE_API_KEY", "sesame", 1);
  const auto refused = policy->begin(asking_start());
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().message.starts_with(
      "the server failed: Unauthorized: Invalid API token *"));
  CHECK(refused.failure().message.find("sesame") == std::string::npos);
  setenv("VLAPROBE_API_KEY", "hunter2", 1);
  must_begin(*policy);
  unsetenv("VLAPROBE_API_KEY");
}

TEST_CASE("a GR00T profile that cannot be sent is refused") {
  CHECK(make_policy("gr00t://h?dialect=n1.7").failure().message ==
        "the `dialect` of a GR00T server is n1.6, n1.6_nested or n1.5, not `n1.7`");
  CHECK(make_policy("gr00t://h?state.layout=joints")
            .failure()
            .message.starts_with("GR00T is sent its state entry by entry"));
}

}  // namespace probe::servers
