// Two instructions word by word: which words are in both, in order.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace probe::inspect {

struct Word {
  std::string text;
  bool differs = false;
};
struct WordDiff {
  std::vector<Word> a, b;
};
// By a longest common subsequence of words; the earliest one on a tie.
WordDiff diff_words(std::string_view a, std::string_view b);
// "put [the orange object] on plate": runs of differing words in brackets.
std::string marked(const std::vector<Word>& words);

}  // namespace probe::inspect
