// Which elements and attributes there are, which of them are read: nothing in a file is passed over
// without a word.
#pragma once

#include <span>
#include <string_view>

namespace probe::mjcf {

struct ElementSchema {
  std::string_view tag;
  std::string_view read;           // attributes, separated by blanks
  std::string_view unread;         // known: a note says that they are not read
  std::string_view silent;         // known, and nothing to anybody who reads shapes: not even that
  std::string_view children = {};  // elements within it that are known and not read
};

// Null for what is not read as a whole.
const ElementSchema* find_schema(std::string_view tag);

// Sections and elements that are known and not read, at the outermost level, of `asset`, of a body,
// of a class.
bool is_unread_section(std::string_view tag);
bool is_unread_asset(std::string_view tag);
bool is_unread_in_body(std::string_view tag);
bool is_unread_in_default(std::string_view tag);

bool has_word(std::string_view words, std::string_view word);

}  // namespace probe::mjcf
