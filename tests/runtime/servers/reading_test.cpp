// The questions at a run's beginning, against servers that read and servers that do not.
#include "runtime/servers/reading.h"

#include <doctest/doctest.h>

#include "runtime/servers/conformance.h"

#include "tests/runtime/servers/asking.h"

namespace probe::servers {
namespace {

Result<policy::Reading> read_by(const std::string& habit) {
  const test::PythonServer server("openpi_server.py", {"intact", "seen=" + habit, "chunk=2"});
  REQUIRE_MESSAGE(!server.port().empty(), "Debian's python3-websockets is installed");
  const auto choice = choose_server(
      Protocol::kIntact, "//127.0.0.1:" + server.port() + "?model=/m&timeout.wait_s=0.05");
  REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
  return prove_reading(*choice);
}

}  // namespace

TEST_CASE("a policy that reads is proved to, and answers by which it is known again") {
  const auto reading = read_by("fine");
  REQUIRE_MESSAGE(reading.ok(), to_text(reading.failure()));
  CHECK(reading->answers == 3);
  CHECK_FALSE(reading->is_deaf);
  CHECK_FALSE(reading->is_blind);
  CHECK(policy::findings_of(*reading).empty());
  CHECK(reading->answers_sha256.size() == 64);
  CHECK(read_by("fine")->answers_sha256 == reading->answers_sha256);
  CHECK(read_by("deaf")->answers_sha256 != reading->answers_sha256);
}

TEST_CASE("answers that are equal bit for bit are told, with what they show") {
  const auto deaf = read_by("deaf"), blind = read_by("blind");
  REQUIRE((deaf.ok() && blind.ok()));
  CHECK(deaf->is_deaf);
  CHECK_FALSE(deaf->is_blind);
  CHECK(blind->is_blind);
  CHECK_FALSE(blind->is_deaf);
  REQUIRE(policy::findings_of(*deaf).size() == 1);
  CHECK(policy::findings_of(*deaf)[0].find("two instructions with one picture bit for bit") !=
        std::string::npos);
  CHECK(policy::findings_of(*blind)[0].find("one instruction with two pictures bit for bit") !=
        std::string::npos);
}

TEST_CASE(
    "a server of seven joints is proved to read, and tested, with the state of seven joints") {
  const test::PythonServer server("openpi_server.py", {"droid", "seen=fine", "chunk=4"});
  REQUIRE_FALSE(server.port().empty());
  const auto choice =
      choose_server(Protocol::kOpenpi, "//127.0.0.1:" + server.port() + "?profile=openpi_droid");
  REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
  const auto reading = prove_reading(*choice);
  REQUIRE_MESSAGE(reading.ok(), to_text(reading.failure()));
  CHECK(reading->failure == "");
  CHECK(reading->answers == 3);
  CHECK(policy::findings_of(*reading).empty());
  const auto tested = test_server(*choice);
  REQUIRE_MESSAGE(tested.ok(), to_text(tested.failure()));
  CHECK_MESSAGE(!tested->is_wrong(), to_text(*tested));
  // A run's robot is its plan's, whatever the profile says.
  const auto six = prove_reading(*choice, nullptr, KnownArm{});
  REQUIRE_MESSAGE(six.ok(), to_text(six.failure()));
  CHECK(six->failure.find("AssertionError: ((6,), (1,))") != std::string::npos);
}

TEST_CASE("known arms have their joints before their fingers, and their tool on either side") {
  for (const std::size_t joints : {std::size_t{5}, std::size_t{6}, std::size_t{7}}) {
    const KnownArm arm{.joints = joints, .fingers = 3};
    const auto here = known_state(false, arm), there = known_state(true, arm);
    CHECK(here.arm_joints() == joints);
    CHECK(here.joints.size() == joints + 3);
    CHECK(here.joints[0] == -there.joints[0]);
    CHECK(here.tcp_in_base.position.y() == doctest::Approx(0.05));
    CHECK(there.tcp_in_base.position.y() == doctest::Approx(-0.05));
    CHECK(here.tcp_in_base.position.x() == there.tcp_in_base.position.x());
  }
}

TEST_CASE("first answers that are no moves of an arm are refused, with what would read them") {
  const test::PythonServer server("openpi_server.py", {"openpi", "seen=normalised"});
  REQUIRE_FALSE(server.port().empty());
  const auto read = [&](const std::string& more) {
    const auto choice =
        choose_server(Protocol::kOpenpi,
                      "//127.0.0.1:" + server.port() +
                          "?action.form=delta&action.units=m_rad&action.rotation=vector" + more);
    REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
    return prove_reading(*choice);
  };
  const auto refused = read("");
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().code == Fault::kUsage);
  CHECK(refused.failure().where == "127.0.0.1:" + server.port());
  CHECK(refused.failure().message.starts_with("its first answers are no moves of the arm: "));
  CHECK(refused.failure().message.find("`action.normalised = bound") != std::string::npos);
  const auto said = read(
      "&action.normalised=bound&action.low=-0.02%20-0.02%20-0.02%20-0.1%20-0.1%20-0.1%200"
      "&action.high=0.02%200.02%200.02%200.1%200.1%200.1%201");
  CHECK_MESSAGE(said.ok(), to_text(said.failure()));
}

TEST_CASE("a wrapper that keeps its instruction is reset between the questions and reads") {
  CHECK_FALSE(read_by("keeps")->is_deaf);
}

TEST_CASE("a server that cannot answer the questions is told; one that is not there is a failure") {
  const auto broken = read_by("nan");
  REQUIRE_MESSAGE(broken.ok(), to_text(broken.failure()));
  CHECK(broken->answers == 0);
  CHECK(broken->answers_sha256.empty());
  CHECK(policy::findings_of(*broken)[0].find("is not a number") != std::string::npos);
  const auto choice = choose_server(Protocol::kOpenpi, "//127.0.0.1:1?timeout.wait_s=0.05");
  REQUIRE(choice.ok());
  const auto absent = prove_reading(*choice);
  REQUIRE_FALSE(absent.ok());
  CHECK(absent.failure().code == Fault::kPolicy);
  CHECK(absent.failure().message.find("Connection refused") != std::string::npos);
}

}  // namespace probe::servers
