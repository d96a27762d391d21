// Overlay and encoder for the frames of the loop.
#include "runtime/show/episode_video.h"

#include <cmath>

#include "runtime/plan/later.h"
#include "runtime/show/picture_grid.h"

namespace probe::show {

EpisodeVideo::EpisodeVideo(const store::TraceHeader& header, std::string path, std::string camera)
    : file_(std::move(path)),
      instruction_(plan::whole_instruction(header.prompt, header.later)),
      caption_(header.task + "  episode " + std::to_string(header.episode) + "  seed " +
               std::to_string(header.seed) + "  " + header.policy),
      camera_(std::move(camera)),
      horizon_(static_cast<int>(header.horizon)),
      frames_per_second_(std::max(1, static_cast<int>(std::lround(header.control_hz)))) {}

EpisodeVideo::~EpisodeVideo() {
  if (writer_) static_cast<void>(discard());
}

Status EpisodeVideo::frame(std::span<const stage::CameraFrame> frames, int step,
                           std::span<const store::MetricValue> metrics) {
  PROBE_ASSIGN(Picture picture, show_frames(frames, camera_));
  if (picture.width % 2 != 0 || picture.height % 2 != 0) {  // the encoder takes even sides
    Picture even = make_picture(picture.width + picture.width % 2,
                                picture.height + picture.height % 2, {0, 0, 0});
    paste(even, picture, 0, 0);
    picture = std::move(even);
  }
  if (!writer_) {
    PROBE_ASSIGN(writer_, VideoWriter::create(file_.temporary(), picture.width, picture.height,
                                              frames_per_second_));
  }
  PROBE_ASSIGN(Lettering* const lettering, Lettering::shared());
  draw_overlay(picture, {instruction_, caption_, step, horizon_, metrics}, *lettering);
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

}  // namespace probe::show
