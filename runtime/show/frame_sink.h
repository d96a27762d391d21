// Who watches the pictures of an episode while it runs.
#pragma once

#include <span>

#include "runtime/base/result.h"
#include "runtime/stage/scene_view.h"
#include "runtime/store/results.h"

namespace probe::show {

// Watches the pictures of an episode, every camera's: the horizon's observations and the one after
// the last step.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  virtual Status frame(std::span<const stage::CameraFrame> frames, int step,
                       std::span<const store::MetricValue> metrics) = 0;
};

}  // namespace probe::show
