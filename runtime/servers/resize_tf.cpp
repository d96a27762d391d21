// tf.image.resize(image, size, "lanczos3", antialias=True), rounded and held to bytes, in its
// floating point (tensorflow/core/kernels/image/scale_and_translate_op.cc, sampling_kernels.h):
// rows first, then columns. Where theirs is compiled to fused operations a number that lies half
// way between two levels may fall to the other.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "runtime/base/trig.h"
#include "runtime/servers/resize.h"

namespace probe::servers {
namespace {

constexpr float kRadius = 3;

float lanczos3(float x) {
  constexpr float kPi = 3.14159265359F, kNothing = 1e-3F;
  x = std::abs(x);
  if (x > kRadius) return 0;
  if (x <= kNothing) return 1;
  const auto sine = [](float angle) {
    return static_cast<float>(portable_sin(static_cast<double>(angle)));
  };
  return kRadius * sine(kPi * x) * sine(kPi * x / kRadius) / (kPi * kPi * x * x);
}

// Which pixels an output pixel is made of, and their weights.
struct Span {
  int first = 0;
  std::vector<float> weights;
};

std::vector<Span> spans_of(int in, int out) {
  const float scale = static_cast<float>(out) / static_cast<float>(in);
  const float inverse = static_cast<float>(1.0 / static_cast<double>(scale));
  const float stretch = std::max(inverse, 1.0F), shrink = 1.0F / stretch;
  std::vector<Span> spans(static_cast<std::size_t>(out));
  for (int i = 0; i < out; ++i) {
    const float center = (static_cast<float>(i) + 0.5F) * inverse;
    const auto inside = [in](float x) { return std::clamp(static_cast<int>(x), 0, in - 1); };
    Span& span = spans[static_cast<std::size_t>(i)];
    span.first = inside(std::ceil(center - kRadius * stretch - 0.5F));
    const int last = inside(std::floor(center + kRadius * stretch - 0.5F));
    float sum = 0;
    for (int x = span.first; x <= last; ++x) {
      span.weights.push_back(lanczos3((static_cast<float>(x) + 0.5F - center) * shrink));
      sum += span.weights.back();
    }
    const float whole = 1.0F / sum;
    for (float& weight : span.weights) weight *= whole;
  }
  return spans;
}

}  // namespace

wire::Bytes resize_tf_lanczos3(const policy::Image& image, int width, int height) {
  const auto row = static_cast<std::size_t>(image.width) * 3;
  const std::vector<Span> rows = spans_of(image.height, height),
                          columns = spans_of(image.width, width);
  wire::Bytes resized;
  resized.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  std::vector<float> line(row);
  for (const Span& down : rows) {
    std::fill(line.begin(), line.end(), 0.0F);
    const std::uint8_t* from = image.rgb.data() + static_cast<std::size_t>(down.first) * row;
    for (const float weight : down.weights) {
      for (float& sum : line) sum += weight * static_cast<float>(*from++);
    }
    for (const Span& across : columns) {
      float sums[3] = {};
      const float* at = line.data() + static_cast<std::size_t>(across.first) * 3;
      for (const float weight : across.weights) {
        for (float& sum : sums) sum += weight * *at++;
      }
      // To the nearest, halves to the even one, as it is the mode of floating point.
      for (const float sum : sums)
        resized.push_back(static_cast<std::uint8_t>(std::clamp(std::nearbyint(sum), 0.0F, 255.0F)));
    }
  }
  return resized;
}

}  // namespace probe::servers
