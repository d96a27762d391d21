#include "compiler/check/count_words.h"

#include <algorithm>
#include <array>
#include <vector>

#include "compiler/check/said.h"

namespace probe::sema {

std::size_t number_of(std::string_view word) {
  constexpr auto kNumbers = std::to_array<std::string_view>(
      {"two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"});
  if (word == "both") return 2;
  const auto at = std::find(kNumbers.begin(), kNumbers.end(), word);
  return at == kNumbers.end() ? 0 : static_cast<std::size_t>(at - kNumbers.begin()) + 2;
}

std::size_t count_at_end(std::string_view text) {
  std::vector<Said::Word> words = words_in(text);
  const auto ends_with = [&](std::string_view word) {
    return !words.empty() && words.back().text == word && !words.back().ends;
  };
  while (ends_with("the")) words.pop_back();
  const bool is_some = ends_with("of");
  if (is_some) words.pop_back();
  if (words.empty() || words.back().ends) return 0;
  const std::size_t number = number_of(words.back().text);
  const bool is_all =
      words.back().text == "both" || (words.size() > 1 && words[words.size() - 2].text == "all");
  return is_some && !is_all ? 0 : number;
}

}  // namespace probe::sema
