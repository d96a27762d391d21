// What can be measured of a scene: measures.def as a table.
#pragma once

#include <span>
#include <string_view>

#include "compiler/model/expr.h"

namespace probe::sema {

// The columns of measures.def.
struct MeasureInfo {
  Measure measure;
  std::string_view name;
  std::string_view params;
  char result;
  Dimension dimension;
  bool of_start;
  std::string_view meaning;
};
std::span<const MeasureInfo> all_measures();
inline const MeasureInfo& info(Measure measure) {
  return all_measures()[static_cast<std::size_t>(measure)];
}

}  // namespace probe::sema
