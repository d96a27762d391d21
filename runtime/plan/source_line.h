// Lines of the sources that a plan carries, for people. Knows nothing of records.
#pragma once

#include <cstddef>
#include <string_view>

namespace probe::plan {

// One-based line of a byte, and that line without indentation.
struct SourceLine {
  std::size_t number = 0;
  std::string_view text;
};

// `byte` is at most the size of the source.
SourceLine line_at(std::string_view source, std::size_t byte);

}  // namespace probe::plan
