// Large whole numbers in sentences.
#pragma once

#include <cstddef>
#include <string>

namespace probe {

// "1,224".
inline std::string digit_groups(std::size_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

}  // namespace probe
