// Pillow's separable resampling for 8-bit RGB, and what is built on it.
#include "runtime/servers/resize.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "runtime/base/trig.h"
#include "runtime/servers/jpeg_round_trip.h"

namespace probe::servers {
namespace {

// Resample.c: PRECISION_BITS = 32 - 8 - 2.
constexpr int kPrecision = 22;

// For each output pixel: the first input pixel, and a fixed-point weight for it and those after.
struct Weights {
  std::size_t width = 0;  // of a row of `values`
  std::vector<int> first, count, values;
};

// A filter's weight at a distance in input pixels where the picture does not get smaller.
struct Filter {
  double support;
  double (*weight)(double distance);
};
double triangle(double x) { return std::abs(x) < 1.0 ? 1.0 - std::abs(x) : 0.0; }
double sinc(double x) {
  const double angle = x * std::numbers::pi;
  return x == 0.0 ? 1.0 : portable_sin(angle) / angle;
}
constexpr Filter kTriangle{1, triangle};
constexpr Filter kLanczos3{
    3, [](double x) { return x >= -3.0 && x < 3.0 ? sinc(x) * sinc(x / 3) : 0.0; }};

// Resample.c, precompute_coeffs and normalize_coeffs_8bpc.
Weights weights_of(int in, int out, const Filter& filter) {
  const double scale = static_cast<double>(in) / out;
  const double stretch = std::max(scale, 1.0);
  const double support = filter.support * stretch;
  const double inverse = 1.0 / stretch;
  Weights weights;
  weights.width = static_cast<std::size_t>(std::ceil(support)) * 2 + 1;
  std::vector<double> row(weights.width);
  for (int i = 0; i < out; ++i) {
    const double center = (i + 0.5) * scale;
    const int first = std::max(static_cast<int>(center - support + 0.5), 0);
    const int last = std::min(static_cast<int>(center + support + 0.5), in);
    const int count = last - first;
    double sum = 0;
    for (int x = 0; x < count; ++x) {
      row[static_cast<std::size_t>(x)] = filter.weight((x + first - center + 0.5) * inverse);
      sum += row[static_cast<std::size_t>(x)];
    }
    for (std::size_t x = 0; x < weights.width; ++x) {
      double value = x < static_cast<std::size_t>(count) ? row[x] : 0.0;
      if (sum != 0) value /= sum;
      const double half = value < 0 ? -0.5 : 0.5;
      weights.values.push_back(static_cast<int>(half + value * (1 << kPrecision)));
    }
    weights.first.push_back(first);
    weights.count.push_back(count);
  }
  return weights;
}

// Four bytes side by side, each with a sum of its own: three are a pixel, of a line all are.
using Int4 = int __attribute__((vector_size(16)));
using Byte16 = std::uint8_t __attribute__((vector_size(16)));
constexpr std::size_t kLanes = 4;

Int4 load_bytes(const std::uint8_t* from) {
  int four = 0;
  std::memcpy(&four, from, sizeof four);
  const Int4 low = {four, 0, 0, 0};
  Byte16 bytes;
  std::memcpy(&bytes, &low, sizeof bytes);
  const Byte16 apart =
      __builtin_shufflevector(bytes, bytes, 0, 4, 4, 4, 1, 4, 4, 4, 2, 4, 4, 4, 3, 4, 4, 4);
  Int4 numbers;
  std::memcpy(&numbers, &apart, sizeof numbers);
  return numbers;
}

void store_clipped(Int4 sum, std::uint8_t* to) {
  const Int4 least = {0, 0, 0, 0}, most = {255, 255, 255, 255};
  Int4 value = sum >> kPrecision;
  value = value < least ? least : value;
  value = value > most ? most : value;
  Byte16 bytes;
  std::memcpy(&bytes, &value, sizeof bytes);
  bytes = __builtin_shufflevector(bytes, bytes, 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12);
  std::memcpy(to, &bytes, kLanes);
}

// The weighted sums of `count` times four bytes, `step` bytes apart.
Int4 weighted(const std::uint8_t* from, std::size_t step, const int* weight, int count) {
  constexpr int kHalf = 1 << (kPrecision - 1);
  Int4 sum = {kHalf, kHalf, kHalf, kHalf};
  for (int k = 0; k < count; ++k, from += step) {
    const int w = weight[k];
    sum += load_bytes(from) * Int4{w, w, w, w};
  }
  return sum;
}

// Lines of `width` pixels become lines of as many as there are weights. Both passes read and write
// up to three bytes behind the last pixel.
void resample_lines(const std::uint8_t* in, std::size_t width, std::size_t lines,
                    const Weights& weights, std::uint8_t* out) {
  for (std::size_t line = 0; line < lines; ++line, in += 3 * width) {
    for (std::size_t i = 0; i < weights.first.size(); ++i, out += 3) {
      store_clipped(weighted(in + 3 * static_cast<std::size_t>(weights.first[i]), 3,
                             weights.values.data() + i * weights.width, weights.count[i]),
                    out);
    }
  }
}

// Lines of `bytes` bytes become as many as there are weights.
void resample_columns(const std::uint8_t* in, std::size_t bytes, const Weights& weights,
                      std::uint8_t* out) {
  for (std::size_t i = 0; i < weights.first.size(); ++i, out += bytes) {
    const std::uint8_t* from = in + static_cast<std::size_t>(weights.first[i]) * bytes;
    const int* weight = weights.values.data() + i * weights.width;
    for (std::size_t at = 0; at < bytes; at += kLanes)
      store_clipped(weighted(from + at, bytes, weight, weights.count[i]), out + at);
  }
}

std::size_t bytes_of(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3;
}

// A part of a picture, row by row.
wire::Bytes cut(const policy::Image& image, int left, int top, int width, int height) {
  wire::Bytes part(bytes_of(width, height));
  const std::size_t row = static_cast<std::size_t>(width) * 3;
  for (int y = 0; y < height; ++y) {
    const std::size_t from = bytes_of(image.width, top + y) + static_cast<std::size_t>(left) * 3;
    std::memcpy(part.data() + static_cast<std::size_t>(y) * row, image.rgb.data() + from, row);
  }
  return part;
}

// openpi_client.image_tools.resize_with_pad.
wire::Bytes pad(const policy::Image& image, int width, int height) {
  const double ratio = std::max(static_cast<double>(image.width) / width,
                                static_cast<double>(image.height) / height);
  const int inner_width = std::max(1, static_cast<int>(image.width / ratio));
  const int inner_height = std::max(1, static_cast<int>(image.height / ratio));
  const wire::Bytes inner = resize_bilinear(image, inner_width, inner_height);
  wire::Bytes whole(bytes_of(width, height), 0);
  const int left = (width - inner_width) / 2, top = (height - inner_height) / 2;
  const std::size_t row = static_cast<std::size_t>(inner_width) * 3;
  for (int y = 0; y < inner_height; ++y) {
    std::memcpy(whole.data() + bytes_of(width, top + y) + static_cast<std::size_t>(left) * 3,
                inner.data() + static_cast<std::size_t>(y) * row, row);
  }
  return whole;
}

wire::Bytes crop(const policy::Image& image, const ImageRule& rule) {
  const SentPart part = sent_part(image.width, image.height, rule);
  const wire::Bytes rgb = cut(image, part.left, part.top, part.width, part.height);
  return resize_bilinear({part.width, part.height, rgb}, rule.width, rule.height);
}

wire::Array to_chw_f32(const wire::Bytes& rgb, int width, int height) {
  const std::size_t pixels = rgb.size() / 3;
  wire::Array array{"<f4", {3, height, width}, wire::Bytes(rgb.size() * sizeof(float))};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t i = 0; i < pixels; ++i) {
      const float value = static_cast<float>(rgb[i * 3 + channel]) / 255.0F;
      std::memcpy(array.bytes.data() + (channel * pixels + i) * sizeof value, &value, sizeof value);
    }
  }
  return array;
}

