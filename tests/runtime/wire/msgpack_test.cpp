#include "runtime/wire/msgpack.h"

#include <doctest/doctest.h>

#include <cmath>

#include <string>
#include <string_view>

#include "tests/hex.h"

namespace probe::wire {
namespace {

using test::from_hex;

// Made with Debian 12's python3-msgpack 1.0.3 and python3-numpy 1.24.2 by openpi's encoding.
const char* const kObservation =
    "83 b16f62736572766174696f6e2f696d616765 84 c40b5f5f6e6461727261795f5f c3 c40464617461 c40c"
    "000102030405060708090a0b c4056474797065 a37c7531 c4057368617065 93020203"
    "b16f62736572766174696f6e2f7374617465 84 c40b5f5f6e6461727261795f5f c3 c40464617461 c408"
    "0000803f00000040 c4056474797065 a33c6634 c4057368617065 9102"
    "a670726f6d7074 b370757420636172726f74206f6e20706c617465";

Value observation() {
  return Map{{"observation/image", array_u8({2, 2, 3}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11})},
             {"observation/state", array_f32({2}, {1, 2})},
             {"prompt", "put carrot on plate"}};
}

}  // namespace

TEST_CASE("an observation has openpi's bytes") {
  CHECK(to_msgpack(observation(), ArrayStyle::kBinKeys) == from_hex(kObservation));
  CHECK(to_msgpack(Map{}, ArrayStyle::kBinKeys) == from_hex("80"));
}

TEST_CASE("INT-ACT's requests have their bytes") {
  CHECK(to_msgpack(Map{{"new_model_path", "/m"}}, ArrayStyle::kBinKeys) ==
        from_hex("81ae6e65775f6d6f64656c5f70617468a22f6d"));
  CHECK(to_msgpack(Map{{"reset", true}}, ArrayStyle::kBinKeys) == from_hex("81a57265736574c3"));
}

TEST_CASE("a numpy scalar is read as its number") {
  const auto value =
      from_msgpack(from_hex("81a17883c40d5f5f6e7067656e657269635f5fc3c40464617461cb3fe0000000000000"
                            "c4056474797065a33c6634"));
  REQUIRE(value.ok());
  CHECK(*value == Value(Map{{"x", 0.5}}));
  const auto whole = from_msgpack(
      from_hex("81a17883c40d5f5f6e7067656e657269635f5fc3c4046461746107c4056474797065a33c6938"));
  REQUIRE(whole.ok());
  CHECK(*whole == Value(Map{{"x", 7}}));
}

TEST_CASE("every style of array is read back as it was written") {
  const Value message = Map{{"a", array_f64({2, 3}, {0, -1.5, 2, 3, 4, 1e300})},
                            {"empty", array_f32({0}, {})},
                            {"scalar", array_f64({}, {7})},
                            {"rest", List{Value(), true, -3, 2.5, "text", Bytes{1, 2}}}};
  for (const ArrayStyle style : {ArrayStyle::kBinKeys, ArrayStyle::kTextKeys, ArrayStyle::kNpy}) {
    const auto read = from_msgpack(to_msgpack(message, style));
    REQUIRE_MESSAGE(read.ok(), read.failure().message);
    CHECK(*read == message);
  }
}

TEST_CASE("a message cut anywhere is refused and never crashes") {
  for (const ArrayStyle style : {ArrayStyle::kBinKeys, ArrayStyle::kTextKeys, ArrayStyle::kNpy}) {
    const Bytes whole = to_msgpack(observation(), style);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      CHECK_FALSE(from_msgpack({whole.data(), size}).ok());
    }
  }
  Bytes longer = from_hex("80");
  longer.push_back(0x80);
  CHECK_FALSE(from_msgpack(longer).ok());
}

TEST_CASE("a message that claims more than it holds costs no memory") {
  CHECK_FALSE(from_msgpack(from_hex("ddffffffff")).ok());  // a list of 2^32 - 1
  CHECK_FALSE(from_msgpack(from_hex("dfffffffff")).ok());  // a map
  CHECK_FALSE(from_msgpack(from_hex("c6ffffffff")).ok());  // bytes
  CHECK_FALSE(from_msgpack(Bytes(100000, 0x91)).ok());     // lists in lists
}

