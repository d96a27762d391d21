// What cameras do to their pictures before a policy gets them: blur, exposure, noise, a dark patch,
// left for right, pictures that do not arrive. Every draw is a function of the start, the camera's
// number in its task, the step and the pixel, so a picture is the same in a run, a replay and a
// preview, whichever were drawn before it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/base/sha256.h"
#include "runtime/plan/format.h"
#include "runtime/render/renderer.h"

namespace probe::stage {

// When a picture is taken.
struct Moment {
  Sha256 start_id;  // of the episode
  int step = 0;     // control steps since its start
};

class Sensor {
 public:
  // `camera`: its number among the task's.
  Sensor(const plan::SensorRecord& record, std::size_t camera);

  // At least one of so many pictures in a row arrives, unless none but the first does.
  static constexpr int kLongestGap = 32;
  bool drops() const { return record_.dropped > 0; }
  // The step whose picture is what a policy sees at `moment`: that of the last one that arrived,
  // the first always does.
  int shown_step(const Moment& moment) const;

  // `frame` as the camera gives it, valid until the next call. What a patch hides is nothing in
  // depth and segmentation, too.
  render::FrameView apply(const render::FrameView& frame, const Moment& moment);

 private:
  bool is_dropped(const Moment& moment, int step) const;
  void blur(int width, int height);
  void add_noise(const Moment& moment);
  void hide(int width, int height);
  void mirror(int width, int height);

  plan::SensorRecord record_;
  std::size_t camera_;
  std::vector<std::uint8_t> rgb_;
  std::vector<float> depth_, row_;
  std::vector<std::uint16_t> segmentation_;
  std::vector<float> weights_;         // of the blur, from the middle outwards
  std::vector<std::uint8_t> exposed_;  // by byte; empty: as it is
};

}  // namespace probe::stage
