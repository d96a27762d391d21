// Overlay and encoder for the frames of the loop.
#include "runtime/run/episode_video.h"

#include <cmath>

namespace probe::run {

EpisodeVideo::EpisodeVideo(const TraceHeader& header, std::string path)
    : file_(std::move(path)),
      instruction_(header.prompt),
      caption_(header.task + "  episode " + std::to_string(header.episode) + "  seed " +
               std::to_string(header.seed) + "  " + header.policy),
      horizon_(static_cast<int>(header.horizon)),
      frames_per_second_(std::max(1, static_cast<int>(std::lround(header.control_hz)))) {}

EpisodeVideo::~EpisodeVideo() {
  if (writer_) static_cast<void>(discard());
}

Status EpisodeVideo::frame(const render::FrameView& frame, int step,
                           std::span<const MetricValue> metrics) {
  if (!writer_) {
    PROBE_ASSIGN(writer_, VideoWriter::create(file_.temporary(), frame.width, frame.height,
                                              frames_per_second_));
  }
  Picture picture = copy_picture(frame.width, frame.height, frame.rgb);
  draw_overlay(picture, {instruction_, caption_, step, horizon_, metrics});
  return writer_->add(picture.rgb);
}

Status EpisodeVideo::finish() {
  if (!writer_) return {};  // an episode without a picture
  PROBE_TRY(writer_->finish());
  writer_.reset();
  return file_.keep();
}

Status EpisodeVideo::discard() {
  writer_.reset();
  return {};  // the unfinished file goes with us
}

}  // namespace probe::run
