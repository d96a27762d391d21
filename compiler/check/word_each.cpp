// "both", "all": held to whether success asks of each, or is content with one.
#include <algorithm>
#include <vector>

#include "compiler/check/word_lacks.h"

namespace probe::sema {
namespace {

bool is_each_asked(Told& told, const Things& things) {
  return std::all_of(things.begin(), things.end(),
                     [&](ObjectId thing) { return told.is_asked(Things{thing}); });
}

// "both the can and the cup" of which success asks of the can alone.
std::optional<std::string> both_lack(Told& told) {
  const auto at = told.said().find("both");
  if (!at) return std::nullopt;
  std::vector<ObjectId> behind;
  for (std::size_t i = *at + 1; i < told.said().words.size() && behind.size() < 2; ++i) {
    const Things& of = told.said().words[i].of;
    if (of.size() > 1) return std::nullopt;
    if (of.size() == 1 && (behind.empty() || behind[0] != *of.begin()))
      behind.push_back(*of.begin());
  }
  if (behind.size() < 2 || told.goal().asked.empty()) return std::nullopt;
  const bool first = told.is_asked(Things{behind[0]}), second = told.is_asked(Things{behind[1]});
  if (first == second) return std::nullopt;
  return "succeeds without " + told.name_of(Things{behind[first ? 1 : 0]});
}

}  // namespace

std::optional<std::string> each_word_lack(Told& told, const GoalWords& one) {
  for (const Things& things : told.goal().one_of) {
    const bool is_said = std::any_of(
        told.said().words.begin(), told.said().words.end(), [&](const Said::Word& word) {
          return std::includes(word.of.begin(), word.of.end(), things.begin(), things.end());
        });
    if (is_said && !is_each_asked(told, things)) return content_with_any(things);
  }
  for (const Things& two : told.goal().either) {
    const bool is_said = std::all_of(two.begin(), two.end(),
                                     [&](ObjectId thing) { return told.said().first(thing); });
    if (is_said && !is_each_asked(told, two)) return content_with_either(two);
  }
  return one.words == "both" ? both_lack(told) : std::nullopt;
}

}  // namespace probe::sema
