// Clips that are joined are one even video, the same bytes however it was made.
#include "runtime/show/clip.h"

#include <doctest/doctest.h>

#include <fstream>
#include <iterator>

#include "tests/runtime/run/temporary_folder.h"
#include "tests/runtime/scene/mutate.h"

namespace probe::show {
namespace {

constexpr ClipFormat kSmall{64, 48, 5};

Clip clip_of(int frames, int seed) {
  auto encoder = ClipEncoder::create(kSmall);
  REQUIRE_MESSAGE(encoder.ok(), (encoder.ok() ? "" : to_text(encoder.failure())));
  std::vector<std::uint8_t> rgb(64 * 48 * 3);
  for (int frame = 0; frame < frames; ++frame) {
    for (std::size_t i = 0; i < rgb.size(); ++i)
      rgb[i] = static_cast<std::uint8_t>(i / 7 + static_cast<std::size_t>(seed * 31 + frame * 5));
    REQUIRE((*encoder)->add(rgb).ok());
  }
  auto clip = (*encoder)->finish();
  REQUIRE(clip.ok());
  return *clip;
}

void join(const std::string& path, const std::vector<Clip>& clips) {
  auto joiner = ClipJoiner::create(path, clips.front());
  REQUIRE_MESSAGE(joiner.ok(), (joiner.ok() ? "" : to_text(joiner.failure())));
  for (const Clip& clip : clips) REQUIRE((*joiner)->add(clip).ok());
  REQUIRE((*joiner)->finish().ok());
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_CASE("joined clips are one video whose frames are evenly spaced, each clip beginning anew") {
  const run::TemporaryFolder folder;
  const std::vector<Clip> clips = {clip_of(5, 1), clip_of(1, 2), clip_of(8, 3)};
  for (const Clip& clip : clips) {
    for (std::size_t i = 0; i < clip.packets.size(); ++i)
      CHECK(clip.packets[i].is_key == (i % 2 == 0));
  }
  join(folder / "a.mp4", clips);
  const auto facts = read_video_facts(folder / "a.mp4");
  REQUIRE_MESSAGE(facts.ok(), (facts.ok() ? "" : to_text(facts.failure())));
  CHECK(facts->codec == "h264");
  CHECK(facts->width == 64);
  CHECK(facts->height == 48);
  CHECK(facts->frames == 14);
  CHECK(facts->frames_per_second == 5);
  CHECK(facts->is_even);
  join(folder / "b.mp4", {clip_of(5, 1), clip_of(1, 2), clip_of(8, 3)});
  CHECK(bytes_of(folder / "a.mp4") == bytes_of(folder / "b.mp4"));
}

TEST_CASE("a video's pictures come back in order, nearly as they were, and then none") {
  const run::TemporaryFolder folder;
  std::vector<std::vector<std::uint8_t>> drawn;
  auto encoder = ClipEncoder::create(kSmall);
  REQUIRE(encoder.ok());
  for (int i = 0; i < 5; ++i) {
    drawn.emplace_back(64 * 48 * 3, static_cast<std::uint8_t>(40 * i + 20));
    REQUIRE((*encoder)->add(drawn.back()).ok());
  }
  const auto clip = (*encoder)->finish();
  REQUIRE(clip.ok());
  join(folder / "a.mp4", {*clip});
  auto reader = ClipReader::create(folder / "a.mp4");
  REQUIRE_MESSAGE(reader.ok(), (reader.ok() ? "" : to_text(reader.failure())));
  CHECK((*reader)->width() == 64);
  CHECK((*reader)->height() == 48);
  for (const auto& wanted : drawn) {
    const auto frame = (*reader)->next();
    REQUIRE(frame.ok());
    REQUIRE(frame->size() == wanted.size());
    CHECK(std::abs(static_cast<int>(frame->front()) - wanted.front()) <= 4);
    CHECK(std::abs(static_cast<int>(frame->back()) - wanted.back()) <= 4);
  }
  CHECK((*reader)->next()->empty());
  CHECK((*reader)->next()->empty());
  CHECK(ClipReader::create(folder / "no.mp4").failure().where == folder / "no.mp4");
  CHECK(!ClipReader::create("/dev/null").ok());
}

TEST_CASE("a damaged video is read, or refused with a reason") {
  const run::TemporaryFolder folder;
  join(folder / "good.mp4", {clip_of(3, 1)});
  const std::string good = bytes_of(folder / "good.mp4"), path = folder / "bad.mp4";
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    std::ofstream(path, std::ios::binary) << scene::test::mutated(good, seed);
    CAPTURE(seed);
    const auto reader = ClipReader::create(path);
    if (!reader) {
      ++refused;
      CHECK_FALSE(reader.failure().message.empty());
      continue;
    }
    for (int frame = 0; frame < 10; ++frame) {
      const auto rgb = (*reader)->next();
      if (!rgb || rgb->empty()) break;
    }
  }
  CHECK(refused > 0);
}

TEST_CASE("odd sides, clips of two formats and a full disk are told") {
  const run::TemporaryFolder folder;
  CHECK(ClipEncoder::create({63, 48, 5}).failure().code == Fault::kVideo);
  const Clip clip = clip_of(2, 1);
  auto joiner = ClipJoiner::create(folder / "a.mp4", clip);
  REQUIRE(joiner.ok());
  Clip other = clip;
  other.format.frames_per_second = 10;
  CHECK(!(*joiner)->add(other).ok());
  CHECK(ClipJoiner::create(folder / "no/a.mp4", clip).failure().where == folder / "no/a.mp4");
  auto full = ClipJoiner::create("/dev/full", clip);
  Status written = full ? Status() : Status(full.failure());
  for (int i = 0; i < 300 && written; ++i) written = (*full)->add(clip);
  if (written) written = (*full)->finish();
  REQUIRE(!written.ok());
  CHECK(written.failure().where == "/dev/full");
  CHECK(!read_video_facts("/dev/null").ok());
}

}  // namespace
}  // namespace probe::show
