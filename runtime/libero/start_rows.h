// A table of starts, row by row: "0,source,-0.08,0.014,0.97,1,0,0,0,".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace probe::libero {

// The cells of a row and their columns.
constexpr std::size_t kStartCell = 0, kWhatCell = 1, kXCell = 2, kYCell = 3,
                      kTurnCell = 5;  // w x y z

inline std::vector<std::string> cells_of(std::string_view row) {
  std::vector<std::string> cells;
  for (;; row.remove_prefix(row.find(',') + 1)) {
    cells.emplace_back(row.substr(0, row.find(',')));
    if (row.find(',') == row.npos) return cells;
  }
}

// The rows one after the other, the head first, each with the end of its line.
template <typename See>
void for_each_row(std::string_view table, const See& see) {
  while (!table.empty()) {
    const std::size_t end = table.find('\n') + 1;
    see(table.substr(0, end));
    table.remove_prefix(end);
  }
}

// What `each` makes of them.
template <typename Each>
std::string each_row(std::string_view table, const Each& each) {
  std::string out;
  for_each_row(table, [&](std::string_view row) { out += each(row); });
  return out;
}

}  // namespace probe::libero
