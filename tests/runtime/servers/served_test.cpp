// Our own reference servers, over each protocol's wire.
#include "runtime/servers/served.h"

#include <doctest/doctest.h>

#include <atomic>

#include "runtime/run/policies.h"
#include "runtime/servers/conformance.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/reading.h"
#include "runtime/servers/servers.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/servers/python_server.h"

namespace probe::servers {
namespace {

// A certificate for this machine, its key and the authority that signed it.
class Certificate {
 public:
  Certificate()
      : made_by_("tls_front.py",
                 {"ca=" + authority(), "shown=" + (folder_ / "server"), "websocket_server.py"}) {
    REQUIRE_MESSAGE(!made_by_.port().empty(),
                    "Debian's packages of .ci/packages.txt are installed");
  }
  std::string authority() const { return folder_ / "authority.pem"; }
  wire::TlsFiles files() const { return {folder_ / "server.pem", folder_ / "server.key"}; }

 private:
  run::TemporaryFolder folder_;
  test::PythonServer made_by_;
};

bool goes_over_urls(Protocol protocol) {
  const Carrier carrier = row_of(protocol).carrier;
  return carrier == Carrier::kWebSocket || carrier == Carrier::kHttp;
}

}  // namespace

TEST_CASE("a served digest is proved to read, and a served null not to, on every protocol") {
  for (const Protocol protocol : all_protocols()) {
    CAPTURE(std::string(to_word(protocol)));
    for (const bool reads : {true, false}) {
      ServeOptions options;
      options.policy = reads ? serve_digest().value() : serve_null().value();
      const auto listener = serve(protocol, options);
      REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
      const auto choice = choose_server(protocol, "//127.0.0.1:" + (*listener)->port() + "?" +
                                                      options_for_served(protocol, options));
      REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
      const auto reading = prove_reading(*choice);
      REQUIRE_MESSAGE(reading.ok(), to_text(reading.failure()));
      CHECK(reading->failure.empty());
      CHECK(reading->answers == 3);
      CHECK(reading->is_deaf == !reads);
      CHECK(reading->is_blind == !reads);
    }
  }
}

TEST_CASE("a policy test ends in 20 answers on every protocol, and finds nothing wrong with ours") {
  class Counting final : public ServedPolicy {
   public:
    explicit Counting(std::atomic<int>& answers) : answers_(answers) {}
    void reset() override {}
    Result<std::vector<policy::Action>> answer(const Asked& asked, int count) override {
      ++answers_;
      return inner_->answer(asked, count);
    }

   private:
    std::atomic<int>& answers_;
    std::unique_ptr<ServedPolicy> inner_ = serve_digest().value()();
  };
  for (const Protocol protocol : all_protocols()) {
    for (const bool has_batches : {false, true}) {
      if (has_batches && row_of(protocol).batches != Batches::kOneMessage) continue;
      CAPTURE(std::string(to_word(protocol)));
      std::atomic<int> answers = 0;
      ServeOptions options;
      options.batch = has_batches ? 4 : 1;
      options.policy = [&] { return std::make_unique<Counting>(answers); };
      const auto listener = serve(protocol, options);
      REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
      const auto choice = choose_server(protocol, "//127.0.0.1:" + (*listener)->port() + "?" +
                                                      options_for_served(protocol, options));
      REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
      const auto tested = test_server(*choice);
      REQUIRE_MESSAGE(tested.ok(), to_text(tested.failure()));
      CHECK_MESSAGE(!tested->is_wrong(), to_text(*tested));
      CHECK(tested->queries >= 11);
      CHECK(tested->queries <= 20);
      CHECK(answers >= tested->queries);
      CHECK(answers <= 20);
    }
  }
}

TEST_CASE("an episode is served to one world where the protocol knows no connection from another") {
  const auto worlds = [](Protocol protocol) {
    ServeOptions options;
    options.keeps_episode = true;
    const auto choice =
        choose_server(protocol, "//127.0.0.1:9?" + options_for_served(protocol, options));
    REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
    return choice->profile.worlds;
  };
  for (const Protocol protocol : {Protocol::kGr00t, Protocol::kOpenVla, Protocol::kLeRobot})
    CHECK(worlds(protocol) == WorldsAtOnce::kOne);
  for (const Protocol protocol : {Protocol::kOpenpi, Protocol::kIntact, Protocol::kStarVla})
    CHECK(worlds(protocol) == WorldsAtOnce::kMany);
}

TEST_CASE("a dialect is one of the protocol's own, asking and serving") {
  for (const Protocol protocol : all_protocols()) {
    CAPTURE(std::string(to_word(protocol)));
    ServeOptions options;
    options.policy = serve_null().value();
    options.dialect = "yaml";
    const auto served = serve(protocol, options);
    REQUIRE_FALSE(served.ok());
    CHECK(served.failure().code == Fault::kUsage);
    CHECK(served.failure().where == "--dialect");
    auto choice = choose_server(protocol, "//127.0.0.1:9?" + options_for_served(protocol, options));
    REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
    const auto asking = make_transport(*choice);
    REQUIRE_FALSE(asking.ok());
    CHECK(asking.failure().message == served.failure().message);
    for (const std::string_view known : row_of(protocol).dialects) {
      options.dialect = known;
      CHECK(serve(protocol, options).ok());
      choice->profile.dialect = known;
      CHECK(make_transport(*choice).ok());
    }
  }
  CHECK(check_dialect(Protocol::kOpenpi, "yaml", "").failure().message ==
        "there is no `dialect` of an openpi server, so it cannot be `yaml`");
}

TEST_CASE("a server listens at a name, too; one that nobody knows is refused") {
  ServeOptions options;
  options.policy = serve_null().value();
  options.address = "localhost";
  for (const Protocol protocol : all_protocols()) {
    CAPTURE(std::string(to_word(protocol)));
    const auto listener = serve(protocol, options);
    CHECK_MESSAGE(listener.ok(), (listener.ok() ? "" : to_text(listener.failure())));
  }
  options.address = "no such host";
  const auto refused = serve(Protocol::kOpenpi, options);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().code == Fault::kUsage);
  CHECK(refused.failure().where == "--address");
}

