// The method of Payne and Hanek, "Radian Reduction for Trigonometric Functions" (SIGNUM, 1983): of
// x * 2/pi only the part below four quarter turns counts, so of 2/pi only the bits that contribute
// to it are multiplied, in whole numbers and so without rounding.
#include "runtime/base/trig_reduce.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace probe {
namespace {

__extension__ typedef unsigned __int128 Wide;

// A word of zeros, then 2/pi: 1280 bits after the point, enough for the largest double.
constexpr std::uint64_t kTwoOverPi[] = {
    0,
    0xa2f9836e4e441529u,
    0xfc2757d1f534ddc0u,
    0xdb6295993c439041u,
    0xfe5163abdebbc561u,
    0xb7246e3a424dd2e0u,
    0x06492eea09d1921cu,
    0xfe1deb1cb129a73eu,
    0xe88235f52ebb4484u,
    0xe99c7026b45f7e41u,
    0x3991d639835339f4u,
    0x9c845f8bbdf9283bu,
    0x1ff897ffde05980fu,
    0xef2f118b5a0a6d1fu,
    0x6d367ecf27cb09b7u,
    0x4f463f669e5fea2du,
    0x7527bac7ebe5f17bu,
    0x3d0739f78a5292eau,
    0x6bfb5fb11f8d5d08u,
    0x56033046fc7b6babu,
    0xf0cfbc209af4361du,
};

// 64 bits of the table from bit `bit` on.
std::uint64_t word_at(int bit) {
  const auto word = static_cast<std::size_t>(bit / 64);
  const int shift = bit % 64;
  if (shift == 0) return kTwoOverPi[word];
  return kTwoOverPi[word] << shift | kTwoOverPi[word + 1] >> (64 - shift);
}

// a * b = high + low, exactly (Dekker 1971). Not by a fused operation, which not every CPU has.
void multiply_exactly(double a, double b, double* high, double* low) {
  const auto upper_half = [](double x) {
    const double c = 134217729.0 * x;  // 2^27 + 1
    return c - (c - x);
  };
  const double a_high = upper_half(a), a_low = a - a_high;
  const double b_high = upper_half(b), b_low = b - b_high;
  *high = a * b;
  *low = ((a_high * b_high - *high) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

// A binary fraction of 192 bits, the first one half.
struct Fraction {
  std::uint64_t words[3];

  int leading_zeros() const {
    if (words[0] != 0) return std::countl_zero(words[0]);
    return 64 + std::countl_zero(words[1]);  // no double comes closer to a quarter turn than 2^-62
  }
  std::uint64_t word_at(int bit) const {
    const auto word = [&](int i) { return i < 3 ? words[i] : 0; };
    const int shift = bit % 64;
    if (shift == 0) return word(bit / 64);
    return word(bit / 64) << shift | word(bit / 64 + 1) >> (64 - shift);
  }
};

}  // namespace

Quarters reduce_large(double x) {
  // |x| = mantissa * 2^(exponent - 53). Bits of 2/pi with a weight of four or more, times
  // 2^exponent, are whole turns; 192 bits from there on leave an error below 2^-137.
  int exponent = 0;
  const double part = std::frexp(std::fabs(x), &exponent);
  const auto mantissa = static_cast<std::uint64_t>(std::ldexp(part, 53));
  const int first = 64 + exponent - 55;
  std::uint64_t product[3];
  Wide carry = 0;
  for (int i = 2; i >= 0; --i) {
    carry += static_cast<Wide>(mantissa) * word_at(first + 64 * i);
    product[i] = static_cast<std::uint64_t>(carry);
    carry >>= 64;
  }

  int quadrant = static_cast<int>(product[0] >> 62);
  Fraction rest{
      {product[0] << 2 | product[1] >> 62, product[1] << 2 | product[2] >> 62, product[2] << 2}};
  const bool is_above_half = rest.words[0] >> 63 != 0;
  if (is_above_half) {
    ++quadrant;
    for (std::uint64_t& word : rest.words) word = ~word;  // 1 - rest, but for 2^-192
  }

  const int zeros = rest.leading_zeros();
  const std::uint64_t a = rest.word_at(zeros), b = rest.word_at(zeros + 64);
  const double high = std::ldexp(static_cast<double>(a >> 11), -53 - zeros);
  const double low = std::ldexp(static_cast<double>((a & 0x7ff) << 42 | b >> 22), -106 - zeros);
  constexpr double kQuarter = 0x1.921fb54442d18p+0, kQuarterLow = 0x1.1a62633145c07p-54;  // pi/2
  Quarters out;
  multiply_exactly(high, kQuarter, &out.r, &out.tail);
  out.tail += high * kQuarterLow + low * kQuarter;
  const double sum = out.r + out.tail;
  out.tail += out.r - sum;
  out.r = sum;
  if (is_above_half != (x < 0)) {
    out.r = -out.r;
    out.tail = -out.tail;
  }
  out.quadrant = (x < 0 ? -quadrant : quadrant) & 3;
  return out;
}

}  // namespace probe
