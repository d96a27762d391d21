// Words that count what stands behind them.
#pragma once

#include <cstddef>
#include <string_view>

namespace probe::sema {

// The number that a word is: 2 of "both" and "two"; 0 of others.
std::size_t number_of(std::string_view word);

// What words count that stand behind them: 3 of "put all three of the"; 0 where nothing does, and
// of "two of", which are some of more.
std::size_t count_at_end(std::string_view text);

}  // namespace probe::sema
