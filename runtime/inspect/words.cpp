#include "runtime/inspect/words.h"

#include <algorithm>
#include <cstddef>

namespace probe::inspect {
namespace {

std::vector<Word> words_of(std::string_view text) {
  std::vector<Word> words;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    if (text.empty()) return words;
    const std::size_t end = std::min(text.find(' '), text.size());
    words.push_back({std::string(text.substr(0, end)), true});
    text.remove_prefix(end);
  }
}

}  // namespace

WordDiff diff_words(std::string_view a, std::string_view b) {
  WordDiff diff{words_of(a), words_of(b)};
  const std::size_t rows = diff.a.size();
  const std::size_t columns = diff.b.size();
  // common[i][j]: the most words that what follows word i of a and word j of b have in common.
  std::vector<std::vector<std::size_t>> common(rows + 1, std::vector<std::size_t>(columns + 1, 0));
  for (std::size_t i = rows; i-- > 0;) {
    for (std::size_t j = columns; j-- > 0;) {
      common[i][j] = diff.a[i].text == diff.b[j].text
                         ? common[i + 1][j + 1] + 1
                         : std::max(common[i + 1][j], common[i][j + 1]);
    }
  }
  std::size_t i = 0, j = 0;
  while (i < rows && j < columns) {
    if (diff.a[i].text == diff.b[j].text) {
      diff.a[i++].differs = diff.b[j++].differs = false;
    } else if (common[i + 1][j] >= common[i][j + 1]) {
      ++i;
    } else {
      ++j;
    }
  }
  return diff;
}

std::string marked(const std::vector<Word>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool opens = words[i].differs && (i == 0 || !words[i - 1].differs);
    const bool closes = words[i].differs && (i + 1 == words.size() || !words[i + 1].differs);
    text += i == 0 ? "" : " ";
    text += opens ? "[" : "";
    text += words[i].text;
    text += closes ? "]" : "";
  }
  return text;
}

}  // namespace probe::inspect
