// "between A and B", held to what success measures to both.
#include <algorithm>
#include <vector>

#include "compiler/check/word_lacks.h"

namespace probe::sema {

std::optional<std::string> among_word_lack(Told& told, const GoalWords& one) {
  if (told.goal().tells_sides) return std::nullopt;
  const auto at = told.said().find(one.words);
  if (!at || told.tells_which(*at)) return std::nullopt;
  // What it stands before is not understood.
  if (*at == 0 && !told.clauses().is_whole) return std::nullopt;
  std::vector<Things> behind;
  for (std::size_t i = *at + 1; i < told.said().words.size() && behind.size() < 2; ++i) {
    if (!told.said().words[i].of.empty()) behind.push_back(told.said().words[i].of);
  }
  // "Between yourself and the plate": of one of them there is no telling.
  if (behind.empty() || (behind.size() == 1 && behind.front().size() == 1)) return std::nullopt;
  const Things& a = behind.front();
  const Things& b = behind.back();  // of several that one slot means they are the same
  const auto is_compared = [&](ObjectId thing, const Things& with) {
    return std::any_of(with.begin(), with.end(), [&](ObjectId other) {
      return told.goal().compared.contains(std::minmax(thing, other));
    });
  };
  const std::vector<ObjectId> there = nameable(told.model(), told.task());
  if (std::any_of(there.begin(), there.end(), [&](ObjectId thing) {
        return !a.contains(thing) && !b.contains(thing) && is_compared(thing, a) &&
               is_compared(thing, b);
      }))
    return std::nullopt;
  return "its success measures nothing to both of what that stands before";
}

}  // namespace probe::sema
