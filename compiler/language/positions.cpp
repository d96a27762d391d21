#include "compiler/language/positions.h"

#include <algorithm>
#include <limits>

#include "runtime/base/utf8.h"

namespace probe::language {
namespace {

// Bytes of the character that begins so; of what begins none, one.
std::size_t bytes_of(char first) {
  const auto byte = static_cast<unsigned char>(first);
  return byte < 0x80 ? 1 : byte >= 0xf0 ? 4 : byte >= 0xe0 ? 3 : byte >= 0xc0 ? 2 : 1;
}

std::uint32_t units_of(char first) { return bytes_of(first) == 4 ? 2 : 1; }

}  // namespace

Lines::Lines(std::string_view text)
    : text_(text.substr(0, std::numeric_limits<std::uint32_t>::max())) {
  starts_.push_back(text_.starts_with("\xef\xbb\xbf") ? 3 : 0);
  for (std::size_t i = 0; i < text_.size(); ++i) {
    const bool is_pair = text_[i] == '\r' && i + 1 < text_.size() && text_[i + 1] == '\n';
    if ((text_[i] == '\n' || text_[i] == '\r') && !is_pair)
      starts_.push_back(static_cast<std::uint32_t>(i + 1));
  }
}

std::string_view Lines::line(std::uint32_t number) const {
  const std::uint32_t begin = starts_[number];
  std::size_t end = number + 1 < starts_.size() ? starts_[number + 1] : text_.size();
  if (number + 1 < starts_.size()) {
    while (end > begin && (text_[end - 1] == '\n' || text_[end - 1] == '\r')) --end;
  }
  return text_.substr(begin, end - begin);
}

Position Lines::position(std::uint32_t offset) const {
  offset = static_cast<std::uint32_t>(std::min<std::size_t>(offset, text_.size()));
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), offset);
  const auto number =
      after == starts_.begin() ? 0u : static_cast<std::uint32_t>(after - starts_.begin() - 1);
  const std::string_view whole = line(number);
  const std::size_t until = offset > starts_[number] ? offset - starts_[number] : 0;
  Position out{number, 0};
  for (std::size_t i = 0; i < whole.size();) {
    const std::size_t bytes = bytes_of(whole[i]);
    if (i + bytes > until) break;
    out.character += units_of(whole[i]);
    i += bytes;
  }
  return out;
}

std::uint32_t Lines::offset(const Position& position) const {
  if (position.line >= starts_.size()) return static_cast<std::uint32_t>(text_.size());
  const std::string_view whole = line(position.line);
  std::size_t at = 0;
  for (std::uint32_t units = 0; at < whole.size();) {
    units += units_of(whole[at]);
    if (units > position.character) break;
    at = std::min(at + bytes_of(whole[at]), whole.size());
  }
  return starts_[position.line] + static_cast<std::uint32_t>(at);
}

}  // namespace probe::language
