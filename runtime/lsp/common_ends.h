// What two texts begin with and end with alike. Header only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace probe::lsp {

// In bytes; the two do not overlap in either text.
struct CommonEnds {
  std::size_t front = 0, back = 0;
};

inline CommonEnds common_ends(std::string_view a, std::string_view b) {
  const std::size_t most = std::min(a.size(), b.size());
  CommonEnds ends;
  while (ends.front < most && a[ends.front] == b[ends.front]) ++ends.front;
  while (ends.back < most - ends.front && a[a.size() - 1 - ends.back] == b[b.size() - 1 - ends.back])
    ++ends.back;
  return ends;
}

}  // namespace probe::lsp
