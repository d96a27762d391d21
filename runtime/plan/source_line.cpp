#include "runtime/plan/source_line.h"

#include <algorithm>

namespace probe::plan {

SourceLine line_at(std::string_view source, std::size_t byte) {
  const std::string_view before = source.substr(0, byte);
  const std::size_t newline = before.rfind('\n');
  const std::size_t begin = newline == std::string_view::npos ? 0 : newline + 1;
  std::string_view line = source.substr(begin);
  line = line.substr(0, line.find('\n', byte - begin));
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  return {static_cast<std::size_t>(std::ranges::count(before, '\n')) + 1, line};
}

}  // namespace probe::plan
