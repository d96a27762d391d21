// Places of a text as editors count them: lines from 0, and in a line UTF-16 code units.
#pragma once

#include <compare>
#include <cstdint>
#include <string_view>
#include <vector>

namespace probe::language {

struct Position {
  std::uint32_t line = 0, character = 0;
  auto operator<=>(const Position&) const = default;
};
struct Range {
  Position begin, end;
  auto operator<=>(const Range&) const = default;
};

// Where the lines of a text begin. "\n", "\r\n" and "\r" end one, as the protocol has it. A byte
// order mark is no character, for editors do not send it. The text outlives it.
class Lines {
 public:
  explicit Lines(std::string_view text);

  // An offset behind the end counts as the end, one within a character as its begin.
  Position position(std::uint32_t offset) const;
  Range range(std::uint32_t begin, std::uint32_t end) const {
    return {position(begin), position(end)};
  }
  // A place behind the end of its line counts as that end, one within a pair of surrogates as
  // before it; a line behind the last one as the end of the text.
  std::uint32_t offset(const Position& position) const;
  std::uint32_t size() const { return static_cast<std::uint32_t>(starts_.size()); }

 private:
  std::string_view line(std::uint32_t number) const;  // without what ends it

  std::string_view text_;
  std::vector<std::uint32_t> starts_;
};

}  // namespace probe::language
