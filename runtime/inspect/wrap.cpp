#include "runtime/inspect/wrap.h"

#include <algorithm>

namespace probe::inspect {

std::vector<std::string> lines_of(std::string_view text, std::size_t width) {
  std::vector<std::string> lines = {""};
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width)
      lines.emplace_back();
    if (!lines.back().empty()) lines.back() += ' ';
    lines.back() += word;
  }
  return lines;
}

std::string wrapped(std::string_view text, std::size_t width) {
  std::string out;
  for (const std::string& line : lines_of(text, width - 2))
    out += (out.empty() ? "" : "\n  ") + line;
  return out;
}

}  // namespace probe::inspect
