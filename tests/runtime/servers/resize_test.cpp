// Resizing against Pillow 9.4's and OpenCV 4.6's own bytes, made once with Debian's python3-pil and
// python3-opencv; against TensorFlow's formula in numpy's double precision
// (tests/servers/tf_lanczos3.py); JPEG against libjpeg-turbo 2.1.5's own bytes.
#include "runtime/servers/resize.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "runtime/base/sha256.h"
#include "runtime/servers/jpeg_round_trip.h"

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

TEST_CASE("LANCZOS is Pillow's, linear and area are OpenCV's, to the bit, smaller and larger") {
  // Of Pillow 9.4 and OpenCV 4.6, by Debian's python3-pil and python3-opencv.
  struct Made {
    bool is_small;
    int width, height;
    const char *lanczos, *linear, *area;
  };
  constexpr Made kMade[] = {
      {true, 3, 2, "dcd73a503e81f5cc7219b596f17240b701704b94f25843b2f3b1fb13f8c76227",
       "6156e9a5c5be63573ba0d82fe2e94710cb968d7d4fcab2660f7c8e2ccce6cfc6",
       "ea9e88e2ae69187acdc7212b2ece469e7f16d5a106c9417d458ec9e42be0ebf4"},
      {true, 4, 5, "2309db5f870a61571d3c0720e41996d194db3956cc0dc867759b61d4923df510",
       "18283a7d9e45ea8e8b4f5ba2f1df74fd66de8bb267179a10f96d43780d6dad3f",
       "748a4912462413c64d01bdd02b29429158faee13da5279e92215189609add656"},
      {true, 10, 8, "cb50498815cfdc727f4e8d2685cfd86f36f1bf9f177f862896ff6b4f4f54dc59",
       "e6768cb566fc5b2af75599360815d0b0636997a668a037a4e4db569a93d2a2c8",
       "acf48b960cab858302ae426b8d81ab32efc2179a5deeec34879fa0636845a976"},
      {true, 7, 3, "90199096e9a26f2f85fcf19e55b5696d47ec912fd97afaef9231c1d3300b23f8",
       "03b2e30e0055374b21618a71f554eae3a9558ec6096885b8a41e24191dc63959",
       "f1e76975d941e2076e7168037c6e6ae6b5495b5e5555dff3bb361e513a893b33"},
      {true, 14, 10, "fbf3dfc2b686bbc6e30628b7977133b11046b564055c90c3613aad1a0fe6c22c",
       "a215d2358507c893c90275974e87152a67744bb25c33bd3a0b6bdd1aa5b1dcda",
       "8008981cd86056273840ede618f4dcb5a0f5b66c2c823fdcd22792dbd8a44e33"},
      {false, 256, 256, "a00c2dbbb5b13bebee064ca1bb1f945430d244a4e29f0cd6c4ba0982c5581467",
       "c578abed3791afda16a34b037d43eb5c3d6994e4a4b52ff82ec813c19b43025b",
       "df7ac5f8bfcc77e2417c6fd4d634a6324b92b8905c789058e709c8e40e4b151f"},
      {false, 224, 224, "7c8bcf14f4ebe4f490fbf079b573317a674e7e9b5552defc908e8d51a7006dd7",
       "7204c62f8e45ae87c7a0b769b38a28860de4adc6a78441d76105001409166ee6",
       "25adf73d8ae00f4a00e0236f7690b69bf8307da5ac80799680f0db3e1636006e"},
      {false, 320, 240, "18e1a2de2a163a8488b3b374efccef4be5ab5a629954c5dfae9640aa864f3f01",
       "c1823ae1c6a886e4b9acfe966ce932eed2fa213a027ce26ec242b990809cc4d9",
       "c1823ae1c6a886e4b9acfe966ce932eed2fa213a027ce26ec242b990809cc4d9"},
      {false, 160, 120, "1c921d2e97c90f9dca63296c377ea7522b20782dc58ebf9cff226144c7d8e07f",
       "cd2ac0fe042caee2b125521ee582207c4b6f8fcdcb443fc69c8b25270ceebf02",
       "621a9da9f7d0f436b9901aecde2d634685e5669caa74b696f8b874d1b7afd03f"},
      {false, 800, 600, "dd7b72772e4a26009f274e31fa66992bc935a41cd20142f40ece03bb40e84ca4",
       "0ffa430fd9d645397fcf943c091270d471a01d4890fefc37c212c5ef622e7eaf",
       "f6917015ed47a63d789fe6ff36f4c531d509325af68d3d524c97264fb45a6a6b"},
      {false, 500, 480, "437fee0f4637746d2809cbc149d60bb5f96e6a9c7ad0658a2771c8494769ff32",
       "baa9ed9b0a00d0b2e57a50df15a8ff5b744f6af2e1d13c5a768638a86bf965be",
       "c55a69072e2ba9ecd9abe892dc53b9b210326931e071469b833359db26834265"},
  };
  const wire::Bytes small = small_picture(), large = camera_picture();
  for (const Made& made : kMade) {
    CAPTURE(made.width);
    CAPTURE(made.height);
    const Image image = made.is_small ? Image{7, 5, small} : Image{640, 480, large};
    CHECK(hash_of(resize_lanczos(image, made.width, made.height)) == made.lanczos);
    CHECK(hash_of(resize_cv2_linear(image, made.width, made.height)) == made.linear);
    CHECK(hash_of(resize_cv2_area(image, made.width, made.height)) == made.area);
  }
  const Image image{640, 480, large};
  CHECK(to_pixels(image, {"", "k", 224, 224, Resize::kCv2Linear}).bytes ==
        resize_cv2_linear(image, 224, 224));
  CHECK(to_pixels(image, {"", "k", 224, 224, Resize::kCv2Area}).bytes ==
        resize_cv2_area(image, 224, 224));
  CHECK(to_pixels(image, {"", "k", 224, 224, Resize::kLanczos}).bytes ==
        resize_lanczos(image, 224, 224));
}

