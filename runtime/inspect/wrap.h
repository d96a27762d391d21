// Text of people in lines of a screen.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace probe::inspect {

// At most `width` characters a line, broken at blanks; a longer word has a line of its own. At
// least one line.
std::vector<std::string> lines_of(std::string_view text, std::size_t width);
// The same as one text; lines after the first are indented by two.
std::string wrapped(std::string_view text, std::size_t width);

}  // namespace probe::inspect
