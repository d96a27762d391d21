#include "runtime/base/percent.h"

#include <fmt/format.h>

#include <cmath>

namespace probe {

std::string percent_text(std::int64_t k, std::int64_t n) {
  if (n <= 0) return "0.0";
  const std::int64_t tenths = (2000 * k + n) / (2 * n);
  return fmt::format("{}.{}", tenths / 10, tenths % 10);
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