TEST_CASE("served over TLS, a policy reads as it does plain, and only for whoever trusts it") {
  const Certificate certificate;
  int secured = 0;
  for (const Protocol protocol : all_protocols()) {
    if (!goes_over_urls(protocol)) continue;
    CAPTURE(std::string(to_word(protocol)));
    ++secured;
    ServeOptions options;
    options.policy = serve_digest().value();
    options.tls = certificate.files();
    const auto listener = serve(protocol, options);
    REQUIRE_MESSAGE(listener.ok(), to_text(listener.failure()));
    const std::string place = "127.0.0.1:" + (*listener)->port();
    std::string address = address_of_served(protocol, options, place);
    const bool is_http = row_of(protocol).carrier == Carrier::kHttp;
    CHECK(address.find((is_http ? "https://" : "wss://") + place +
                       "?protocol=" + std::string(to_word(protocol)) + "&") == 0);
    address += "&timeout.wait_s=0.05";
    const auto trusting = run::server_choice(address + "&ca=" + certificate.authority());
    REQUIRE_MESSAGE(trusting.ok(), to_text(trusting.failure()));
    const auto reading = prove_reading(*trusting);
    REQUIRE_MESSAGE(reading.ok(), to_text(reading.failure()));
    CHECK(reading->failure.empty());
    CHECK(reading->answers == 3);
    CHECK_FALSE(reading->is_deaf);
    CHECK_FALSE(reading->is_blind);

    const auto refusal = [](const std::string& asked) {
      const auto choice = run::server_choice(asked);
      REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
      const auto transport = make_transport(*choice);
      REQUIRE(transport.ok());
      auto said = (*transport)->open({});
      // Over HTTP the first question connects.
      if (said) {
        Request request;
        request.images.push_back({"image", wire::array_u8({1, 1, 3}, wire::Bytes(3))});
        const auto answer = (*transport)->ask(request, {});
        if (!answer) said = answer.failure();
      }
      return said.ok() ? std::string() : said.failure().message;
    };
    CHECK(refusal(address).find("the certificate is signed by none of the system's authorities") ==
          0);
    const std::string plain = "ws" + address.substr(address.find("://"));
    if (!is_http) {
      CHECK(refusal(plain) == "the server speaks TLS: its address begins with wss://127.0.0.1:" +
                                  (*listener)->port());
    }
  }
  CHECK(secured >= 6);
}

TEST_CASE("a server shows no certificate that is not one, and none where no URL goes") {
  const Certificate certificate, other;
  const auto refusal = [](Protocol protocol, const wire::TlsFiles& files) {
    ServeOptions options;
    options.policy = serve_null().value();
    options.tls = files;
    const auto refused = serve(protocol, options);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.failure().code == Fault::kUsage);
    return to_text(refused.failure());
  };
  const wire::TlsFiles good = certificate.files();
  const Protocol openpi = Protocol::kOpenpi;
  CHECK(refusal(openpi, {good.certificate, ""}) ==
        "--tls-cert: a certificate is shown with its key: add --tls-key FILE");
  CHECK(refusal(openpi, {"", good.key}) ==
        "--tls-key: a key is of a certificate: add --tls-cert FILE");
  CHECK(refusal(openpi, {"/nowhere.pem", good.key}) == "/nowhere.pem: is no file");
  CHECK(refusal(openpi, {good.key, good.key}).find(good.key + ": holds no certificate (PEM): ") ==
        0);
  CHECK(refusal(openpi, {good.certificate, good.certificate})
            .find(good.certificate + ": holds no key (PEM): ") == 0);
  CHECK(refusal(openpi, {good.certificate, other.files().key}) ==
        other.files().key + ": is not the key of the certificate `" + good.certificate + "`");
  for (const Protocol protocol : all_protocols()) {
    if (goes_over_urls(protocol)) continue;
    CHECK(refusal(protocol, good) == "--tls-cert: protocol " + std::string(to_word(protocol)) +
                                         " is spoken plain: it goes over no wss:// or https://");
  }
}

TEST_CASE("a port that is taken, and one that is none, are refused") {
  ServeOptions options;
  options.policy = serve_null().value();
  for (const Protocol protocol : all_protocols()) {
    CAPTURE(std::string(to_word(protocol)));
    options.port = "0";
    const auto first = serve(protocol, options);
    REQUIRE_MESSAGE(first.ok(), to_text(first.failure()));
    options.port = (*first)->port();
    const auto second = serve(protocol, options);
    REQUIRE_FALSE(second.ok());
    CHECK(second.failure().code == Fault::kUsage);
    CHECK(second.failure().message.starts_with("listening: "));
    for (const char* none : {"70000", "http", "-1", ""}) {
      options.port = none;
      const auto refused = serve(protocol, options);
      REQUIRE_FALSE(refused.ok());
      CHECK(to_text(refused.failure()) ==
            "--port: `" + std::string(none) + "` is no port from 0 to 65535");
    }
  }
}

}  // namespace probe::servers