TEST_CASE("lanczos3 is TensorFlow's formula to a level, smaller and larger") {
  std::ifstream rows(std::string(VLAPROBE_SOURCE_DIR) + "/tests/runtime/servers/tf_lanczos3.txt");
  const wire::Bytes small = small_picture(), large = camera_picture();
  int read = 0, apart = 0, numbers = 0;
  std::string line, last;
  wire::Bytes resized;
  while (std::getline(rows, line)) {
    std::istringstream words(line);
    std::string name, hex;
    int width = 0, height = 0;
    std::size_t row = 0;
    words >> name >> width >> height >> row >> hex;
    const std::string size = name + " " + std::to_string(width) + "x" + std::to_string(height);
    CAPTURE(size);
    const bool is_small = name == "small";
    if (size != last)
      resized =
          resize_tf_lanczos3(is_small ? Image{7, 5, small} : Image{640, 480, large}, width, height);
    last = size;
    REQUIRE(resized.size() ==
            static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
    const std::size_t bytes = static_cast<std::size_t>(width) * 3;
    REQUIRE(hex.size() == 2 * bytes);
    int farthest = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
      const int wanted = std::stoi(hex.substr(2 * i, 2), nullptr, 16);
      const int off = std::abs(resized[row * bytes + i] - wanted);
      farthest = std::max(farthest, off);
      apart += off > 0 ? 1 : 0;
    }
    CHECK(farthest <= 1);
    numbers += static_cast<int>(bytes);
    ++read;
  }
  CHECK(read == 42);
  // Halves, which floats and doubles round otherwise.
  CHECK(apart * 200 < numbers);
  const Image image{640, 480, large};
  CHECK(to_pixels(image, {"", "k", 224, 224, Resize::kTfLanczos3}).bytes ==
        resize_tf_lanczos3(image, 224, 224));
}

TEST_CASE("a picture through JPEG is libjpeg-turbo's to the bit, whatever its size") {
  struct Made {
    int width, height;
    const char* hash;
  };
  constexpr Made kMade[] = {
      {640, 480, "7fd1bcb806a87dc51e20ce9e9950f06f04a1815d826e6a5683363afc7c043bfd"},
      {224, 224, "20270cd67d71409d4aaee8a8af8226c9af3165ef2b140fe05c9c8c56f31f59dc"},
      {31, 15, "429cc64749696bad59b2d1571f26336aca9eb45cdcb32d50f4b311f54eedc18d"},
      {17, 33, "a9f2cbdb71e7222fffca7cc990a8a3c7398852853f7c99d79a6c2815bb26636b"},
      {8, 6, "b062a73e996a4327f3474fe74f18db791858b36756823a06d93cf2849e4703b3"},
      {7, 5, "75f8cd2bcc4f6f3cf48047ce2a11e8a01713a49ea1641a463801eeac0f7e655e"},
      {4, 4, "324ff8f46486938dca20faca37c15e496154eec05773cc6855cfdc2a2f6e4fb4"},
      {1, 1, "eb285c2e512e66d300029ce58da7f9e30628b67a0dfcbccc7349a0e941c027bf"},
  };
  const wire::Bytes large = camera_picture();
  for (const Made& made : kMade) {
    CAPTURE(made.width);
    CAPTURE(made.height);
    // The first bytes as a picture of that size.
    const auto size = static_cast<std::size_t>(made.width) * static_cast<std::size_t>(made.height);
    const Image image{made.width, made.height, std::span(large).first(size * 3)};
    CHECK(hash_of(through_jpeg(image)) == made.hash);
  }
  const Image image{640, 480, large};
  ImageRule rule{"", "k"};
  rule.is_jpeg = true;
  CHECK(to_pixels(image, rule).bytes == through_jpeg(image));
  rule = {"", "k", 224, 224, Resize::kTfLanczos3, PixelLayout::kHwcU8, true};
  CHECK(to_pixels(image, rule).bytes ==
        resize_tf_lanczos3({640, 480, through_jpeg(image)}, 224, 224));
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
