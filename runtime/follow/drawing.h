// Lines drawn in the place of those before, on a terminal. Text in, text out.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace probe::follow {

class Drawing {
 public:
  // What to write so that `lines` stand where the last ones stood. None takes more than one row of
  // the terminal, and all together no more than it has: a row that was wrapped or scrolled away is
  // not found again. Columns or rows 0: not known.
  std::string next(const std::vector<std::string>& lines, std::size_t columns, std::size_t rows);

 private:
  std::size_t drawn_ = 0;
};

}  // namespace probe::follow
