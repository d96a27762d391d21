// The name that was probably meant by a misspelt one, for messages.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace probe {

// Edits between two words, a swap of neighbours counting as one.
inline std::size_t spelling_edits(std::string_view a, std::string_view b) {
  // Three rows of the optimal string alignment table: the one being filled and the two above it.
  std::vector<std::size_t> above2(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(above2, above);
    std::swap(above, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t cost = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + cost});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], above2[j - 2] + 1);
    }
  }
  return row[b.size()];
}

// The one rule for the nearest of `known`: within a third of the name's length, at least one edit
// and at most three; the earlier on a tie. Null when nothing is near.
template <typename Name>
const Name* nearest_spelling(std::string_view name, std::span<const Name> known) {
  constexpr std::size_t kLongestName = 128;  // a longer "name" is no slip, and edits are quadratic
  if (name.size() > kLongestName) return nullptr;
  const std::size_t limit = std::clamp<std::size_t>(name.size() / 3, 1, 3);
  const Name* best = nullptr;
  std::size_t least = limit + 1;
  for (const Name& candidate : known) {
    const std::string_view text(candidate);
    if (text.size() > name.size() + limit || name.size() > text.size() + limit) continue;
    const std::size_t edits = spelling_edits(name, text);
    // One letter is no likeness: `y` is not a slip of `x`.
    if (edits >= least || edits >= std::max(name.size(), text.size())) continue;
    best = &candidate;
    least = edits;
  }
  return best;
}

// ", did you mean `NAME`?" with the nearest of `known`, else empty.
inline std::string did_you_mean(std::string_view name, std::span<const std::string> known) {
  const std::string* near = nearest_spelling(name, known);
  return near == nullptr ? std::string() : ", did you mean `" + *near + "`?";
}

}  // namespace probe
