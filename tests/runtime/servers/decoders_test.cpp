// Thousands of damaged messages through everything that reads what a server sends: a Failure or a
// value, never a crash, and what is shown of it is fit to be stored.
#include <doctest/doctest.h>

#include <functional>

#include "runtime/base/json.h"
#include "runtime/servers/protocols/gr00t.h"
#include "runtime/servers/protocols/lerobot_messages.h"
#include "runtime/servers/protocols/openvla.h"
#include "runtime/servers/protocols/vlaeval_messages.h"
#include "runtime/wire/json.h"
#include "runtime/wire/msgpack.h"

namespace probe::servers {
using namespace probe::policy;
namespace {

using wire::Bytes;

// Flips, cuts, repeats and swaps: one to four changes of a good message.
Bytes damaged(const Bytes& good, Draws& draws) {
  Bytes bytes = good;
  const auto at = [&] { return static_cast<std::size_t>(draws.next() % bytes.size()); };
  for (std::uint64_t changes = 1 + draws.next() % 4; changes > 0 && !bytes.empty(); --changes) {
    switch (draws.next() % 5) {
      case 0:
        bytes[at()] = static_cast<std::uint8_t>(draws.next());
        break;
      case 1:
        bytes[at()] ^= static_cast<std::uint8_t>(1u << draws.next() % 8);
        break;
      case 2:
        bytes.resize(at());
        break;
      case 3: {
        const std::size_t begin = at();
        const std::size_t count = std::min<std::size_t>(bytes.size() - begin, 1 + draws.next() % 9);
        const Bytes part(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                         bytes.begin() + static_cast<std::ptrdiff_t>(begin + count));
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at()), part.begin(), part.end());
        break;
      }
      default:
        // What lengths and types are made of.
        bytes[at()] = std::array<std::uint8_t, 8>{
            0xdf, 0xdd, 0xc6, 0xcf, 0xff, 0x7f, 0x80, 0xc1}[draws.next() % 8];
        break;
    }
  }
  return bytes;
}

// How many of `count` damaged forms of `good` are refused. A refusal's text has to be JSON's.
int refused(const Bytes& good, int count, std::uint64_t key,
            const std::function<Status(const Bytes&)>& read) {
  REQUIRE(read(good).ok());
  Draws draws(key);
  int failures = 0;
  for (int i = 0; i < count; ++i) {
    const Status status = read(damaged(good, draws));
    if (status.ok()) continue;
    ++failures;
    REQUIRE_FALSE(status.failure().message.empty());
    REQUIRE(status.failure().message.size() < 2000);
    REQUIRE_NOTHROW(Json(status.failure().message).dump());
  }
  return failures;
}

template <typename T>
Status status_of(const Result<T>& result) {
  return result ? Status() : Status(result.failure());
}

wire::Array actions() { return wire::array_f64({1, 7}, {0.1, 0.2, 0.3, 0, 0, 0, 1}); }

constexpr int kCount = 4000;

}  // namespace

TEST_CASE("damaged messages of openpi and INT-ACT are refused or read") {
  const Bytes good = wire::to_msgpack(
      wire::Map{{"actions", actions()}, {"server_timing", wire::Map{{"infer_ms", 1.5}}}},
      wire::ArrayStyle::kBinKeys);
  const int failures = refused(good, kCount, 1, [](const Bytes& bytes) -> Status {
    PROBE_ASSIGN(const wire::Value value, wire::from_msgpack(bytes));
    const wire::Value* found = value.find("actions");
    return status_of(to_actions(found == nullptr ? value : *found));
  });
  CHECK(failures > kCount / 4);
}

TEST_CASE("damaged messages of vla-eval are refused or read") {
  const Bytes good =
      vlaeval::to_bytes({"action", wire::Map{{"actions", actions()}, {"note", "text"}}, 7}, 1.5);
  const int failures = refused(good, kCount, 2, [](const Bytes& bytes) -> Status {
    PROBE_ASSIGN(const vlaeval::Message message, vlaeval::from_bytes(bytes));
    const wire::Value* found = message.payload.find("actions");
    return status_of(to_actions(found == nullptr ? message.payload : *found));
  });
  CHECK(failures > kCount / 4);
}

TEST_CASE("damaged messages of GR00T are refused or read") {
  wire::Map map;
  for (const char* name : {"x", "y", "z", "roll", "pitch", "yaw", "gripper"}) {
    map.emplace_back("action." + std::string(name), wire::array_f32({1, 2, 1}, {0.5, 1}));
  }
  const Bytes good =
      wire::to_msgpack(wire::List{std::move(map), wire::Map{}}, wire::ArrayStyle::kNpy);
  const int failures = refused(good, kCount, 3, [](const Bytes& bytes) -> Status {
    PROBE_ASSIGN(const wire::Value value, wire::from_msgpack(bytes));
    return status_of(gr00t_actions(value));
  });
  CHECK(failures > kCount / 8);
}

TEST_CASE("damaged messages of OpenVLA are refused or read") {
  for (const bool is_encoded : {false, true}) {
    std::string text = wire::to_json(actions());
    if (is_encoded) text = wire::to_json(text);
    const int failures =
        refused(Bytes(text.begin(), text.end()), kCount, 4, [](const Bytes& bytes) {
          return status_of(openvla_actions(std::string(bytes.begin(), bytes.end())));
        });
    CHECK(failures > kCount / 4);
  }
}

TEST_CASE("damaged messages of LeRobot are refused or read, and a cut one is refused") {
  const wire::Array action = wire::array_f64({7}, {0.1, 0.2, 0.3, 0, 0, 0, 1});
  const Bytes good = lerobot::actions_message({{0, 7, action}, {0.03, 8, action}});
  const auto read = [](const Bytes& bytes) { return status_of(lerobot::actions_of(bytes, 4096)); };
  const int failures = refused(good, kCount, 5, read);
  CHECK(failures > kCount / 4);
  for (std::size_t size = 1; size < good.size(); ++size)
    REQUIRE_FALSE(read({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}).ok());

  const wire::GrpcCall sent =
      lerobot::send_observation({1,
                                 2,
                                 {{"state.0", 0.5},
                                  {"image", wire::array_u8({2, 1, 3}, {1, 2, 3, 4, 5, 6})},
                                  {"task", "put"}}});
  REQUIRE(sent.messages.size() == 1);
  CHECK(refused(sent.messages.front(), kCount, 6, [](const Bytes& bytes) {
          return status_of(lerobot::observation_of({lerobot::kSendObservations, {bytes}}));
        }) > kCount / 4);
  const wire::GrpcCall setup =
      lerobot::send_policy({"act", "/m", "cpu", 4, {{"a", wire::List{1}}}});
  CHECK(refused(setup.messages.front(), kCount, 7, [](const Bytes& bytes) {
          return status_of(lerobot::setup_of({lerobot::kSendPolicy, {bytes}}));
        }) > kCount / 4);
}

}  // namespace probe::servers
