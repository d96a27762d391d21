// How many things, in sentences.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace probe {

// "1 task", "51 tasks".
inline std::string counted(std::size_t count, std::string_view thing) {
  return std::to_string(count) + " " + std::string(thing) + (count == 1 ? "" : "s");
}

}  // namespace probe
