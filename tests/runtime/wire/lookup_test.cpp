// Name servers that are slow, silent or wrong, by resolvers of our own.
#include "runtime/wire/lookup.h"

#include <doctest/doctest.h>

#include <condition_variable>
#include <memory>
#include <mutex>

#include "runtime/wire/http.h"
#include "runtime/wire/websocket.h"
#include "runtime/wire/zmq.h"
#include "tests/servers/python_server.h"

namespace probe::wire {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// Does not come back before it is let go, as getaddrinfo does whose name server is silent.
class Silent {
 public:
  Resolver resolver() const {
    return [state = state_](const std::string&, const std::string&) {
      std::unique_lock lock(state->mutex);
      ++state->asked;
      state->changed.notify_all();
      state->changed.wait(lock, [&] { return state->is_over; });
      return Result<std::vector<Address>>(std::vector<Address>{{"127.0.0.1", 1}});
    };
  }
  int asked() const {
    const std::lock_guard lock(state_->mutex);
    return state_->asked;
  }
  ~Silent() {
    const std::lock_guard lock(state_->mutex);
    state_->is_over = true;
    state_->changed.notify_all();
  }

 private:
  struct State {
    std::mutex mutex;
    std::condition_variable changed;
    bool is_over = false;
    int asked = 0;
  };
  std::shared_ptr<State> state_ = std::make_shared<State>();
};

const Endpoint kServer{"policy.example", "8000", "/", {}};
constexpr const char* kSlow = "looking up the host took more than 0.2 s";

}  // namespace

TEST_CASE("an address written as numbers is there at once, whatever the system's resolver does") {
  for (const char* ip : {"127.0.0.1", "::1"}) {
    const auto found = look_up({ip, "8000", "/", {}}, Duration(0), Duration(0));
    REQUIRE_MESSAGE(found.ok(), to_text(found.failure()));
    CHECK(*found == std::vector<Address>{{ip, 8000}});
  }
}

TEST_CASE("a name server that never answers does not outlive the time for connecting") {
  const Silent silent;
  const auto begun = Clock::now();
  const auto http = http_exchange(
      kServer, {}, {.connect_timeout = 200ms, .timeout = 30s, .resolver = silent.resolver()});
  REQUIRE_FALSE(http.ok());
  CHECK(to_text(http.failure()) == std::string("policy.example:8000: ") + kSlow);
  CHECK(http.failure().code == Fault::kPolicy);

  const auto socket = WebSocket::connect(
      kServer, {.connect_timeout = 200ms, .headers = {}, .resolver = silent.resolver()});
  REQUIRE_FALSE(socket.ok());
  CHECK(socket.failure().message == kSlow);

  {
    auto zmq =
        ZmqRequester::create(kServer, {.connect_timeout = 200ms, .resolver = silent.resolver()});
    REQUIRE(zmq.ok());
    const auto answer = (*zmq)->ask({}, 30s);
    REQUIRE_FALSE(answer.ok());
    CHECK(answer.failure().message == kSlow);
  }
  CHECK(Clock::now() - begun < 10s);
  CHECK(silent.asked() == 3);
}

TEST_CASE("what a resolver says is told with the host, and no address is a failure too") {
  const auto failing = [](const std::string& host, const std::string& port) {
    CHECK(host == "policy.example");
    CHECK(port == "8000");
    return Result<std::vector<Address>>(Failure{Fault::kPolicy, "SERVFAIL", ""});
  };
  CHECK(to_text(look_up(kServer, 5s, 5s, failing).failure()) ==
        "policy.example:8000: looking up the host: SERVFAIL");
  const auto none = [](const std::string&, const std::string&) {
    return Result<std::vector<Address>>(std::vector<Address>());
  };
  CHECK(look_up(kServer, 5s, 5s, none).failure().message ==
        "looking up the host: it has no address");
}

TEST_CASE("the system's resolver knows numbers and this machine, and says what it does not know") {
  const auto v4 = system_resolver("127.0.0.1", "80");
  REQUIRE(v4.ok());
  CHECK(v4->front() == Address{"127.0.0.1", 80});
  CHECK(system_resolver("::1", "5555")->front() == Address{"::1", 5555});
  CHECK_FALSE(system_resolver("no such host", "80").ok());
}

TEST_CASE(
    "an address that a resolver gives is connected to, the next one where it does not answer") {
  const test::PythonServer server("http_server.py");
  REQUIRE_FALSE(server.port().empty());
  const auto port = static_cast<std::uint16_t>(std::stoi(server.port()));
  const auto both = [port](const std::string&, const std::string&) {
    return Result<std::vector<Address>>(
        std::vector<Address>{{"127.0.0.1", 1}, {"127.0.0.1", port}});
  };
  HttpRequest request;
  request.path = "/echo";
  const auto answer = http_exchange(kServer, request, {.resolver = both});
  REQUIRE_MESSAGE(answer.ok(), to_text(answer.failure()));
  CHECK(answer->status == 200);
}

}  // namespace probe::wire
