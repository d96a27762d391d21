// What must be left as it is, held to whether something measures it.
#include <algorithm>
#include <string_view>

#include "compiler/check/word_lacks.h"

namespace probe::sema {
namespace {

bool says_leave(std::string_view word) {
  return word == "alone" || word == "where" || word == "untouched" || word == "as";
}

}  // namespace

std::optional<std::string> spare_word_lack(Told& told, const GoalWords& one) {
  const auto at = told.said().find(one.words);
  if (!at || told.goal().speaks_of_all) return std::nullopt;
  for (std::size_t i = *at + 1; i < told.said().words.size(); ++i) {
    const Things& spared = told.said().words[i].of;
    if (spared.empty()) continue;
    if (std::any_of(spared.begin(), spared.end(),
                    [&](ObjectId thing) { return told.goal().spoken.contains(thing); }))
      return std::nullopt;
    return "its success measures nothing of " + told.name_of(spared);
  }
  return std::nullopt;
}

std::optional<std::string> leave_word_lack(Told& told, const GoalWords& one) {
  const auto at = told.said().find(one.words);
  if (!at) return std::nullopt;
  const auto& words = told.said().words;
  for (std::size_t i = *at; i < words.size(); ++i) {
    const Things& spared = words[i].of;
    if (spared.empty()) continue;
    if (one.words == "leave" && (i + 1 >= words.size() || !says_leave(words[i + 1].text)))
      return std::nullopt;
    if (std::any_of(spared.begin(), spared.end(),
                    [&](ObjectId thing) { return is_measured(told.model(), told.task(), thing); }))
      return std::nullopt;
    return "no metric measures anything of " + told.name_of(spared);
  }
  return std::nullopt;
}

}  // namespace probe::sema
