#include "runtime/stage/sensor.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "runtime/base/hash_number.h"
#include "runtime/render/encode.h"

namespace probe::stage {
namespace {

// The finaliser of splitmix64 (Steele, Lea and Flood, OOPSLA 2014): a number of 64 bits for every
// counter, without a state.
std::uint64_t mixed(std::uint64_t counter) {
  std::uint64_t z = counter * 0x9E3779B97F4A7C15u;
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
  z = (z ^ z >> 27) * 0x94D049BB133111EBu;
  return z ^ z >> 31;
}

std::uint64_t key_of(const Moment& moment, std::size_t camera, int step, std::string_view what) {
  Hasher hasher;
  hasher.text(what).hash(moment.start_id).u64(camera).u32(static_cast<std::uint32_t>(step));
  return little_endian_number(hasher.finish());
}

// Of mean 0 and standard deviation 1, between -3.5 and 3.5: four numbers of 16 bits added, without
// a library's logarithm.
float nearly_normal(std::uint64_t bits) {
  const auto part = [&](int shift) { return static_cast<float>(bits >> shift & 0xffffu); };
  const float sum = part(0) + part(16) + part(32) + part(48);
  constexpr float kMean = 2.0f * 65535.0f, kScale = 1.7320508f / 65536.0f;  // variance 4 / 12
  return (sum - kMean) * kScale;
}

// Of a bump (1 - (x / r)^2)^4, whose variance is r^2 / 11, from the middle outwards; their sum over
// both sides is 1.
std::vector<float> bump(double deviation) {
  const double r = deviation * std::sqrt(11.0);
  std::vector<double> shape;
  for (int x = 0; x < r; ++x) {
    const double rest = 1 - x * x / (r * r);
    shape.push_back(rest * rest * rest * rest);
  }
  double sum = shape.front();
  for (std::size_t i = 1; i < shape.size(); ++i) sum += 2 * shape[i];
  std::vector<float> weights;
  for (const double weight : shape) weights.push_back(static_cast<float>(weight / sum));
  return weights;
}

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5f, 0.0f, 255.0f));
}

// One pass along a line of `count` pixels that lie `stride` bytes apart; beyond its ends the line
// goes on as its last pixels.
void blur_line(std::uint8_t* line, int count, std::size_t stride, const std::vector<float>& weights,
               std::vector<float>& copy) {
  const int reach = static_cast<int>(weights.size()) - 1;
  copy.resize(static_cast<std::size_t>(count + 2 * reach));
  for (int i = -reach; i < count + reach; ++i) {
    const auto from = static_cast<std::size_t>(std::clamp(i, 0, count - 1));
    copy[static_cast<std::size_t>(i + reach)] = static_cast<float>(line[from * stride]);
  }
  for (int i = 0; i < count; ++i) {
    const float* const middle = copy.data() + i + reach;
    float sum = weights[0] * middle[0];
    for (int k = 1; k <= reach; ++k)
      sum += weights[static_cast<std::size_t>(k)] * (middle[-k] + middle[k]);
    line[static_cast<std::size_t>(i) * stride] = to_byte(sum);
  }
}

}  // namespace

Sensor::Sensor(const plan::SensorRecord& record, std::size_t camera)
    : record_(record), camera_(camera) {
  if (record.blur > 0) weights_ = bump(record.blur);
  if (record.exposure == 0) return;
  const auto factor = static_cast<float>(record.exposure);
  for (const float linear : render::kDisplayThresholds)
    exposed_.push_back(render::to_display_byte(factor * linear));
}

bool Sensor::is_dropped(const Moment& moment, int step) const {
  if (step % kLongestGap == 0) return false;
  const std::uint64_t bits = key_of(moment, camera_, step, "dropped");
  return static_cast<double>(bits >> 11) * 0x1p-53 < record_.dropped;
}

int Sensor::shown_step(const Moment& moment) const {
  int step = moment.step;
  if (!drops()) return step;
  if (record_.dropped >= 1) return 0;
  while (step > 0 && is_dropped(moment, step)) --step;
  return step;
}

render::FrameView Sensor::apply(const render::FrameView& frame, const Moment& moment) {
  rgb_.assign(frame.rgb.begin(), frame.rgb.end());
  depth_.assign(frame.depth.begin(), frame.depth.end());
  segmentation_.assign(frame.segmentation.begin(), frame.segmentation.end());
  if (weights_.size() > 1) blur(frame.width, frame.height);
  if (!exposed_.empty()) {
    for (std::uint8_t& byte : rgb_) byte = exposed_[byte];
  }
  if (record_.noise > 0) add_noise(moment);
  hide(frame.width, frame.height);
  if (record_.mirrored != 0) mirror(frame.width, frame.height);
  return {frame.width, frame.height, rgb_, depth_, segmentation_};
}

void Sensor::blur(int width, int height) {
  const std::size_t across = 3 * static_cast<std::size_t>(width);
  for (int y = 0; y < height; ++y) {
    for (std::size_t k = 0; k < 3; ++k)
      blur_line(rgb_.data() + static_cast<std::size_t>(y) * across + k, width, 3, weights_, row_);
  }
  for (std::size_t column = 0; column < across; ++column)
    blur_line(rgb_.data() + column, height, across, weights_, row_);
}

void Sensor::add_noise(const Moment& moment) {
  const std::uint64_t key = key_of(moment, camera_, moment.step, "noise");
  const auto levels = static_cast<float>(255 * record_.noise);
  for (std::size_t i = 0; i < rgb_.size(); ++i)
    rgb_[i] = to_byte(static_cast<float>(rgb_[i]) + levels * nearly_normal(mixed(key + i)));
}

void Sensor::mirror(int width, int height) {
  const auto across = static_cast<std::ptrdiff_t>(width);
  for (std::ptrdiff_t y = 0; y < height; ++y) {
    std::reverse(depth_.begin() + y * across, depth_.begin() + (y + 1) * across);
    std::reverse(segmentation_.begin() + y * across, segmentation_.begin() + (y + 1) * across);
    const auto row = rgb_.begin() + 3 * y * across;
    std::reverse(row, row + 3 * across);
    for (std::ptrdiff_t x = 0; x < across; ++x) std::swap(row[3 * x], row[3 * x + 2]);
  }
}

void Sensor::hide(int width, int height) {
  const auto edge = [](double share, int size) {
    return static_cast<std::size_t>(std::lround(share * size));
  };
  const auto& patch = record_.patch;
  const std::size_t left = edge(patch[0], width), right = edge(patch[2], width);
  for (std::size_t y = edge(patch[1], height); y < edge(patch[3], height); ++y) {
    for (std::size_t x = left; x < right; ++x) {
      const std::size_t pixel = y * static_cast<std::size_t>(width) + x;
      std::fill_n(rgb_.begin() + static_cast<std::ptrdiff_t>(3 * pixel), 3, std::uint8_t{0});
      depth_[pixel] = 0;
      segmentation_[pixel] = 0;
    }
  }
}

}  // namespace probe::stage
