#include "runtime/wire/json.h"

#include <doctest/doctest.h>

#include <limits>
#include <string>

#include "runtime/wire/base64.h"

namespace probe::wire {

TEST_CASE("base64 of every length is read back") {
  std::vector<std::uint8_t> bytes;
  for (int size = 0; size < 70; ++size) {
    const auto back = from_base64(to_base64(bytes));
    REQUIRE(back.has_value());
    CHECK(*back == bytes);
    bytes.push_back(static_cast<std::uint8_t>(251 * size + 7));
  }
  CHECK(to_base64(std::vector<std::uint8_t>{'M'}) == "TQ==");
  CHECK(to_base64(std::vector<std::uint8_t>{0xfb, 0xff}) == "+/8=");
}

TEST_CASE("what is no base64 is refused") {
  for (const char* text : {"A", "AA", "AAA", "AA=A", "=AAA", "A===", "AAAA====", "AA A", "AA-_"}) {
    CHECK_MESSAGE(!from_base64(text).has_value(), text);
  }
}

TEST_CASE("an OpenVLA request has json_numpy's text") {
  // Made with Python: json.dumps({"image": array, "instruction": ...}) of a u8 [1, 2, 3] array
  // 0..5, encoded as json_numpy does.
  const Value request =
      Map{{"image", array_u8({1, 2, 3}, {0, 1, 2, 3, 4, 5})}, {"instruction", "put \"it\" down"}};
  const std::string text =
      "{\"image\": {\"__numpy__\": \"AAECAwQF\", \"dtype\": \"|u1\", \"shape\": [1, 2, 3]}, "
      "\"instruction\": \"put \\\"it\\\" down\"}";
  CHECK(to_json(request) == text);
  const auto back = from_json(text);
  REQUIRE(back.ok());
  CHECK(*back == request);
}

TEST_CASE("numbers keep all their bits as text") {
  const Value numbers = List{0.1, 1.0, -0.0, 1e300, 5e-324, 3, Value(), true};
  CHECK(to_json(numbers) == "[0.1, 1.0, -0.0, 1e+300, 5e-324, 3, null, true]");
  const auto back = from_json(to_json(numbers));
  REQUIRE(back.ok());
  CHECK(*back == numbers);
  CHECK(to_json(std::numeric_limits<double>::quiet_NaN()) == "NaN");
}

TEST_CASE("what is no JSON or no array is refused with what it was") {
  CHECK(from_json("Internal Server Error").failure().message ==
        "no JSON but the text \"Internal Server Error\"");
  CHECK_FALSE(from_json("").ok());
  CHECK_FALSE(from_json("[1, NaN]").ok());
  CHECK_FALSE(from_json("{} {}").ok());
  CHECK(from_json(std::string(100, '[') + std::string(100, ']')).failure().message ==
        "JSON of more than 64 levels");
  std::string many = "[";
  for (int i = 0; i < 1 << 20; ++i) many += "0,";
  CHECK(from_json(many + "0]").failure().message == "JSON of more than 1048576 values");
  CHECK(from_json("\"" + many + many + "\"").ok());
  CHECK(from_json(R"({"__numpy__": "AAAA", "dtype": "|u1", "shape": [7]})").failure().message ==
        "an array of shape 7 and dtype |u1 has 3 bytes");
  CHECK_FALSE(from_json(R"({"__numpy__": "AAAA", "dtype": "|u1"})").ok());
  CHECK_FALSE(from_json(R"({"__numpy__": "A?AA", "dtype": "|u1", "shape": [3]})").ok());
  CHECK_FALSE(from_json(R"({"__numpy__": "AAAA", "dtype": "|u1", "shape": [-3]})").ok());
}

}  // namespace probe::wire
