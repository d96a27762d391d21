// Policies by a URL, and over TLS: what an address may say, that episodes work and fail as over
// plain connections, and that a certificate nobody checked is told.
#include <doctest/doctest.h>

#include "runtime/servers/reading.h"
#include "runtime/servers/servers.h"
#include "tests/runtime/servers/asking.h"

namespace probe::servers {
using namespace probe::policy;
namespace {

using test::PythonServer;

struct Secured {
  const char* scheme;
  const char* protocol;
  const char* options;
};
constexpr Secured kSecured[] = {{"wss", "openpi", ""},  {"wss", "intact", "&model=/m"},
                                {"wss", "vlaeval", ""}, {"wss", "roboarena", ""},
                                {"wss", "starvla", ""}, {"https", "openvla", ""}};

std::string authority_path() {
  return (std::filesystem::temp_directory_path() /
          ("vlaprobe_tls_" + std::to_string(getpid()) + ".pem"))
      .string();
}

std::string address_of(const Secured& secured, const PythonServer& server,
                       const std::string& options) {
  REQUIRE_MESSAGE(!server.port().empty(), "Debian's packages of .ci/packages.txt are installed");
  return std::string(secured.scheme) + "://127.0.0.1:" + server.port() +
         "?protocol=" + secured.protocol + secured.options +
         "&timeout.connect_s=2&timeout.first_s=0.5&timeout.answer_s=0.5&timeout.wait_s=0.05"
         "&action.rotation=vector&action.gripper=signed&action.threshold=none" +
         options;
}

// Nothing if an episode of one question went well.
std::string ask_once(Policy& policy, const std::string& prompt) {
  if (const auto begun = policy.begin(asking_start()); !begun) return to_text(begun.failure());
  AskingPicture picture;
  Observation seen = picture.observation();
  seen.prompt = prompt;
  const auto action = policy.act(seen);
  policy.end({});
  return action ? "" : to_text(action.failure());
}

std::string refusal(const std::string& text, bool accepts_any = false) {
  const auto choice = server_choice(text, accepts_any);
  return choice ? "" : choice.failure().message;
}

}  // namespace

TEST_CASE("a URL as it was copied says host, port and path; a profile says what is spoken there") {
  const auto choice = server_choice("wss://gpu.example/pi0/ws?profile=openpi_libero&ca=/ca.pem");
  REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
  CHECK(choice->profile.name == "openpi_libero");
  CHECK(choice->server.host == "gpu.example");
  CHECK(choice->server.port == "443");
  CHECK(choice->server.path == "/pi0/ws");
  CHECK(choice->server.tls.is_on);
  CHECK_FALSE(choice->server.tls.accepts_any);
  CHECK(choice->server.tls.authorities == "/ca.pem");
  CHECK(choice->server.options.empty());

  const auto plain = server_choice("ws://gpu:8000?protocol=openpi&profile=openpi_libero");
  REQUIRE(plain.ok());
  CHECK_FALSE(plain->server.tls.is_on);
  CHECK(server_choice("ws://gpu?protocol=openpi")->server.port == "80");
  CHECK(server_choice("https://gpu?protocol=openvla")->profile.protocol == Protocol::kOpenVla);
  // Where it is and how one gets there is nothing of the policy.
  CHECK(describe(*plain) == describe(*choice));
}

TEST_CASE("a URL that does not say what is spoken, or says what cannot be, is refused") {
  CHECK(refusal("wss://gpu") ==
        "`wss://` does not say what is spoken there: add ?profile=NAME, or ?protocol=NAME of "
        "openpi, intact, roboarena, vlaeval, starvla; openvla at `https://gpu`");
  CHECK(refusal("http://gpu:8000/a?chunk.use=2") ==
        "`http://` does not say what is spoken there: add ?profile=NAME, or ?protocol=NAME of "
        "openvla; openpi, intact, roboarena, vlaeval, starvla at `ws://gpu:8000/a`");
  CHECK(refusal("https://gpu?profile=pi0_bridge&model=/m") ==
        "`intact` is not spoken over `https://`: write `wss://gpu?profile=pi0_bridge&model=/m`");
  CHECK(refusal("http://gpu:8000/a?protocol=openpi") ==
        "`openpi` is not spoken over `http://`: write `ws://gpu:8000/a?protocol=openpi`");
  CHECK(refusal("wss://gpu?protocol=openvla") ==
        "`openvla` is not spoken over `wss://`: write `https://gpu?protocol=openvla`");
  CHECK(refusal("wss://gpu?protocol=gr00t&dialect=n1.5") ==
        "`gr00t` is not spoken over `wss://`: write `gr00t://gpu:5555?dialect=n1.5`");
  CHECK(refusal("http://[::1]:9?protocol=lerobot") ==
        "`lerobot` is not spoken over `http://`: write `lerobot://[::1]:9`");
  CHECK(refusal("wss://gpu?protocol=opnpi") ==
        "`opnpi` is not spoken over `wss://`; openpi, intact, roboarena, vlaeval, starvla are");
  CHECK(
      refusal("wss://gpu?protocol=openpi&profile=pi0_bridge") ==
      "profile `pi0_bridge` is for servers that speak intact, not openpi: `?protocol=` is left out "
      "beside `?profile=`");
  CHECK(
      refusal("wss://gpu?protocol=openpi&profile=openvla_bridge") ==
      "profile `openvla_bridge` is for servers that speak openvla, not openpi: its URL begins with "
      "`https://`, and `?protocol=` is left out beside `?profile=`");
  CHECK(refusal("openpi://gpu?profile=pi0_bridge") ==
        "profile `pi0_bridge` is for servers that speak intact, not openpi: write `intact://...`");
  CHECK(refusal("ws://gpu?protocol=openpi&ca=/ca.pem") ==
        "`ca` is of servers over TLS: wss://... or https://...");
  CHECK(refusal("openpi://gpu", true) ==
        "`openpi://gpu` shows no certificate that could be left unchecked: it is no wss:// or "
        "https://");
  CHECK(refusal("wss://gpu?protocol=openpi", true).empty());
  CHECK_FALSE(choose_policy("expert", true).ok());
}

TEST_CASE("episodes over TLS work and fail as over plain connections, and the next one works") {
  for (const Secured& secured : kSecured) {
    CAPTURE(std::string(secured.protocol));
    const std::string ca = authority_path();
    const PythonServer server("tls_front.py", {"ca=" + ca, "fault_server.py", secured.protocol});
    auto policy = make_policy(address_of(secured, server, "&ca=" + ca));
    REQUIRE_MESSAGE(policy.ok(), to_text(policy.failure()));
    CHECK(ask_once(**policy, "put carrot on plate") == "");
    for (const char* fault : {"never", "gone", "half", "traceback", "shape", "huge", "garbage"}) {
      CAPTURE(fault);
      CHECK(ask_once(**policy, "fault:" + std::string(fault))
                .starts_with("127.0.0.1:" + server.port() + ": "));
      CHECK(ask_once(**policy, "put carrot on plate") == "");
    }
    std::filesystem::remove(ca);
  }
}

TEST_CASE("a server with the wrong certificate is not asked, unless --insecure says so aloud") {
  for (const Secured& secured : kSecured) {
    CAPTURE(std::string(secured.protocol));
    const std::string ca = authority_path();
    const PythonServer server("tls_front.py",
                              {"ca=" + ca, "cert=elsewhere", "fault_server.py", secured.protocol});
    const std::string address = address_of(secured, server, "&ca=" + ca);
    const auto policy = make_policy(address);
    REQUIRE_MESSAGE(policy.ok(), to_text(policy.failure()));
    CHECK(ask_once(**policy, "put carrot on plate") ==
          "127.0.0.1:" + server.port() +
              ": the certificate is for gpu.example, 10.1.2.3, not for 127.0.0.1; --insecure "
              "accepts any");
    const auto chosen = choose_policy(address, true);
    REQUIRE_MESSAGE(chosen.ok(), to_text(chosen.failure()));
    const auto unchecked = make_policy(*chosen);
    REQUIRE_MESSAGE(unchecked.ok(), to_text(unchecked.failure()));
    CHECK(ask_once(**unchecked, "put carrot on plate") == "");

    const auto choice = server_choice(address + "&action.form=delta&action.units=m_rad", true);
    REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
    const auto reading = prove_reading(*choice);
    REQUIRE_MESSAGE(reading.ok(), to_text(reading.failure()));
    CHECK(reading->is_unchecked);
    REQUIRE_FALSE(findings_of(*reading).empty());
    CHECK(findings_of(*reading).front() ==
          "the policy at 127.0.0.1:" + server.port() +
              " was asked with --insecure: its certificate was not checked, so that another than "
              "it can have answered");
    std::filesystem::remove(ca);
  }
}

}  // namespace probe::servers
