// H.264 in an mp4 file: yuv420p, index in front. Same frames, same bytes. FFmpeg's headers stop at
// video.cpp and clip.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "runtime/base/result.h"

namespace probe::show {

class VideoWriter {
 public:
  // Sizes in pixels, even; fails (kVideo) naming the path.
  static Result<std::unique_ptr<VideoWriter>> create(const std::string& path, int width, int height,
                                                     int frames_per_second);
  virtual ~VideoWriter() = default;
  virtual Status add(std::span<const std::uint8_t> rgb) = 0;  // width * height * 3, row 0 on top
  virtual Status finish() = 0;
};

}  // namespace probe::show
