// "then", "before", "after": held to the order that success wants.
#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "compiler/check/word_lacks.h"

namespace probe::sema {
namespace {

// "put B there once A is on it", not "at once" or "once more".
bool is_of_time(Told& told) {
  const auto at = told.said().find("once");
  if (!at || *at + 1 >= told.said().words.size()) return false;
  const std::string& next = told.said().words[*at + 1].text;
  return (*at == 0 || told.said().words[*at - 1].text != "at") && next != "more" &&
         next != "again" && next != "and";
}

bool is_denied_before(Told& told, std::size_t at) {
  const auto& words = told.said().words;
  return std::any_of(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(at),
                     [](const Said::Word& word) {
                       return word.text == "not" || word.text == "don't" || word.text == "never";
                     });
}

// "do not put B there until A is on it".
bool is_denied_until(Told& told) {
  const auto at = told.said().find("until");
  return at && is_denied_before(told, *at);
}

// Whether one predicate is asked of both, of parts: "open the top drawer, then the middle drawer".
bool is_asked_alike(Told& told, ObjectId a, ObjectId b) {
  const auto has = [&](PredicateId predicate, ObjectId thing) {
    return told.goal().asked.contains({predicate, {Things{thing}}});
  };
  return std::any_of(
      told.goal().asked.begin(), told.goal().asked.end(),
      [&](const Goal::Asked& asked) { return has(asked.predicate, a) && has(asked.predicate, b); });
}

// Whether nothing that is asked of A is asked of A and B together.
bool is_beside(Told& told, ObjectId a, ObjectId b) {
  return std::none_of(told.goal().asked.begin(), told.goal().asked.end(),
                      [&](const Goal::Asked& asked) {
                        return std::any_of(asked.of.begin(), asked.of.end(),
                                           [&](const Things& of) { return of.contains(a); }) &&
                               std::any_of(asked.of.begin(), asked.of.end(),
                                           [&](const Things& of) { return of.contains(b); });
                      });
}

// Whether the first has to come before the other, or before one that has to.
bool comes_before(Told& told, ObjectId a, ObjectId b) {
  Things reached = {a};
  for (bool is_more = true; is_more && !reached.contains(b);) {
    is_more = false;
    for (const auto& [first, second] : told.goal().order) {
      if (!std::ranges::any_of(first, [&](ObjectId id) { return reached.contains(id); })) continue;
      for (const ObjectId id : second) is_more = reached.insert(id).second || is_more;
    }
  }
  return reached.contains(b);
}
bool is_ordered(Told& told, ObjectId a, ObjectId b) {
  return comes_before(told, a, b) || comes_before(told, b, a);
}

// Two objects that are said on both sides of the word, of each of which something is asked that
// the other has no part in.
std::optional<std::string> no_order(Told& told, const GoalWords& one) {
  const auto at = told.said().find(one.words);
  if (!at) return std::nullopt;
  std::set<ObjectId> before, behind;
  for (const Goal::Asked& asked : told.goal().asked) {
    if (asked.of.empty() || asked.of[0].size() != 1) continue;
    const ObjectId thing = *asked.of[0].begin();
    const auto first = told.said().first(thing);
    if (!first) continue;
    (*first < *at ? before : behind).insert(thing);
  }
  for (const ObjectId a : before) {
    for (const ObjectId b : behind) {
      // "Open the drawer, then put the cup in it" says the way there.
      const bool is_way = told.model().objects[a].of || told.model().objects[b].of;
      if (is_way && !is_asked_alike(told, a, b)) continue;
      if (is_beside(told, a, b) && is_beside(told, b, a) && !is_ordered(told, a, b))
        return "its success wants no order of `" + told.model().objects[a].name + "` and `" +
               told.model().objects[b].name + "`";
    }
  }
  return std::nullopt;
}

bool speaks_back(Told& told, std::size_t at) {
  constexpr auto kBack =
      std::to_array<std::string_view>({"that", "this", "it", "them", "which", "these", "those"});
  return at < told.said().words.size() &&
         std::find(kBack.begin(), kBack.end(), told.said().words[at].text) != kBack.end();
}

std::optional<std::string> other_order(Told& told, const GoalWords& one) {
  for (const auto& [first, second] : told.goal().order) {
    const auto a = told.earliest(first), b = told.earliest(second);
    if (!a || !b || *a == *b) continue;
    // Between the two, else at the beginning, where "then" and "afterwards" ask for nothing.
    auto at = told.said().find(one.words, std::min(*a, *b));
    const bool is_between = at && *at < std::max(*a, *b);
    const bool leads = one.words == "before" || one.words == "prior to" || one.words == "ahead of";
    if (!is_between && !leads && one.asks != Asks::kAfter) continue;
    if (!is_between) at = told.said().find(one.words);
    if (!at || (!is_between && *at > std::min(*a, *b))) continue;
    if (*at > 0 && told.said().words[*at - 1].text == "not") continue;
    // "Do not put B there before A is": that is A first.
    if (leads && is_denied_before(told, *at)) continue;
    // "After that" and "before it" speak of what was said before.
    const bool looks_back = speaks_back(told, *at + 1);
    const bool is_forward = (one.asks == Asks::kThen) == (is_between != (looks_back && is_between));
    if ((*a < *b) == is_forward) continue;
    return "succeeds when " + told.name_of(first) + " comes before " + told.name_of(second);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> order_word_lack(Told& told, const GoalWords& one) {
  if (one.words == "once" && !is_of_time(told)) return std::nullopt;
  if (one.words == "until" && !is_denied_until(told)) return std::nullopt;
  if (auto lack = other_order(told, one)) return lack;
  for (const auto& [first, second] : told.goal().order) {
    if (told.earliest(first) && told.earliest(second) && !told.is_asked(second))
      return "succeeds without " + told.name_of(second);
  }
  return no_order(told, one);
}

}  // namespace probe::sema
