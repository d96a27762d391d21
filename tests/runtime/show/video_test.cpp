// Pictures with words, and videos that play.
#include "runtime/show/video.h"

#include <malloc.h>
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "runtime/show/overlay.h"
#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/show/inspect_video.h"

namespace probe::show {
using namespace probe::store;
using namespace probe::run;
namespace {

Picture frame(int number) {
  Picture picture = make_picture(320, 240, {static_cast<std::uint8_t>(4 * number), 90, 60});
  const std::vector<MetricValue> metrics = {
      {"success", true, 0}, {"grasp", true, 1}, {"height", false, 0.25}};
  draw_overlay(picture, {"put carrot on plate", "carrot_on_plate", number, 60, metrics},
               *Lettering::shared().value());
  return picture;
}

Status write_video(const std::string& path, int frames) {
  PROBE_ASSIGN(auto video, VideoWriter::create(path, 320, 240, 5));
  for (int i = 0; i < frames; ++i) PROBE_TRY(video->add(frame(i).rgb));
  return video->finish();
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_CASE("a video decodes to as many frames as were put in") {
  TemporaryFolder folder;
  const auto written = write_video(folder / "a.mp4", 61);
  REQUIRE_MESSAGE(written.ok(), to_text(written.failure()));
  const auto info = inspect_video(folder / "a.mp4");
  REQUIRE_MESSAGE(info.ok(), to_text(info.failure()));
  CHECK(info->frames == 61);
  CHECK(info->width == 320);
  CHECK(info->height == 240);
  CHECK(info->codec == "h264");
  CHECK(info->frames_per_second == doctest::Approx(5));
  const std::string bytes = read_file(folder / "a.mp4");
  CHECK(bytes.find("moov") < bytes.find("mdat"));
}

TEST_CASE("the same frames make the same bytes") {
  TemporaryFolder folder;
  REQUIRE(write_video(folder / "a.mp4", 12).ok());
  REQUIRE(write_video(folder / "b.mp4", 12).ok());
  CHECK(read_file(folder / "a.mp4") == read_file(folder / "b.mp4"));
}

// Twelve pictures of gradients that wander, so that there is something to predict.
Status write_gradients(const std::string& path) {
  PROBE_ASSIGN(auto video, VideoWriter::create(path, 320, 240, 5));
  for (int i = 0; i < 12; ++i) {
    std::vector<std::uint8_t> rgb;
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        for (const int value : {x + 3 * i, 2 * y + i, x * y / 50}) {
          rgb.push_back(static_cast<std::uint8_t>(value));
        }
      }
    }
    PROBE_TRY(video->add(rgb));
  }
  return video->finish();
}

TEST_CASE("the bytes of a video do not depend on what memory held before") {
  TemporaryFolder folder;
  REQUIRE(write_gradients(folder / "fresh.mp4").ok());
  for (const int junk : {20, 77, 200}) {
    mallopt(M_PERTURB, junk);  // glibc fills what it hands out with this byte
    const auto written = write_gradients(folder / "used.mp4");
    mallopt(M_PERTURB, 0);
    REQUIRE(written.ok());
    CHECK(read_file(folder / "fresh.mp4") == read_file(folder / "used.mp4"));
  }
}

TEST_CASE("a video that cannot be written names its file") {
  TemporaryFolder folder;
  const auto absent = VideoWriter::create(folder / "no/such/a.mp4", 320, 240, 5);
  REQUIRE_FALSE(absent.ok());
  CHECK(absent.failure().code == Fault::kVideo);
  CHECK(absent.failure().where == folder / "no/such/a.mp4");
  CHECK_FALSE(VideoWriter::create(folder / "odd.mp4", 321, 240, 5).ok());
  auto video = VideoWriter::create(folder / "a.mp4", 320, 240, 5);
  REQUIRE(video.ok());
  CHECK_FALSE((*video)->add(std::vector<std::uint8_t>(5)).ok());
  CHECK_FALSE(inspect_video(folder / "absent.mp4").ok());
}

TEST_CASE("shrinking keeps the mean and pasting keeps inside") {
  Picture picture = make_picture(4, 2, {0, 0, 0});
  for (int i = 0; i < 4; ++i) picture.rgb[static_cast<std::size_t>(3 * i)] = 200;
  const Picture small = shrink(picture, 2, 1);
  CHECK(small.rgb == std::vector<std::uint8_t>{100, 0, 0, 100, 0, 0});
  Picture onto = make_picture(3, 3, {1, 1, 1});
  paste(onto, make_picture(5, 5, {7, 7, 7}), 2, -4);
  CHECK(std::count(onto.rgb.begin(), onto.rgb.end(), std::uint8_t{7}) == 3);
}

}  // namespace
}  // namespace probe::show
