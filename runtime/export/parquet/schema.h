// What a table's columns are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace probe::parquet {

enum class Type : std::uint8_t { kFlag, kWhole, kReal32, kReal64, kText };

struct Column {
  std::string name;  // flat: "stats/action/mean" is one name
  Type type = Type::kWhole;
  int depth = 0;  // of its lists; 0: one value a row
  bool operator==(const Column&) const = default;
};
using Schema = std::vector<Column>;

// Deeper than any shape of ours: a picture's statistics are lists of lists of lists.
inline constexpr int kMostDepth = 4;

// Parquet's levels of a value that is there: each list counts as an optional group and a repeated
// one, the value itself as optional.
inline int definition_of(const Column& column) { return 2 * column.depth + 1; }
inline int repetition_of(const Column& column) { return column.depth; }

}  // namespace probe::parquet
