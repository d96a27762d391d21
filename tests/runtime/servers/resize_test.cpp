// Resizing against Pillow 9.4's own bytes (Image.resize with BILINEAR), made once with Debian's
// python3-pil.
#include "runtime/servers/resize.h"

#include <doctest/doctest.h>

#include <cstring>

#include "runtime/base/sha256.h"

namespace probe::servers {
using namespace probe::policy;
namespace {

wire::Bytes small_picture() {  // 7 x 5
  wire::Bytes bytes(7 * 5 * 3);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(i * 37 + i * i % 91);
  }
  return bytes;
}

wire::Bytes camera_picture() {  // 640 x 480
  wire::Bytes bytes;
  for (std::size_t y = 0; y < 480; ++y) {
    for (std::size_t x = 0; x < 640; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        bytes.push_back(static_cast<std::uint8_t>(x * 3 + y * 5 + c * 71 + x * y % 97));
      }
    }
  }
  return bytes;
}

std::string hash_of(const wire::Bytes& bytes) {
  return to_hex(sha256(std::as_bytes(std::span(bytes))));
}

}  // namespace

TEST_CASE("smaller, larger and one-sided sizes are Pillow's to the bit") {
  const wire::Bytes bytes = small_picture();
  const Image image{7, 5, bytes};
  CHECK(hash_of(resize_bilinear(image, 3, 2)) ==
        "b3ef364d5788e794dc8186ca1d85a5bd9ffcc82d765bf45301fb9c5df3767c32");
  CHECK(hash_of(resize_bilinear(image, 4, 5)) ==
        "c9b6506fc3f9cb3f0f17b94d7297beb568ea4b7372c98b543b353f47c9aaafb0");
  CHECK(hash_of(resize_bilinear(image, 10, 8)) ==
        "1f9409b7f96bc179e86103500db3486dba5477162892ffba5d317a34e43188d5");
  CHECK(hash_of(resize_bilinear(image, 7, 3)) ==
        "5a9b38b8f957a840cf14bb97f721de06f7ab86a14db915149cff3a758c1500bb");
  CHECK(resize_bilinear(image, 7, 5) == bytes);
}

TEST_CASE("a camera's picture is padded, stretched and cropped as the clients in Python do") {
  const wire::Bytes bytes = camera_picture();
  REQUIRE(hash_of(bytes) == "48213846b286b5d28566e587551ac3b47bf7ba7c3916091a11fee1fb2a2f13d0");
  const Image image{640, 480, bytes};
  const wire::Array padded = to_pixels(image, {"", "k", 224, 224, Resize::kPad});
  CHECK(padded.shape == std::vector<std::int64_t>{224, 224, 3});
  CHECK(hash_of(padded.bytes) ==
        "2a8fda23f13855dbe9bb0a19db8a552923c2ae299774b7f7a29aa988ab9eebbf");
  CHECK(hash_of(to_pixels(image, {"", "k", 256, 256, Resize::kStretch}).bytes) ==
        "2271bb3c79a4a95d64d59994cd82ef7f18ab6953ab620880761723c0ab732e5b");
  CHECK(hash_of(to_pixels(image, {"", "k", 224, 224, Resize::kCrop}).bytes) ==
        "8350569d25dd9bde40d0ee67310fe2589ea9d34341c1dd4672903914d021662f");
  CHECK(to_pixels(image, {"", "k"}).bytes == bytes);
}

TEST_CASE("a channel-first picture has fractions of 255") {
  const wire::Bytes bytes{0, 51, 255, 102, 0, 0};
  const wire::Array array =
      to_pixels({2, 1, bytes}, {"", "k", 0, 0, Resize::kNone, PixelLayout::kChwF32});
  CHECK(array.shape == std::vector<std::int64_t>{3, 1, 2});
  CHECK(array.dtype == "<f4");
  const auto numbers = wire::to_numbers(array);
  REQUIRE(numbers.ok());
  CHECK((*numbers)[0] == 0);
  CHECK((*numbers)[1] == doctest::Approx(0.4));
  CHECK((*numbers)[2] == doctest::Approx(0.2));
  CHECK((*numbers)[4] == 1);
}

}  // namespace probe::servers
