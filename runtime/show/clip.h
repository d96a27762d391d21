// A video of many clips: each is encoded apart from the others, in any thread, and all are joined
// into one mp4 in the order in which they are given. Same pictures, same bytes, whoever encoded
// them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"

namespace probe::show {

struct ClipFormat {
  int width = 0, height = 0;  // pixels, even
  int frames_per_second = 0;
  // A frame in so many stands alone, so that one is read without those before it: 2 as in LeRobot's
  // own recordings.
  int group = 2;
  int quality = 20;  // x264's constant rate factor
  bool operator==(const ClipFormat&) const = default;
};

struct Clip {
  struct Packet {
    std::vector<std::uint8_t> bytes;
    bool is_key = false;
  };
  ClipFormat format;
  std::vector<std::uint8_t> header;  // the encoder's, equal for clips of one format
  std::vector<Packet> packets;       // a frame each, in order

  std::size_t bytes() const;
};

// H.264, yuv420p, one thread, no frame that looks ahead. Fails with kVideo.
class ClipEncoder {
 public:
  static Result<std::unique_ptr<ClipEncoder>> create(const ClipFormat& format);
  virtual ~ClipEncoder() = default;
  virtual Status add(std::span<const std::uint8_t> rgb) = 0;  // width * height * 3, row 0 on top
  // All frames since the last finish(); the next clip may begin.
  virtual Result<Clip> finish() = 0;
};

class ClipJoiner {
 public:
  // Fails with kVideo naming the path.
  static Result<std::unique_ptr<ClipJoiner>> create(const std::string& path, const Clip& first);
  virtual ~ClipJoiner() = default;
  // Of the first clip's format and header. Frame k of the file is shown at k / frames_per_second.
  virtual Status add(const Clip& clip) = 0;
  virtual Status finish() = 0;
};

// Name and version of what encodes, as it is loaded.
std::string video_library();

// What a video file says of its first picture stream, for checks. Fails with kVideo.
struct VideoFacts {
  std::string codec;  // "h264"
  int width = 0, height = 0;
  double frames_per_second = 0;
  std::int64_t frames = 0;
  bool is_even = false;  // frame k is shown at k / frames_per_second
};
Result<VideoFacts> read_video_facts(const std::string& path);

// A video file's pictures, one after the other, decoded in a process of its own
// (runtime/base/apart.h), as read_video_facts looks in one. Fails with kVideo naming the path.
class ClipReader {
 public:
  static Result<std::unique_ptr<ClipReader>> create(const std::string& path);
  virtual ~ClipReader() = default;
  virtual int width() const = 0;
  virtual int height() const = 0;
  // The next one, width * height * 3, row 0 on top, valid until the next call; empty behind the
  // last.
  virtual Result<std::span<const std::uint8_t>> next() = 0;
};

}  // namespace probe::show
