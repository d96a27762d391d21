// OpenCV's resizing of 8-bit RGB (modules/imgproc/src/resize.cpp), to the bit.
#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/servers/resize.h"

namespace probe::servers {
namespace {

constexpr int kOne = 2048;  // INTER_RESIZE_COEF_SCALE

// The two input pixels of an output pixel and what each weighs, of kOne.
struct Pair {
  int first = 0, second = 0;
  int low = kOne, high = 0;
};

// `clamps` is what happens to a pixel outside: along a row the weight becomes whole, along a column
// the pixel is repeated.
std::vector<Pair> pairs_of(int in, int out, bool is_area, bool clamps) {
  const double inverse = static_cast<double>(out) / in;
  const double scale = 1.0 / inverse;
  std::vector<Pair> pairs;
  for (int i = 0; i < out; ++i) {
    int at = 0;
    float part = 0;
    if (is_area) {
      at = static_cast<int>(std::floor(i * scale));
      part = static_cast<float>((i + 1) - (at + 1) * inverse);
      part = part <= 0 ? 0.0F : part - std::floor(part);
    } else {
      part = static_cast<float>((i + 0.5) * scale - 0.5);
      at = static_cast<int>(std::floor(part));
      part -= static_cast<float>(at);
    }
    if (clamps && at < 0) at = 0, part = 0;
    if (clamps && at >= in - 1) at = in - 1, part = 0;
    Pair pair;
    pair.first = std::clamp(at, 0, in - 1);
    pair.second = std::clamp(at + 1, 0, in - 1);
    pair.low = static_cast<int>(std::nearbyint((1.0F - part) * kOne));
    pair.high = static_cast<int>(std::nearbyint(part * kOne));
    pairs.push_back(pair);
  }
  return pairs;
}

std::size_t at(int x, int y, int width) {
  return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
          static_cast<std::size_t>(x)) *
         3;
}

wire::Bytes linear(const policy::Image& image, int width, int height, bool is_area) {
  const std::vector<Pair> across = pairs_of(image.width, width, is_area, true);
  const std::vector<Pair> down = pairs_of(image.height, height, is_area, false);
  // A row of the input at the output's width, times kOne.
  const auto row_of = [&](int y) {
    std::vector<int> row;
    for (const Pair& pair : across) {
      const std::uint8_t* first = image.rgb.data() + at(pair.first, y, image.width);
      const std::uint8_t* second = image.rgb.data() + at(pair.second, y, image.width);
      for (int c = 0; c < 3; ++c) row.push_back(first[c] * pair.low + second[c] * pair.high);
    }
    return row;
  };
  wire::Bytes out;
  out.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  for (const Pair& pair : down) {
    const std::vector<int> upper = row_of(pair.first), lower = row_of(pair.second);
    for (std::size_t i = 0; i < upper.size(); ++i) {
      const int sum = ((pair.low * (upper[i] >> 4)) >> 16) + ((pair.high * (lower[i] >> 4)) >> 16);
      out.push_back(static_cast<std::uint8_t>((sum + 2) >> 2));
    }
  }
  return out;
}

// A share of an input pixel in an output pixel.
struct Share {
  int from = 0, to = 0;
  float weight = 0;
};

// computeResizeAreaTab.
std::vector<Share> shares_of(int in, int out) {
  const double scale = 1.0 / (static_cast<double>(out) / in);
  std::vector<Share> shares;
  for (int to = 0; to < out; ++to) {
    const double begin = to * scale, end = begin + scale;
    const double cell = std::min(scale, in - begin);
    const int last = std::min(static_cast<int>(std::floor(end)), in - 1);
    const int first = std::min(static_cast<int>(std::ceil(begin)), last);
    if (first - begin > 1e-3)
      shares.push_back({first - 1, to, static_cast<float>((first - begin) / cell)});
    for (int from = first; from < last; ++from)
      shares.push_back({from, to, static_cast<float>(1.0 / cell)});
    if (end - last > 1e-3) {
      shares.push_back(
          {last, to, static_cast<float>(std::min(std::min(end - last, 1.0), cell) / cell)});
    }
  }
  return shares;
}

std::uint8_t rounded_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(std::nearbyint(value), 0.0F, 255.0F));
}

// Whole numbers of input pixels: their plain mean.
wire::Bytes whole_blocks(const policy::Image& image, int width, int height) {
  const int wide = image.width / width, high = image.height / height;
  const float share = 1.0F / static_cast<float>(wide * high);
  wire::Bytes out;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      int sum[3] = {0, 0, 0};
      for (int v = 0; v < high; ++v) {
        const std::uint8_t* from = image.rgb.data() + at(x * wide, y * high + v, image.width);
        for (int u = 0; u < 3 * wide; ++u) sum[u % 3] += from[u];
      }
      for (const int total : sum) {
        // Of 2 x 2 pixels halves are rounded up, of others to even.
        out.push_back(wide == 2 && high == 2 ? static_cast<std::uint8_t>((total + 2) >> 2)
                                             : rounded_byte(static_cast<float>(total) * share));
      }
    }
  }
  return out;
}

wire::Bytes parts(const policy::Image& image, int width, int height) {
  const std::vector<Share> across = shares_of(image.width, width);
  const std::size_t row = static_cast<std::size_t>(width) * 3;
  wire::Bytes out(row * static_cast<std::size_t>(height));
  std::vector<float> line(row), sum(row);
  int target = 0;
  const auto write = [&] {
    for (std::size_t i = 0; i < row; ++i)
      out[static_cast<std::size_t>(target) * row + i] = rounded_byte(sum[i]);
  };
  for (const Share& down : shares_of(image.height, height)) {
    std::fill(line.begin(), line.end(), 0.0F);
    for (const Share& share : across) {
      const std::uint8_t* from = image.rgb.data() + at(share.from, down.from, image.width);
      float* to = line.data() + static_cast<std::size_t>(share.to) * 3;
      for (int c = 0; c < 3; ++c) to[c] += static_cast<float>(from[c]) * share.weight;
    }
    if (down.to != target) {
      write();
      target = down.to;
      std::fill(sum.begin(), sum.end(), 0.0F);
    }
    for (std::size_t i = 0; i < row; ++i) sum[i] += down.weight * line[i];
  }
  write();
  return out;
}

}  // namespace

wire::Bytes resize_cv2_linear(const policy::Image& image, int width, int height) {
  // Halving is done as by area.
  if (image.width == 2 * width && image.height == 2 * height)
    return whole_blocks(image, width, height);
  return linear(image, width, height, false);
}

wire::Bytes resize_cv2_area(const policy::Image& image, int width, int height) {
  if (width > image.width || height > image.height) return linear(image, width, height, true);
  if (image.width % width == 0 && image.height % height == 0)
    return whole_blocks(image, width, height);
  return parts(image, width, height);
}

}  // namespace probe::servers
