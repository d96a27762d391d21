#include "runtime/base/nouns.h"

#include <algorithm>
#include <array>

#include "runtime/base/utf8.h"

namespace probe {
namespace {

// How the plural is made of nouns that end so: `cut` letters are taken off and `adds` is put there.
struct Plural {
  std::string_view ends;
  std::size_t cut;
  std::string_view adds;
  bool is_last;  // whether no later row makes another spelling of it
};
// By the first row that fits a noun is written, by all up to the last it is read.
constexpr auto kPlurals = std::to_array<Plural>({
    {"s", 0, "es", true},
    {"x", 0, "es", true},
    {"z", 0, "es", true},
    {"ch", 0, "es", true},
    {"sh", 0, "es", true},
    {"ay", 0, "s", true},
    {"ey", 0, "s", true},
    {"oy", 0, "s", true},
    {"uy", 0, "s", true},
    {"y", 1, "ies", true},
    {"fe", 2, "ves", false},
    {"lf", 1, "ves", false},
    {"af", 1, "ves", false},
    {"ato", 0, "es", false},  // potato
    {"", 0, "s", false},
    {"f", 1, "ves", true},  // scarf
    {"o", 0, "es", true},   // mango
});

bool is_plural(std::string_view many, std::string_view one) {
  for (const Plural& row : kPlurals) {
    if (!one.ends_with(row.ends) || one.size() <= row.cut) continue;
    const std::string_view stem = one.substr(0, one.size() - row.cut);
    if (many.size() == stem.size() + row.adds.size() && many.starts_with(stem) &&
        many.ends_with(row.adds))
      return true;
    if (row.is_last) return false;
  }
  return false;
}

}  // namespace

std::string plural_of(std::string_view noun) {
  const auto row = std::find_if(kPlurals.begin(), kPlurals.end(),
                                [&](const Plural& each) { return noun.ends_with(each.ends); });
  return std::string(noun.substr(0, noun.size() - row->cut)) + std::string(row->adds);
}

bool is_same_noun(std::string_view a, std::string_view b) {
  // A plural begins like its noun: most words are told apart by that alone.
  if (a.empty() || b.empty() || a.front() != b.front()) return a == b;
  return a == b || is_plural(a, b) || is_plural(b, a);
}

bool is_article(std::string_view word) {
  constexpr auto kArticles = std::to_array<std::string_view>({"a", "an", "the"});
  return std::find(kArticles.begin(), kArticles.end(), word) != kArticles.end();
}

std::string with_indefinite_article(std::string_view words) {
  constexpr auto kSpokenWithVowel = std::to_array<std::string_view>({"hour", "honest", "heir"});
  constexpr auto kSpokenWithConsonant =
      std::to_array<std::string_view>({"one", "once", "uni", "use", "usb", "euro", "ufo", "ute"});
  const std::string folded = fold_case(words);
  const auto begins = [&](const auto& table) {
    return std::any_of(table.begin(), table.end(),
                       [&](std::string_view begin) { return folded.starts_with(begin); });
  };
  const bool is_vowel =
      !folded.empty() && std::string_view("aeiou").find(folded[0]) != std::string_view::npos;
  const bool an = begins(kSpokenWithVowel) || (is_vowel && !begins(kSpokenWithConsonant));
  return (an ? "an " : "a ") + std::string(words);
}

}  // namespace probe
