// Shares on the command line.
#pragma once

#include <charconv>
#include <string>
#include <string_view>

#include "runtime/base/result.h"

namespace probe::cli {

// "2%" or "0.02".
inline Result<double> read_share(const std::string& flag, const std::string& text) {
  std::string_view digits = text;
  const bool percent = digits.ends_with('%');
  if (percent) digits.remove_suffix(1);
  while (percent && digits.ends_with(' ')) digits.remove_suffix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size())
    return Failure{Fault::kUsage, flag + " takes a share such as 2% or 0.02, not `" + text + "`",
                   ""};
  return percent ? value / 100 : value;
}

}  // namespace probe::cli
