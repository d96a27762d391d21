// A file's words by what they stand for: colours that a grammar of words cannot give.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "compiler/language/snapshot.h"

namespace probe::language {

inline constexpr std::array<std::string_view, 13> kTokenTypes{
    "keyword",   "comment", "string", "number",    "parameter", "variable", "class",
    "namespace", "enum",    "macro",  "interface", "function",  "type"};
inline constexpr std::array<std::string_view, 2> kMoreTokenTypes{"enumMember", "property"};
// Index of a type among both lists, one behind the other.
std::uint32_t token_type(std::string_view name);

inline constexpr std::uint32_t kIsDeclaration = 1, kIsOfLanguage = 2;
inline constexpr std::array<std::string_view, 2> kTokenModifiers{"declaration", "defaultLibrary"};

struct ColouredToken {
  Span span;  // on one line
  std::uint32_t type = 0, modifiers = 0;
};
// In the order of the text; none overlaps another.
std::vector<ColouredToken> coloured(const Snapshot& snapshot, FileId file);

}  // namespace probe::language
