// A picture as video encoders take it, YUV 4:2:0: the one conversion of all videos.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"

struct AVFrame;
struct SwsContext;

namespace probe::show {

// kVideo, "what: libav's words for the error code", or `what` alone of code 0.
Failure av_failure(const std::string& what, int code, const std::string& where);

// All of it fails with kVideo, where = `where` of begin().
class YuvFrame {
 public:
  YuvFrame() = default;
  YuvFrame(const YuvFrame&) = delete;
  YuvFrame& operator=(const YuvFrame&) = delete;
  ~YuvFrame();

  // Even sides, in pixels.
  Status begin(int width, int height, const std::string& where);
  // width * height * 3 bytes, rows from above; the frame then has the next number, from 0.
  Status fill(std::span<const std::uint8_t> rgb);

  const AVFrame* frame() const { return frame_; }
  std::int64_t count() const { return count_; }  // of fill()

 private:
  AVFrame* frame_ = nullptr;
  SwsContext* scaler_ = nullptr;
  std::vector<std::uint8_t> padded_;  // one picture; the scaler reads a few bytes behind its end
  std::size_t rgb_bytes_ = 0;
  std::string where_;
  std::int64_t count_ = 0;
};

}  // namespace probe::show