TEST_CASE("a message of millions of values is refused before one of them is made") {
  const auto failure = [](const Bytes& bytes) {
    const auto read = from_msgpack(bytes);
    REQUIRE_FALSE(read.ok());
    return read.failure().message;
  };
  const std::string many = "a MessagePack message of more than 1048576 values";
  const Bytes head = from_hex("dcffff");
  for (const std::uint8_t value : from_hex("c0 90 80 a0 01 ff")) {
    Bytes lists = from_hex("dc0040");  // 64 lists of 65535 elements in a list
    for (int i = 0; i < 64; ++i) {
      lists.insert(lists.end(), head.begin(), head.end());
      lists.insert(lists.end(), 65535, value);
    }
    CHECK(failure(lists) == many);
  }
  // What stands in texts, bytes and numbers is no value.
  const Value large = Map{{"a", Bytes(3 << 20, 0xc0)},
                          {"b", std::string(3 << 20, 'x')},
                          {"c", array_f64({1 << 19}, std::vector<double>(1 << 19, -1.5))},
                          {"d", List(60000, Value(0.1))},
                          {"e", List(60000, Value(std::int64_t{1} << 40))}};
  const auto back = from_msgpack(to_msgpack(large, ArrayStyle::kTextKeys));
  REQUIRE_MESSAGE(back.ok(), (back ? "" : to_text(back.failure())));
  CHECK(*back == large);
  Array deep = array_u8({1}, {7});
  deep.shape.assign(33, 1);
  for (const ArrayStyle style : {ArrayStyle::kBinKeys, ArrayStyle::kNpy})
    CHECK_FALSE(from_msgpack(to_msgpack(deep, style)).ok());
}

TEST_CASE("an array whose bytes do not fit its shape is refused, naming both") {
  Array array = array_f32({4, 7}, std::vector<double>(28, 0.0));
  array.shape = {4, 8};
  const auto read = from_msgpack(to_msgpack(array, ArrayStyle::kBinKeys));
  REQUIRE_FALSE(read.ok());
  CHECK(read.failure().message == "an array of shape 4 x 8 and dtype <f4 has 112 bytes");
  array.shape = {std::int64_t{1} << 39, std::int64_t{1} << 39};
  CHECK_FALSE(from_msgpack(to_msgpack(array, ArrayStyle::kBinKeys)).ok());
}

TEST_CASE("numbers are read from arrays of any dtype, lists and nested lists") {
  const Array half{"<f2", {4}, {0x00, 0x3c, 0x00, 0xc0, 0x01, 0x00, 0xff, 0x7b}};
  const auto numbers = to_numbers(half);
  REQUIRE(numbers.ok());
  CHECK(*numbers == std::vector<double>{1, -2, 0x1p-24, 65504});
  const auto edges =
      to_numbers(Array{"<f2", {5}, {0x00, 0x7c, 0x00, 0xfc, 0x01, 0x7e, 0x00, 0x80, 0xff, 0x83}});
  REQUIRE(edges.ok());
  CHECK((*edges)[0] == INFINITY);
  CHECK((*edges)[1] == -INFINITY);
  CHECK(std::isnan((*edges)[2]));
  CHECK(std::signbit((*edges)[3]));
  CHECK((*edges)[4] == -1023 * 0x1p-24);  // the largest below the normal numbers
  const auto nested = to_numbers(List{List{1, 2.5}, List{array_f32({2}, {3, 4})}});
  REQUIRE(nested.ok());
  CHECK(*nested == std::vector<double>{1, 2.5, 3, 4});
  CHECK(shape_of(List{List{1, 2}, List{3, 4}}) == std::vector<std::int64_t>{2, 2});
  CHECK_FALSE(to_numbers("text").ok());
}

TEST_CASE("what an answer is can be said in a line without its control characters") {
  CHECK(describe(Map{{"actions", 1}, {"state", 2}}) == "a map with keys actions, state");
  CHECK(describe(array_f32({4, 7}, std::vector<double>(28, 0.0))) == "an array 4 x 7 of <f4");
  CHECK(describe("a\x1b[2Jb") == "the text \"a [2Jb\"");
  CHECK(describe(std::string(10000, 'x')).size() < 100);
  CHECK(describe(1e300) == "the number 1e+300");
  CHECK(describe(Array{"|u1", std::vector<std::int64_t>(9999, 1), {0}}).size() < 100);
}

}  // namespace probe::wire
