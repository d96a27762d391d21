#include "compiler/check/told.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace probe::sema {

bool Told::says(Asks asks) {
  return std::any_of(text_.words.begin(), text_.words.end(),
                     [&](const GoalWords& one) { return one.asks == asks && tells_to(one); });
}

bool Told::tells_to(const GoalWords& one) {
  constexpr auto kBefore =
      std::to_array<std::string_view>({"and", "then", "please", "to", "first", "you", "can",
                                       "could", "should", "must", "now", "or", "but", "just"});
  const std::size_t length = folded_words(one.words).size();
  const auto& words = said().words;
  for (auto at = said().find(one.words); at; at = said().find(one.words, *at + 1)) {
    if (*at + length < words.size() && words[*at + length].text == "to") continue;
    if (length > 1 || *at == 0) return true;
    const std::string& before = words[*at - 1].text;
    if (before.ends_with("ly") ||
        std::find(kBefore.begin(), kBefore.end(), before) != kBefore.end())
      return true;
  }
  return false;
}

bool Told::tells_which(std::size_t at) {
  static constexpr std::string_view kTakes[] = {"pick", "grasp", "grab", "take", "lift"};
  static constexpr std::string_view kPuts[] = {"put",  "place", "move", "set",
                                               "drop", "push",  "lay",  "bring"};
  const auto is_in = [](const auto& words, std::string_view word) {
    return std::find(std::begin(words), std::end(words), word) != std::end(words);
  };
  while (at-- > 0) {
    const std::string_view word = said().words[at].text;
    if (is_in(kPuts, word)) return false;
    if (is_in(kTakes, word)) return true;
  }
  return false;
}

bool Told::is_asked(const Things& things) {
  return std::any_of(goal().asked.begin(), goal().asked.end(), [&](const Goal::Asked& asked) {
    return std::any_of(asked.of.begin(), asked.of.end(), [&](const Things& of) {
      return std::any_of(of.begin(), of.end(), [&](ObjectId id) { return things.contains(id); });
    });
  });
}

std::optional<std::size_t> Told::earliest(const Things& things) {
  std::optional<std::size_t> found;
  for (const ObjectId thing : things) {
    const auto at = said().first(thing);
    if (at && (!found || *at < *found)) found = at;
  }
  return found;
}

std::string Told::name_of(const Things& things) const {
  return "`" + model_.objects[*things.begin()].name + "`";
}

}  // namespace probe::sema
