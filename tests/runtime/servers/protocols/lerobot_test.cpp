// LeRobot's protocol against a server that keeps what LeRobot's own keeps.
#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "runtime/base/json.h"
#include "runtime/servers/protocols/lerobot_messages.h"
#include "runtime/servers/served.h"
#include "runtime/servers/servers.h"
#include "runtime/servers/shared_model.h"
#include "tests/runtime/servers/asking.h"

namespace probe::servers {
using namespace probe::policy;
namespace {

using test::PythonServer;
using Clock = std::chrono::steady_clock;

constexpr const char* kMeant =
    "&type=smolvla&model=/m&device=cpu&action.form=delta&action.units=m_rad"
    "&action.rotation=vector&action.gripper=signed&action.threshold=none";
constexpr const char* kQuick =
    "&timeout.connect_s=0.5&timeout.first_s=0.5&timeout.answer_s=0.5&answer.largest_mib=1";

struct Said {
  const char* fault;
  const char* says;  // the beginning, behind the server's name; empty: the answer is good
};

std::unique_ptr<Policy> lerobot_at(const PythonServer& server, const std::string& options = "",
                                   const PolicyContext& context = {}) {
  REQUIRE_MESSAGE(!server.port().empty(), "Debian's packages of .ci/packages.txt are installed");
  auto policy = make_policy(
      "lerobot://127.0.0.1:" + server.port() + "?timeout.wait_s=0.05" + kMeant + options, context);
  REQUIRE_MESSAGE(policy.ok(), to_text(policy.failure()));
  return std::move(policy).value();
}

// Nothing if an episode of one question went well.
std::string ask_once(Policy& policy, const std::string& prompt) {
  std::string failed;
  const auto begin = Clock::now();
  if (const auto begun = policy.begin(asking_start()); !begun) {
    failed = to_text(begun.failure());
  } else {
    AskingPicture picture;
    Observation seen = picture.observation();
    seen.prompt = prompt;
    if (const auto action = policy.act(seen); !action) failed = to_text(action.failure());
  }
  policy.end({});
  CHECK(std::chrono::duration<double>(Clock::now() - begin).count() < 6);
  return failed;
}

std::vector<std::string> calls_of(const ServerRecord& record) {
  std::vector<std::string> calls;
  for (const std::string& line : record.lines()) calls.push_back(Json::parse(line)["call"].text());
  return calls;
}

}  // namespace

TEST_CASE("LeRobot: the policy is told once, and each episode stands between two words of Ready") {
  const ServerRecord record;
  const PythonServer server("lerobot_server.py", {record.option(), "chunk=2"});
  PolicyContext context;
  context.model = std::make_shared<SharedModel>();
  const auto first = lerobot_at(server, "", context);
  const auto second = lerobot_at(server, "", context);
  AskingPicture picture;
  for (Policy* policy : {first.get(), second.get()}) {
    must_begin(*policy);
    const double shift = must_act(*policy, picture.observation(0))[0];
    CHECK(must_act(*policy, picture.observation(1))[0] == doctest::Approx(shift + 0.001));
    policy->end({});
  }
  const std::vector<std::string> wanted = {// opened, begun, asked, ended
                                           "Ready",      "Ready",      "SendPolicyInstructions",
                                           "GetActions", "Ready",      "Ready",
                                           "Ready",      "GetActions", "Ready"};
  CHECK(calls_of(record) == wanted);
}

TEST_CASE("LeRobot: an observation has what its features say, and the policy is told these") {
  const ServerRecord record;
  const PythonServer server("lerobot_server.py", {record.option()});
  const auto policy = lerobot_at(server, "&chunk.length=1");
  must_begin(*policy);
  AskingPicture picture;
  must_act(*policy, picture.observation(3));
  Json setup, asked;
  for (const std::string& line : record.lines()) {
    const Json call = Json::parse(line);
    if (call["call"].text() == "SendPolicyInstructions") setup = call;
    if (call["call"].text() == "GetActions") asked = call;
  }
  CHECK(setup["policy_type"].text() == "smolvla");
  CHECK(setup["pretrained_name_or_path"].text() == "/m");
  CHECK(setup["device"].text() == "cpu");
  CHECK(setup["actions_per_chunk"].get<int>() == 1);
  CHECK(setup["rename_map"].items().empty());
  const Json features = setup["lerobot_features"];
  // The first bytes of SHA-256("smolvla\n/m\ncpu\n1") tell this policy's numbers from others'.
  Json names = Json::array();
  for (int i = 0; i < 7; ++i) names.push_back("state.5151a6bf." + std::to_string(i));
  CHECK(features["observation.state"]["names"].dump() == names.dump());
  CHECK(features["observation.state"]["shape"].dump() == "[7]");
  CHECK(features["observation.state"]["dtype"].text() == "float32");
  CHECK(features["observation.images.image"].dump() ==
        R"({"dtype":"image","shape":[6,8,3],"names":["height","width","channels"]})");
  CHECK(asked["image"].dump() == R"(["uint8",[6,8,3],1008])");
  CHECK(asked["task"].text() == "put carrot on plate");
  CHECK(asked["step"].get<double>() == 3);
  CHECK(asked["state.5151a6bf.6"].is_number());
}

TEST_CASE("LeRobot: a server's bad answer ends one episode, with its reason, and the next works") {
  const PythonServer server("lerobot_server.py");
  const auto policy = lerobot_at(server, kQuick);
  const auto timestep = [](const std::string& said) {
    return said.find("expected timestep ") != std::string::npos;
  };
  const Said kFaults[] = {
      {"slow", ""},
      {"never", "no answer in 0.5 s"},
      {"traceback", "the server failed: Exception calling application: 'x'"},
      {"shape", "expected actions of 7 numbers, an array 7 or N x 7; got an array 6 of <f4"},
      {"nan", "number 2 of action 1 of 1 is not a number"},
      {"far", "an action that shifts by 1000"},
      {"other", "expected a list of TimedAction, got a dict of 1"},
      {"others", "expected a `lerobot.async_inference.helpers TimedAction`, got the number 1"},
      {"late", "an answer to another observation: expected timestep "},
      {"huge", "an answer of more than 1 MiB"},
      {"garbage", "byte 0 of a pickle: no opcode is 1"},
      {"half", "byte "},
      {"twice", "not one pickle: "},
      {"empty", "the server answered without actions: "},
      {"none", "the server answered without actions: "},
      {"cuda", "a storage at the text \"cuda:0\", not on the CPU"},
      {"evil", "byte "},
  };
  for (const Said& said_of : kFaults) {
    const char *fault = said_of.fault, *says = said_of.says;
    CAPTURE(fault);
    const std::string said = ask_once(*policy, "fault:" + std::string(fault));
    if (*says == '\0') {
      CHECK(said == "");
    } else {
      CHECK_MESSAGE(said.starts_with("127.0.0.1:" + server.port() + ": " + says), said);
    }
    CHECK(timestep(said) == (fault == std::string("late")));
    if (fault == std::string("evil"))
      CHECK(said.find("the global `posix system` is not read") != std::string::npos);
    CHECK(ask_once(*policy, "put carrot on plate") == "");
  }
  CHECK_FALSE(std::filesystem::exists("/tmp/vlaprobe_was_run"));
}

TEST_CASE("LeRobot: what listens and is no LeRobot server is told from one that is not there") {
  const Said kConnectionFaults[] = {
      {"silent", "no answer in 0.5 s"},
      {"hangs_up", "the server went away"},
      {"babbles", "something listens there that does not speak gRPC"},
      {"unavailable", "something listens there that does not speak gRPC"}};
  for (const Said& said_of : kConnectionFaults) {
    const char *fault = said_of.fault, *says = said_of.says;
    CAPTURE(fault);
    const PythonServer server("fault_server.py", {"openvla", "connect=" + std::string(fault)});
    const auto policy = lerobot_at(server, kQuick);
    const std::string said = ask_once(*policy, "put carrot on plate");
    // One that closed before our first words were out is only known to have gone.
    const std::string place = "127.0.0.1:" + server.port() + ": ";
    CHECK_MESSAGE(
        (said.starts_with(place + says) || (std::string(says).starts_with("something listens") &&
                                            said.starts_with(place + "the server went away"))),
        said);
  }
}

TEST_CASE("LeRobot: a server that is killed costs one episode, and is told its policy again") {
  const ServerRecord record;
  auto server = std::make_unique<PythonServer>("lerobot_server.py",
                                               std::vector<std::string>{record.option()});
  const std::string port = server->port();
  PolicyContext context;
  context.model = std::make_shared<SharedModel>();
  const auto policy = lerobot_at(*server, kQuick, context);
  CHECK(ask_once(*policy, "put carrot on plate") == "");
  CHECK(ask_once(*policy, "fault:gone") == "127.0.0.1:" + port + ": the server went away");
  CHECK(ask_once(*policy, "put carrot on plate")
            .starts_with("127.0.0.1:" + port + ": connecting: Connection refused"));
  server = std::make_unique<PythonServer>(
      "lerobot_server.py", std::vector<std::string>{record.option(), "port=" + port});
  REQUIRE(server->port() == port);
  CHECK(ask_once(*policy, "put carrot on plate") == "");
  int told = 0;
  for (const std::string& call : calls_of(record)) told += call == "SendPolicyInstructions" ? 1 : 0;
  CHECK(told == 2);
}

TEST_CASE("LeRobot: a policy that cannot be loaded is named, and with every later failure") {
  const PythonServer server("lerobot_server.py", {"lacks=/m"});
  PolicyContext context;
  context.model = std::make_shared<SharedModel>();
  for (int i = 0; i < 2; ++i) {
    const auto policy = lerobot_at(server, "", context);
    CHECK(ask_once(*policy, "put carrot on plate")
              .starts_with("127.0.0.1:" + server.port() +
                           ": loading `/m`: the server failed: Exception calling application: no "
                           "model at /m"));
  }
}

TEST_CASE("LeRobot: a server that dies of loading its policy costs one episode, and no run waits") {
  const PythonServer server("lerobot_server.py", {"dies_of=/m"});
  PolicyContext context;
  context.model = std::make_shared<SharedModel>();
  const auto policy = lerobot_at(server, kQuick, context);
  CHECK(ask_once(*policy, "put carrot on plate") ==
        "127.0.0.1:" + server.port() + ": loading `/m`: the server went away");
  CHECK(ask_once(*policy, "put carrot on plate")
            .starts_with("127.0.0.1:" + server.port() + ": connecting: Connection refused"));
}

TEST_CASE("LeRobot: worlds at one server take turns, and each has its own answers") {
  ServeOptions options;
  options.policy = serve_digest().value();
  const auto listener = serve(Protocol::kLeRobot, options);
  REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
  const std::string address = "lerobot://127.0.0.1:" + (*listener)->port() + "?" +
                              options_for_served(Protocol::kLeRobot, options);
  PolicyContext context;
  context.model = std::make_shared<SharedModel>();
  constexpr int kWorlds = 6, kSteps = 20;
  // What a world alone is answered, and what it is among others.
  const auto acted = [&](int world) {
    std::vector<double> shifts;
    auto policy = make_policy(address, context);
    if (!policy || !(*policy)->begin(asking_start()).ok()) return shifts;
    AskingPicture picture;
    for (int step = 0; step < kSteps; ++step) {
      picture.bytes[0] = static_cast<std::uint8_t>(world * kSteps + step);
      const auto action = (*policy)->act(picture.observation(step));
      if (!action) break;
      shifts.push_back((*action)[0]);
    }
    (*policy)->end({});
    return shifts;
  };
  std::vector<std::vector<double>> alone, together(kWorlds);
  for (int world = 0; world < kWorlds; ++world) alone.push_back(acted(world));
  std::vector<std::thread> threads;
  for (int world = 0; world < kWorlds; ++world)
    threads.emplace_back([&, world] { together[static_cast<std::size_t>(world)] = acted(world); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t world = 0; world < kWorlds; ++world) {
    CHECK(alone[world].size() == kSteps);
    CHECK(together[world] == alone[world]);
  }
}

TEST_CASE(
    "LeRobot: a busy server is asked while the observation arrives, and waits for it or not") {
  constexpr int kQuestions = 4;
  for (const bool is_patient : {true, false}) {
    for (const int worlds : {1, 3}) {
      CAPTURE(is_patient);
      CAPTURE(worlds);
      const ServerRecord record;
      const PythonServer server(
          "lerobot_server.py", {record.option(), "arrivals", is_patient ? "patient" : "impatient"});
      PolicyContext context;
      context.model = std::make_shared<SharedModel>();
      std::atomic<int> right = 0;
      std::vector<std::thread> threads;
      for (int world = 0; world < worlds; ++world) {
        auto policy = lerobot_at(server, "", context);
        threads.emplace_back([&, policy = std::move(policy)] {
          if (!policy->begin(asking_start()).ok()) return;
          AskingPicture picture;
          for (int step = 0; step < kQuestions; ++step) {
            Observation seen = picture.observation(step);
            seen.prompt = "fault:slow";
            if (policy->act(seen).ok()) ++right;
          }
          policy->end({});
        });
      }
      for (std::thread& thread : threads) thread.join();
      CHECK(right == worlds * kQuestions);
      // How often actions were asked for before there was anything to answer.
      int there = 0, early = 0;
      for (const std::string& call : calls_of(record)) {
        if (call == "arrived") ++there;
        if (call == "GetActions") --there;
        if (call == "asked" && there == 0) ++early;
      }
      CHECK((early > 0) == (worlds > 1));
    }
  }
}

TEST_CASE("LeRobot: strangers at one server are refused each other's answers") {
  // Another run's question takes the only place, as the server's own queue has it.
  const PythonServer server("lerobot_server.py");
  const auto ours = lerobot_at(server, kQuick);
  CHECK(ask_once(*ours, "put carrot on plate") == "");
  const auto channel = wire::GrpcChannel::connect({"127.0.0.1", server.port(), "/", {}});
  REQUIRE(channel.ok());
  int refused = 0;
  for (int i = 0; i < 40; ++i) {
    std::thread stranger([&] {
      const auto sent = (*channel)->call(lerobot::send_observation({0, 5, {{"task", "another"}}}),
                                         std::chrono::seconds(2));
      CHECK(sent.ok());
    });
    const std::string said = ask_once(*ours, "put carrot on plate");
    stranger.join();
    // Whatever happened, no answer of the stranger's was taken: its observation has no picture, so
    // that it has none, or ours was asked for with another timestep.
    if (said.empty()) continue;
    ++refused;
    const bool is_named = said.find("without actions") != std::string::npos ||
                          said.find("another observation") != std::string::npos ||
                          said.find("no answer in") != std::string::npos;
    CHECK_MESSAGE(is_named, said);
  }
  MESSAGE(refused << " of 40 episodes were refused");
}

TEST_CASE("LeRobot: a policy that somebody else had loaded meanwhile answers nothing of ours") {
  const ServerRecord record;
  const PythonServer server("lerobot_server.py", {record.option(), "seen"});
  const auto ours = lerobot_at(server, kQuick);
  const auto theirs = make_policy(
      "lerobot://127.0.0.1:" + server.port() +
      "?type=smolvla&model=/other&device=cpu&action.form=delta&action.units=m_rad"
      "&action.rotation=vector&action.gripper=signed&action.threshold=none&timeout.wait_s=0.05");
  REQUIRE_MESSAGE(theirs.ok(), to_text(theirs.failure()));
  CHECK(ask_once(*ours, "put carrot on plate") == "");
  CHECK(ask_once(**theirs, "put carrot on plate") == "");
  CHECK(ask_once(*ours, "put carrot on plate").find("another one was loaded meanwhile") !=
        std::string::npos);
  CHECK(ask_once(*ours, "put carrot on plate") == "");
  std::vector<std::string> loaded;
  for (const std::string& line : record.lines()) {
    const Json call = Json::parse(line);
    if (call["call"].text() == "SendPolicyInstructions")
      loaded.push_back(call["pretrained_name_or_path"].text());
  }
  CHECK(loaded == std::vector<std::string>{"/m", "/other", "/m"});
}

TEST_CASE("LeRobot: what its server cannot be told is refused before it is asked") {
  const auto why = [](const std::string& options) {
    const auto policy = make_policy("lerobot://h" + options);
    return policy ? std::string() : policy.failure().message;
  };
  CHECK(why("").starts_with("a LeRobot server begins without a policy: write "));
  CHECK(why("?type=act").starts_with("a LeRobot server begins without a policy: write "));
  CHECK(why("?type=act&model=/m") == "");
  CHECK(why("?type=act&model=/m&image=first%20-%3E%20front")
            .starts_with("a LeRobot server's pictures are named `observation.images.NAME`"));
  CHECK(
      why("?type=act&model=/m&state.layout=none").starts_with("a LeRobot server reads one state"));
  CHECK(why("?type=act&model=/m&prompt.key=prompt")
            .starts_with("a LeRobot server reads its instruction under `prompt.key` = task"));
}

}  // namespace probe::servers
