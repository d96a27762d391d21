// Texts of a server, fit to be shown and stored: a message must not be able to repaint a terminal
// or to spoil a file of results.
#pragma once

#include <string>
#include <string_view>

namespace probe::wire {

// Valid UTF-8 of at most `most` bytes and "..." where more was left out. Control characters are
// blanks, bytes that are no UTF-8 question marks.
std::string printable(std::string_view text, std::size_t most);

}  // namespace probe::wire
