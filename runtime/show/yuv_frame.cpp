#include "runtime/show/yuv_frame.h"

extern "C" {
#include <libavutil/error.h>
#include <libavutil/frame.h>
#include <libswscale/swscale.h>
}

#include <cstring>

namespace probe::show {

Failure av_failure(const std::string& what, int code, const std::string& where) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  if (code != 0) av_strerror(code, text, sizeof text);
  return {Fault::kVideo, code == 0 ? what : what + ": " + text, where};
}

YuvFrame::~YuvFrame() {
  sws_freeContext(scaler_);
  av_frame_free(&frame_);
}

Status YuvFrame::begin(int width, int height, const std::string& where) {
  where_ = where;
  frame_ = av_frame_alloc();
  if (frame_ == nullptr) return av_failure("no memory", 0, where_);
  frame_->format = AV_PIX_FMT_YUV420P;
  frame_->width = width;
  frame_->height = height;
  const int code = av_frame_get_buffer(frame_, 0);
  if (code < 0) return av_failure("no memory", code, where_);
  scaler_ =
      sws_getContext(width, height, AV_PIX_FMT_RGB24, width, height, AV_PIX_FMT_YUV420P,
                     SWS_BILINEAR | SWS_BITEXACT | SWS_ACCURATE_RND, nullptr, nullptr, nullptr);
  if (scaler_ == nullptr) return av_failure("no colour conversion", 0, where_);
  rgb_bytes_ = 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  padded_.resize(rgb_bytes_ + 64);
  return {};
}

Status YuvFrame::fill(std::span<const std::uint8_t> rgb) {
  if (rgb.size() != rgb_bytes_) return av_failure("a frame of another size", 0, where_);
  const int code = av_frame_make_writable(frame_);
  if (code < 0) return av_failure("no memory", code, where_);
  std::memcpy(padded_.data(), rgb.data(), rgb.size());
  const std::uint8_t* rows[] = {padded_.data()};
  const int strides[] = {3 * frame_->width};
  sws_scale(scaler_, rows, strides, 0, frame_->height, frame_->data, frame_->linesize);
  frame_->pts = count_++;
  return {};
}

}  // namespace probe::show
