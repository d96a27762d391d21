// starVLA's messages byte by byte, and its client against a server of the same rules.
#include <doctest/doctest.h>

#include "runtime/servers/served.h"
#include "runtime/servers/servers.h"
#include "runtime/wire/msgpack.h"
#include "tests/hex.h"
#include "tests/runtime/servers/asking.h"

namespace probe::servers {
namespace {

// Greets with what it is given, keeps what it is asked and answers always the same.
class Fixed final : public wire::Speaker {
 public:
  Fixed(wire::Value metadata, wire::Value answer, std::shared_ptr<wire::Bytes> asked)
      : metadata_(std::move(metadata)), answer_(std::move(answer)), asked_(std::move(asked)) {}
  std::vector<wire::Frame> greet() override { return {packed(metadata_)}; }
  Reply answer(const wire::Frame& frame) override {
    *asked_ = frame.bytes;
    return {{packed(answer_)}};
  }

 private:
  static wire::Frame packed(const wire::Value& value) {
    return {false, wire::to_msgpack(value, wire::ArrayStyle::kBinKeys)};
  }
  wire::Value metadata_, answer_;
  std::shared_ptr<wire::Bytes> asked_;
};

struct Asking {
  std::shared_ptr<wire::Bytes> asked = std::make_shared<wire::Bytes>();
  std::unique_ptr<wire::Listener> listener;

  Asking(const wire::Value& metadata, const wire::Value& answer) {
    auto made = wire::listen_websocket("127.0.0.1", "0", [metadata, answer, kept = asked] {
      return std::make_unique<Fixed>(metadata, answer, kept);
    });
    REQUIRE_MESSAGE(made.ok(), to_text(made.failure()));
    listener = std::move(*made);
  }

  std::unique_ptr<Transport> transport() const {
    auto choice = choose_server(Protocol::kStarVla, "//127.0.0.1:" + listener->port());
    REQUIRE_MESSAGE(choice.ok(), to_text(choice.failure()));
    auto transport = make_transport(*choice);
    REQUIRE(transport.ok());
    return std::move(transport).value();
  }
};

Request small_starvla_request() {
  Request request;
  request.prompt = "go";
  request.images.push_back({"image", wire::array_u8({1, 2, 3}, {0, 1, 2, 3, 4, 5})});
  return request;
}

wire::Value good_answer() {
  return wire::Map{
      {"status", "ok"},
      {"data", wire::Map{{"actions", wire::array_f64({1, 2, 7}, {1, 2, 3, 4, 5, 6, 7,  //
                                                                 8, 9, 0, 1, 2, 3, 4})}}}};
}

}  // namespace

TEST_CASE("a starVLA question has the bytes that Python's client sends, and actions of a batch") {
  const Asking server(wire::Map{}, good_answer());
  const auto transport = server.transport();
  const auto open = transport->open({});
  REQUIRE_MESSAGE(open.ok(), to_text(open.failure()));
  const auto actions = transport->ask(small_starvla_request(), {});
  REQUIRE_MESSAGE(actions.ok(), to_text(actions.failure()));
  CHECK(*actions == std::vector<RawAction>{{1, 2, 3, 4, 5, 6, 7}, {8, 9, 0, 1, 2, 3, 4}});
  // The same from python3-msgpack 1.0.3 with openpi's form of arrays.
  CHECK(
      *server.asked ==
      test::from_hex(
          "83a474797065a5696e666572aa726571756573745f6964a131a77061796c6f616485a86578616d706c657391"
          "82a5696d6167659184c40b5f5f6e6461727261795f5fc3c40464617461c406000102030405c4056474797065"
          "a37c7531c405736861706593010203a46c616e67a2676fa9646f5f73616d706c65c2a87573655f6464696dc3"
          "ae6e756d5f6464696d5f73746570730aaa756e6e6f726d5f6b6579aa6f78655f627269646765"));
}

TEST_CASE("a starVLA answer that is another question's is not taken for this one's") {
  const auto numbered = [](const char* number) {
    wire::Map answer = *good_answer().as<wire::Map>();
    answer.emplace_back("request_id", number);
    return wire::Value(std::move(answer));
  };
  const Asking server(wire::Map{}, numbered("2"));
  const auto transport = server.transport();
  REQUIRE(transport->open({}).ok());
  CHECK(transport->ask(small_starvla_request(), {}).failure().message ==
        "an answer to another question: expected request_id `1`, got `2`");
  CHECK(transport->ask(small_starvla_request(), {}).ok());
}

TEST_CASE("starVLA's errors are maps, and statistics that it does not have are refused") {
  {
    const Asking server(wire::Map{}, wire::Map{{"status", "error"},
                                               {"error", wire::Map{{"message", "KeyError: 'x'"}}}});
    const auto transport = server.transport();
    REQUIRE(transport->open({}).ok());
    CHECK(transport->ask(small_starvla_request(), {}).failure().message ==
          "the server failed: KeyError: 'x'");
  }
  {
    const Asking server(wire::Map{}, wire::Map{{"data", wire::Map{{"normalized_actions", 1}}}});
    const auto transport = server.transport();
    REQUIRE(transport->open({}).ok());
    CHECK(transport->ask(small_starvla_request(), {})
              .failure()
              .message.find("a map with keys normalized_actions") != std::string::npos);
  }
  const Asking server(wire::Map{{"available_unnorm_keys", wire::List{"oxe_rt1", "libero"}}},
                      good_answer());
  const auto refused = server.transport()->open({});
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.failure().code == Fault::kUsage);
  CHECK(refused.failure().message ==
        "the server has statistics of `oxe_rt1`, `libero`, and the profile's `unnorm_key` is "
        "`oxe_bridge`");
}

}  // namespace probe::servers
