// A video of one episode as it runs, with its words, several cameras side by side; whole under its
// final name or absent.
#pragma once

#include <memory>
#include <string>

#include "runtime/base/file.h"
#include "runtime/show/frame_sink.h"
#include "runtime/show/overlay.h"
#include "runtime/show/video.h"
#include "runtime/store/trace.h"

namespace probe::show {

class EpisodeVideo final : public FrameSink {
 public:
  // The file is begun with the first frame; `path`'s folder is there.
  // `camera`: that one alone.
  EpisodeVideo(const store::TraceHeader& header, std::string path, std::string camera = {});
  ~EpisodeVideo() override;
  Status frame(std::span<const stage::CameraFrame> frames, int step,
               std::span<const store::MetricValue> metrics) override;
  Status finish();
  Status discard();

 private:
  PendingFile file_;
  std::string instruction_, caption_, camera_;
  int horizon_ = 0, frames_per_second_ = 5;
  std::unique_ptr<VideoWriter> writer_;
};

}  // namespace probe::show
