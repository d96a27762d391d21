// ITU-T T.81 (JPEG) by the integer arithmetic of libjpeg-turbo 2: colours by BT.601 in 16-bit fixed
// point; Loeffler, Ligtenberg and Moschytz's transform there (13-bit constants), Arai, Agui and
// Nakajima's back (8-bit constants); T.81's example tables for quantisation.
#include "runtime/servers/jpeg_round_trip.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace probe::servers {
namespace {

constexpr int kSide = 8;  // of a block
constexpr int kCenter = 128;
using Block = std::array<int, kSide * kSide>;

// T.81, tables K.1 and K.2, in the blocks' own order.
constexpr Block kLuminance = {16, 11, 10, 16, 24,  40,  51,  61,   //
                              12, 12, 14, 19, 26,  58,  60,  55,   //
                              14, 13, 16, 24, 40,  57,  69,  56,   //
                              14, 17, 22, 29, 51,  87,  80,  62,   //
                              18, 22, 37, 56, 68,  109, 103, 77,   //
                              24, 35, 55, 64, 81,  104, 113, 92,   //
                              49, 64, 78, 87, 103, 121, 120, 101,  //
                              72, 92, 95, 98, 112, 100, 103, 99};
constexpr Block kChrominance = {17, 18, 24, 47, 99, 99, 99, 99,  //
                                18, 21, 26, 66, 99, 99, 99, 99,  //
                                24, 26, 56, 99, 99, 99, 99, 99,  //
                                47, 66, 99, 99, 99, 99, 99, 99,  //
                                99, 99, 99, 99, 99, 99, 99, 99,  //
                                99, 99, 99, 99, 99, 99, 99, 99,  //
                                99, 99, 99, 99, 99, 99, 99, 99,  //
                                99, 99, 99, 99, 99, 99, 99, 99};
constexpr int kQuality = 95;

Block steps_of(const Block& table) {
  constexpr int kPercent = 200 - 2 * kQuality;  // libjpeg's meaning of a quality of 50 and more
  Block steps{};
  for (std::size_t i = 0; i < steps.size(); ++i)
    steps[i] = std::clamp((table[i] * kPercent + 50) / 100, 1, 255);
  return steps;
}

// cos(k pi / 16) sqrt(2), 1 for k = 0, in 14-bit fixed point: what the transform back leaves to the
// steps of quantisation, by row and by column.
constexpr std::array<double, kSide> kScale = {1.0, 1.387039845, 1.306562965, 1.175875602,
                                              1.0, 0.785694958, 0.541196100, 0.275899379};

Block scaled(const Block& steps) {
  constexpr int kBits = 14, kKept = 2;
  Block scaled{};
  for (std::size_t i = 0; i < scaled.size(); ++i) {
    const double factor = kScale[i / kSide] * kScale[i % kSide];
    const int fixed = static_cast<int>(factor * (1 << kBits) + 0.5);
    scaled[i] = (steps[i] * fixed + (1 << (kBits - kKept - 1))) >> (kBits - kKept);
  }
  return scaled;
}

constexpr int descale(int x, int bits) { return (x + (1 << (bits - 1))) >> bits; }

// Eight numbers, `step` apart: jfdctint's pass. Even ones come out `even` bits larger (smaller,
// where negative), all others with 13 bits more, of which `odd` are taken off.
template <bool is_first>
void transform(int* d, std::size_t step) {
  constexpr int kMore = 2, kBits = is_first ? 13 - kMore : 13 + kMore;
  const auto at = [d, step](std::size_t i) -> int& { return d[i * step]; };
  const int sum07 = at(0) + at(7), sum16 = at(1) + at(6), sum25 = at(2) + at(5);
  const int sum34 = at(3) + at(4);
  int far07 = at(0) - at(7), far16 = at(1) - at(6), far25 = at(2) - at(5), far34 = at(3) - at(4);
  const int outer = sum07 + sum34, inner = sum16 + sum25;
  const int outer_far = sum07 - sum34, inner_far = sum16 - sum25;
  if constexpr (is_first) {
    at(0) = (outer + inner) * (1 << kMore);
    at(4) = (outer - inner) * (1 << kMore);
  } else {
    at(0) = descale(outer + inner, kMore);
    at(4) = descale(outer - inner, kMore);
  }
  const int turned = (inner_far + outer_far) * 4433;
  at(2) = descale(turned + outer_far * 6270, kBits);
  at(6) = descale(turned - inner_far * 15137, kBits);

  const int z1 = (far34 + far07) * -7373, z2 = (far25 + far16) * -20995;
  const int z5 = (far34 + far16 + far25 + far07) * 9633;
  const int z3 = (far34 + far16) * -16069 + z5, z4 = (far25 + far07) * -3196 + z5;
  far34 *= 2446;
  far25 *= 16819;
  far16 *= 25172;
  far07 *= 12299;
  at(7) = descale(far34 + z1 + z3, kBits);
  at(5) = descale(far25 + z2 + z4, kBits);
  at(3) = descale(far16 + z2 + z3, kBits);
  at(1) = descale(far07 + z1 + z4, kBits);
}

// Eight numbers, `step` apart: jidctfst's pass, whose products are cut and not rounded.
void transform_back(int* d, std::size_t step) {
  constexpr int kBits = 8;
  const auto at = [d, step](std::size_t i) -> int& { return d[i * step]; };
  const auto times = [](int x, int factor) { return (x * factor) >> kBits; };
  const int a = at(0) + at(4), b = at(0) - at(4);
  const int c = at(2) + at(6), e = times(at(2) - at(6), 362) - c;
  const int even0 = a + c, even3 = a - c, even1 = b + e, even2 = b - e;

  const int z13 = at(5) + at(3), z10 = at(5) - at(3), z11 = at(1) + at(7), z12 = at(1) - at(7);
  const int z5 = times(z10 + z12, 473);
  const int odd7 = z11 + z13;
  const int odd6 = times(z10, -669) + z5 - odd7;
  const int odd5 = times(z11 - z13, 362) - odd6;
  const int odd4 = times(z12, 277) - z5 + odd5;
  at(0) = even0 + odd7;
  at(7) = even0 - odd7;
  at(1) = even1 + odd6;
  at(6) = even1 - odd6;
  at(2) = even2 + odd5;
  at(5) = even2 - odd5;
  at(4) = even3 + odd4;
  at(3) = even3 - odd4;
}

// Samples of one kind, whole blocks of them, of which the first ones are the picture's.
struct Plane {
  int width = 0, height = 0;
  std::vector<std::uint8_t> samples;
  Plane(int wide, int high)
      : width(wide), height(high), samples(static_cast<std::size_t>(wide) * high) {}
  std::uint8_t& at(int x, int y) {
    return samples[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
  }
  int at(int x, int y) const {
    return samples[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
  }
};

int whole(int length, int unit) { return (length + unit - 1) / unit * unit; }

// What lies below the picture is its last row again.
void fill_below(Plane& plane, int height) {
  for (int y = height; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) plane.at(x, y) = plane.at(x, height - 1);
  }
}

void lose(Plane& plane, const Block& table) {
  const Block steps = steps_of(table), factors = scaled(steps);
  for (int top = 0; top < plane.height; top += kSide) {
    for (int left = 0; left < plane.width; left += kSide) {
      Block block;
      for (int i = 0; i < kSide * kSide; ++i)
        block[i] = std::as_const(plane).at(left + i % kSide, top + i / kSide) - kCenter;
      for (std::size_t row = 0; row < kSide; ++row) transform<true>(&block[row * kSide], 1);
      for (std::size_t column = 0; column < kSide; ++column)
        transform<false>(&block[column], kSide);
      for (std::size_t i = 0; i < block.size(); ++i) {
        const int step = steps[i] * kSide;  // the transform's numbers are that many times larger
        const int size = (std::abs(block[i]) + step / 2) / step;
        block[i] = (block[i] < 0 ? -size : size) * factors[i];
      }
      for (std::size_t column = 0; column < kSide; ++column) transform_back(&block[column], kSide);
      for (std::size_t row = 0; row < kSide; ++row) transform_back(&block[row * kSide], 1);
      for (int i = 0; i < kSide * kSide; ++i) {
        constexpr int kBits = 5;
        plane.at(left + i % kSide, top + i / kSide) =
            static_cast<std::uint8_t>(std::clamp((block[i] >> kBits) + kCenter, 0, 255));
      }
    }
  }
}

// 16-bit fixed point, to the nearest, away from zero.
constexpr int fixed(double x) { return static_cast<int>(x * 65536 + 0.5); }
constexpr int kHalf = 1 << 15;

struct Planes {
  Plane y, cb, cr;
};

Planes to_planes(const policy::Image& image) {
  constexpr int kPair = 2;
  const int width = whole(image.width, kPair * kSide);
  // As if the last column, and the last row to make them pairs, went on.
  const int rows = whole(image.height, kPair);
  Plane y(width, whole(rows, kSide));
  Plane cb(width, rows), cr(width, rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < width; ++column) {
      const auto from = static_cast<std::size_t>(std::min(row, image.height - 1)) * image.width +
                        static_cast<std::size_t>(std::min(column, image.width - 1));
      const int r = image.rgb[from * 3], g = image.rgb[from * 3 + 1], b = image.rgb[from * 3 + 2];
      constexpr int kOffset = (kCenter << 16) + kHalf - 1;
      y.at(column, row) = static_cast<std::uint8_t>(
          (fixed(0.299) * r + fixed(0.587) * g + fixed(0.114) * b + kHalf) >> 16);
      cb.at(column, row) = static_cast<std::uint8_t>(
          (-fixed(0.16874) * r - fixed(0.33126) * g + fixed(0.5) * b + kOffset) >> 16);
      cr.at(column, row) = static_cast<std::uint8_t>(
          (fixed(0.5) * r - fixed(0.41869) * g - fixed(0.08131) * b + kOffset) >> 16);
    }
  }
  fill_below(y, rows);
  const auto halved = [&](const Plane& full) {
    Plane half(width / kPair, whole(rows / kPair, kSide));
    for (int row = 0; row < rows / kPair; ++row) {
      for (int column = 0; column < half.width; ++column) {
        const int x = kPair * column, top = kPair * row;
        // Halves are rounded down and up in turns.
        half.at(column, row) =
            static_cast<std::uint8_t>((full.at(x, top) + full.at(x + 1, top) + full.at(x, top + 1) +
                                       full.at(x + 1, top + 1) + 1 + column % kPair) >>
                                      2);
      }
    }
    fill_below(half, rows / kPair);
    return half;
  };
  return {std::move(y), halved(cb), halved(cr)};
}

// A row of `width` colours out of rows of half as many: three quarters of the nearest, a quarter of
// the next, both ways. `near` and `far` are rows of the plane.
void widen(const Plane& half, int near, int far, int count, std::vector<int>& row) {
  const auto sum = [&](int x) { return half.at(x, near) * 3 + half.at(x, far); };
  for (int x = 0; x < count; ++x) {
    const int here = sum(x);
    const int before = x > 0 ? sum(x - 1) : here, after = x + 1 < count ? sum(x + 1) : here;
    row[2 * static_cast<std::size_t>(x)] = (here * 3 + before + 8) >> 4;
    row[2 * static_cast<std::size_t>(x) + 1] = (here * 3 + after + 7) >> 4;
  }
}

// The same without interpolation, as narrow pictures have it.
void repeat(const Plane& half, int near, int count, std::vector<int>& row) {
  for (int x = 0; x < count; ++x)
    row[2 * static_cast<std::size_t>(x)] = row[2 * static_cast<std::size_t>(x) + 1] =
        half.at(x, near);
}

}  // namespace

