// Lines of the CSV files of other people's numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace probe::report {

// Without blanks and line ends around it.
std::string_view trimmed(std::string_view text);

// The cells of one line, trimmed; quotes as spreadsheets write them, without line breaks inside.
std::vector<std::string> csv_cells(std::string_view line);

}  // namespace probe::report
