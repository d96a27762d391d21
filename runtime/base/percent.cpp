#include "runtime/base/percent.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace probe {

std::string percent_text(std::int64_t k, std::int64_t n) {
  if (n <= 0) return "0.0";
  const std::int64_t tenths = (2000 * k + n) / (2 * n);
  return fmt::format("{}.{}", tenths / 10, tenths % 10);
}

NearestCounts nearest_counts(double percent, int decimals, std::int64_t n) {
  constexpr double kRounding = 1e-9;  // of the percentage itself
  const double exact = percent / 100 * static_cast<double>(n);
  NearestCounts found;
  found.below =
      std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(exact + kRounding)), 0, n);
  found.above = std::min(found.below + 1, n);
  const double half_digit = 0.5 * std::pow(10.0, -decimals) + kRounding;
  for (const std::int64_t k : {found.below, found.above}) {
    const double rate = 100 * static_cast<double>(k) / static_cast<double>(n);
    if (std::abs(rate - percent) <= half_digit) return {true, k, k};
  }
  return found;
}

double rounded(double value, int digits) {
  const double scale = std::pow(10.0, digits);
  const double size = std::floor(std::abs(value) * scale + 0.5 + 1e-9) / scale;
  return value < 0 && size > 0 ? -size : size;
}

std::string decimal_text(double value, int digits) {
  return fmt::format("{:.{}f}", rounded(value, digits), digits);
}

std::string signed_text(double value, int digits) {
  const std::string text = decimal_text(value, digits);
  return text[0] == '-' ? text : "+" + text;
}

std::string percent_range(double low, double high, std::string_view between) {
  constexpr int kMostDigits = 2;
  for (int digits = 0;; ++digits) {
    const std::string from = decimal_text(100 * low, digits);
    const std::string to = decimal_text(100 * high, digits);
    if (from != to || low == high || digits == kMostDigits)
      return fmt::format("{}{}{}", from, between, to);
  }
}

}  // namespace probe
