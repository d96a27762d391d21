// Texts of others (servers, files), fit to be shown and stored: none must be able to repaint a
// terminal or to spoil a file of results.
#pragma once

#include <string>
#include <string_view>

namespace probe {

// Valid UTF-8 of at most `most` bytes and "..." where more was left out. Control characters are
// blanks, bytes that are no UTF-8 question marks.
std::string printable(std::string_view text, std::size_t most);

// Whether `text` is valid UTF-8 without control characters, so that printable changes nothing.
bool is_printable(std::string_view text);

}  // namespace probe