wire::Bytes resampled(const policy::Image& image, int width, int height, const Filter& filter) {
  wire::Bytes across;
  if (width != image.width) {
    wire::Bytes in(bytes_of(image.width, image.height) + kLanes);
    std::memcpy(in.data(), image.rgb.data(), in.size() - kLanes);
    across.resize(bytes_of(width, image.height) + kLanes);
    resample_lines(in.data(), static_cast<std::size_t>(image.width),
                   static_cast<std::size_t>(image.height), weights_of(image.width, width, filter),
                   across.data());
  } else {
    across.assign(image.rgb.begin(), image.rgb.end());
    across.resize(across.size() + kLanes);
  }
  if (height == image.height) {
    across.resize(across.size() - kLanes);
    return across;
  }
  wire::Bytes out(bytes_of(width, height) + kLanes);
  resample_columns(across.data(), bytes_of(width, 1), weights_of(image.height, height, filter),
                   out.data());
  out.resize(out.size() - kLanes);
  return out;
}

}  // namespace

SentPart sent_part(int width, int height, const ImageRule& rule) {
  SentPart part{0, 0, width, height};
  if (rule.resize != Resize::kCrop || rule.width == 0) return part;
  // The largest part of the size's shape; integers, so that every machine cuts the same.
  const std::int64_t wide = std::int64_t{width} * rule.height;
  const std::int64_t high = std::int64_t{height} * rule.width;
  if (wide > high) part.width = std::max(1, static_cast<int>(high / rule.height));
  if (wide < high) part.height = std::max(1, static_cast<int>(wide / rule.width));
  part.left = (width - part.width) / 2;
  part.top = (height - part.height) / 2;
  return part;
}

wire::Bytes resize_bilinear(const policy::Image& image, int width, int height) {
  return resampled(image, width, height, kTriangle);
}

wire::Bytes resize_lanczos(const policy::Image& image, int width, int height) {
  return resampled(image, width, height, kLanczos3);
}

wire::Array to_pixels(const policy::Image& rendered, const ImageRule& rule) {
  policy::Image image = rendered;
  wire::Bytes lossy;
  if (rule.is_jpeg) image.rgb = lossy = through_jpeg(rendered);
  int width = rule.width, height = rule.height;
  wire::Bytes rgb;
  const bool as_rendered = width == 0 || (width == image.width && height == image.height);
  if (as_rendered) {
    width = image.width;
    height = image.height;
    rgb.assign(image.rgb.begin(), image.rgb.end());
  } else if (rule.resize == Resize::kPad) {
    rgb = pad(image, width, height);
  } else if (rule.resize == Resize::kCrop) {
    rgb = crop(image, rule);
  } else if (rule.resize == Resize::kLanczos) {
    rgb = resize_lanczos(image, width, height);
  } else if (rule.resize == Resize::kCv2Linear) {
    rgb = resize_cv2_linear(image, width, height);
  } else if (rule.resize == Resize::kCv2Area) {
    rgb = resize_cv2_area(image, width, height);
  } else if (rule.resize == Resize::kTfLanczos3) {
    rgb = resize_tf_lanczos3(image, width, height);
  } else {
    rgb = resize_bilinear(image, width, height);
  }
  if (rule.layout == PixelLayout::kChwF32) return to_chw_f32(rgb, width, height);
  return wire::array_u8({height, width, 3}, std::move(rgb));
}

}  // namespace probe::servers
