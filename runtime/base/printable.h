// Texts of others (servers, files), fit to be shown and stored: none must be able to repaint a
// terminal or to spoil a file of results.
#pragma once

#include <string>
#include <string_view>

namespace probe {

// What moves a terminal's cursor, changes its colours or orders text anew: controls, marks and
// overrides of direction, separators of lines, what has no width and no meaning here.
bool is_unsafe(char32_t code);

// For a terminal: valid UTF-8 with U+FFFD for what is unsafe or no UTF-8; line breaks and tabs
// stay.
std::string shown(std::string_view text);

// Valid UTF-8 of at most `most` bytes and "..." where more was left out. What is unsafe is a blank,
// bytes that are no UTF-8 are question marks.
std::string printable(std::string_view text, std::size_t most);

// Whether `text` is valid UTF-8 without unsafe characters, so that printable changes nothing.
bool is_printable(std::string_view text);

}  // namespace probe
