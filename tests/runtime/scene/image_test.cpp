#include <doctest/doctest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "runtime/scene/color.h"
#include "runtime/scene/image.h"

namespace probe::scene {
namespace {

namespace fs = std::filesystem;

std::string scratch(const std::string& name) {
  const fs::path folder = fs::path(VLAPROBE_BINARY_DIR) / "tests" / "image_test";
  fs::create_directories(folder);
  return (folder / name).string();
}

TEST_CASE("a written picture reads back byte for byte, row 0 first") {
  const std::vector<std::uint8_t> rgb{255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 8, 7, 6, 5, 4, 3, 2, 1};
  const std::string path = scratch("six.png");
  REQUIRE(write_png(path, 3, 2, rgb).ok());
  const Result<Texture> read = load_image(path);
  REQUIRE(read.ok());
  CHECK(read->width == 3);
  CHECK(read->height == 2);
  for (std::size_t pixel = 0; pixel < 6; ++pixel) {
    for (std::size_t k = 0; k < 3; ++k) CHECK(read->rgba[4 * pixel + k] == rgb[3 * pixel + k]);
    CHECK(read->rgba[4 * pixel + 3] == 255);
  }
}

TEST_CASE("gray pictures of 8 and 16 bits keep their values") {
  // 2 x 2 pixels: 0, 100, 255, 7.
  const std::uint8_t gray[] = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
      0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x00, 0x00, 0x00, 0x00, 0x57,
      0xdd, 0x52, 0xf8, 0x00, 0x00, 0x00, 0x0e, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x60,
      0x48, 0x61, 0xf8, 0xcf, 0x0e, 0x00, 0x03, 0x9b, 0x01, 0x6b, 0x00, 0x95, 0xd0, 0x02, 0x00,
      0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  const auto eight = decode_image(std::as_bytes(std::span(gray)), "gray");
  REQUIRE(eight.ok());
  CHECK(eight->rgba[4] == 100);
  CHECK(eight->rgba[12] == 7);
  // 0, 0x1234, 0xffff, 0x8000.
  const std::uint8_t wide[] = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
      0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x10, 0x00, 0x00, 0x00, 0x00, 0x07,
      0x4d, 0x8e, 0xbb, 0x00, 0x00, 0x00, 0x12, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x60,
      0x60, 0x10, 0x32, 0x61, 0xf8, 0xff, 0xbf, 0x81, 0x01, 0x00, 0x09, 0xb9, 0x02, 0xc5, 0x1c,
      0x82, 0x56, 0x21, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  const auto sixteen = decode_image(std::as_bytes(std::span(wide)), "wide");
  REQUIRE(sixteen.ok());
  CHECK(sixteen->rgba[4] == 0x12);  // read as 8 bits: the high byte
  CHECK(sixteen->rgba[12] == 0x80);
}

TEST_CASE("a picture that cannot be written leaves nothing behind") {
  const std::vector<std::uint8_t> pixel{1, 2, 3};
  CHECK_FALSE(write_png(scratch("no/such/folder.png"), 1, 1, pixel).ok());
  CHECK_FALSE(write_png(scratch("short.png"), 2, 1, pixel).ok());

  // A file size limit stands in for a full disk: both make the write fail late.
  const std::string path = scratch("limited.png");
  fs::remove(path);
  std::vector<std::uint8_t> noise(300 * 300 * 3);
  std::uint32_t state = 1;
  for (std::uint8_t& byte : noise)
    byte = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
  rlimit old{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &old) == 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{20'000, old.rlim_max};
  REQUIRE(setrlimit(RLIMIT_FSIZE, &small) == 0);
  const Status written = write_png(path, 300, 300, noise);
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  REQUIRE_FALSE(written.ok());
  CHECK(written.failure().code == Fault::kIo);
  CHECK(written.failure().where == path);
  for (const auto& entry : fs::directory_iterator(fs::path(path).parent_path())) {
    CHECK(entry.path().filename().string().find("limited") == std::string::npos);
  }
}

TEST_CASE("a picture as PNG bytes is exact, as JPEG bytes near and the same each time") {
  constexpr int kSide = 32;
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < kSide * kSide; ++i) {
    for (const int channel : {i % kSide * 7, i / kSide * 7, 128}) {
      rgb.push_back(static_cast<std::uint8_t>(channel));
    }
  }
  const auto png = png_bytes(kSide, kSide, rgb);
  const auto jpeg = jpeg_bytes(kSide, kSide, rgb, 95);
  REQUIRE(png.ok());
  REQUIRE(jpeg.ok());
  CHECK(*jpeg == *jpeg_bytes(kSide, kSide, rgb, 95));
  CHECK(jpeg->size() < rgb.size() / 2);
  const auto exact = decode_image(std::as_bytes(std::span(*png)), "png");
  const auto near = decode_image(std::as_bytes(std::span(*jpeg)), "jpeg");
  REQUIRE(exact.ok());
  REQUIRE(near.ok());
  int worst = 0;
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    const std::size_t at = i / 3 * 4 + i % 3;
    CHECK(exact->rgba[at] == rgb[i]);
    worst = std::max(worst, std::abs(near->rgba[at] - rgb[i]));
  }
  CHECK(worst <= 12);
  CHECK(png_bytes(kSide, 1, rgb).failure().message ==
        "a picture of 32 x 1 needs 96 bytes, got 3072");
}

TEST_CASE("images that are missing, cut off or too large are refused by name") {
  const std::string missing = scratch("missing.png");
  const Result<Texture> absent = load_image(missing);
  REQUIRE_FALSE(absent.ok());
  CHECK(absent.failure().where == missing);

  std::vector<std::uint8_t> rgb(64 * 64 * 3, 77);
  const std::string path = scratch("cut.png");
  REQUIRE(write_png(path, 64, 64, rgb).ok());
  fs::resize_file(path, fs::file_size(path) / 2);
  const Result<Texture> cut = load_image(path);
  REQUIRE_FALSE(cut.ok());
  CHECK(cut.failure().code == Fault::kAsset);

  // A header may promise any size: 20000 x 1 here.
  const std::vector<std::uint8_t> line(20'000 * 3, 1);
  REQUIRE(write_png(scratch("wide.png"), 20'000, 1, line).ok());
  const Result<Texture> wide = load_image(scratch("wide.png"));
  REQUIRE_FALSE(wide.ok());
}

TEST_CASE("sRGB decoding has its published values and textures are read between texels") {
  CHECK(kSrgbToLinear[0] == 0.0f);
  CHECK(kSrgbToLinear[255] == 1.0f);
  CHECK(kSrgbToLinear[10] == doctest::Approx(10.0 / 255 / 12.92));
  CHECK(kSrgbToLinear[188] == doctest::Approx(std::pow((188 / 255.0 + 0.055) / 1.055, 2.4)));

  const Texture checker{2, 2, {0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 255}};
  CHECK(sample_texture(checker, 0.25f, 0.25f).r == 0.0f);
  CHECK(sample_texture(checker, 0.75f, 0.25f).r == 1.0f);
  CHECK(sample_texture(checker, 0.5f, 0.25f).r == 0.5f);
  CHECK(sample_texture(checker, -0.25f, 0.25f).r == 1.0f);  // wraps to 0.75
  CHECK(sample_texture(checker, 1.0f, 0.25f).r == 0.5f);    // between the last and the first texel
  CHECK(sample_texture(checker, 1.78f, 0.25f).r == doctest::Approx(0.94).epsilon(1e-5));
  CHECK(sample_texture(checker, 0.25f, 0.75f).r == 1.0f);
  CHECK(sample_texture(checker, -1e-9f, 0.0f).r == 0.5f);  // the fraction rounds to 1: still inside
}

}  // namespace
}  // namespace probe::scene