wire::Bytes through_jpeg(const policy::Image& image) {
  Planes planes = to_planes(image);
  lose(planes.y, kLuminance);
  lose(planes.cb, kChrominance);
  lose(planes.cr, kChrominance);

  constexpr int kNarrow = 2;
  const int columns = (image.width + 1) / 2, rows = (image.height + 1) / 2;
  std::vector<int> blue(static_cast<std::size_t>(columns) * 2), red(blue.size());
  wire::Bytes rgb;
  rgb.reserve(image.rgb.size());
  for (int y = 0; y < image.height; ++y) {
    const int near = y / 2;
    const int far = std::clamp(y % 2 == 0 ? near - 1 : near + 1, 0, rows - 1);
    for (auto [half, row] : {std::pair(&planes.cb, &blue), std::pair(&planes.cr, &red)}) {
      if (columns > kNarrow) {
        widen(*half, near, far, columns, *row);
      } else {
        repeat(*half, near, columns, *row);
      }
    }
    for (int x = 0; x < image.width; ++x) {
      const int light = planes.y.at(x, y);
      const int cb = blue[static_cast<std::size_t>(x)] - kCenter;
      const int cr = red[static_cast<std::size_t>(x)] - kCenter;
      const auto put = [&](int more) {
        rgb.push_back(static_cast<std::uint8_t>(std::clamp(light + more, 0, 255)));
      };
      put((fixed(1.402) * cr + kHalf) >> 16);
      put((-fixed(0.34414) * cb - fixed(0.71414) * cr + kHalf) >> 16);
      put((fixed(1.772) * cb + kHalf) >> 16);
    }
  }
  return rgb;
}

}  // namespace probe::servers
