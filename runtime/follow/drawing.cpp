#include "runtime/follow/drawing.h"

#include <algorithm>

#include "runtime/base/utf8.h"

namespace probe::follow {
namespace {

// The first letters of a line, as many as a row has. Wide letters take two columns; names of tasks
// have none, and what a policy says is cut a little late at worst.
std::string in_row(const std::string& line, std::size_t columns) {
  if (columns == 0) return line;
  std::size_t at = 0, before = 0;  // behind so many letters, and behind one fewer
  for (std::size_t letters = 0; at < line.size() && letters + 1 < columns; ++letters) {
    before = at;  // a full row wraps on some terminals
    at += std::max<std::size_t>(1, first_utf8(std::string_view(line).substr(at)).bytes);
  }
  return at < line.size() ? line.substr(0, before) + "\u2026" : line;
}

}  // namespace

std::string Drawing::next(const std::vector<std::string>& lines, std::size_t columns,
                          std::size_t rows) {
  std::string text;
  if (drawn_ > 0) text += "\033[" + std::to_string(drawn_) + "A";
  // The cursor rests in the row below.
  drawn_ = rows > 1 ? std::min(lines.size(), rows - 1) : lines.size();
  for (std::size_t i = 0; i < drawn_; ++i)
    text += "\r\033[K" + in_row(lines[i], columns) + "\n";
  return text + "\033[J";
}

}  // namespace probe::follow
