// What an instruction forbids or leaves as it is, held to what success wants.
#include "compiler/check/clause_lacks.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {
namespace {

Lack thing_lack(const ClauseFacts& facts, const Clause& clause, ObjectId thing) {
  if (clause.does == Does::kPuts && clause.goes && clause.where.size() == 1) {
    const auto one = facts.bearing(thing, *clause.where.begin());
    if (one && one->near && one->asked && !one->apart)
      return "success wants " + facts.name(thing) + " to be there";
  }
  if (clause.does == Does::kTakes && facts.goal.raised.contains(thing))
    return "success wants " + facts.name(thing) + " to be higher than it began";
  if (clause.does != Does::kOpens && clause.does != Does::kCloses) return std::nullopt;
  const auto way = facts.goal.ways.find(thing);
  if (way == facts.goal.ways.end() || way->second.other) return std::nullopt;
  const bool closes = clause.does == Does::kCloses;
  if (!(closes ? way->second.closes && !way->second.opens
               : way->second.opens && !way->second.closes))
    return std::nullopt;
  return "success is that " + facts.name(thing) + " has moved at " + (closes ? "most" : "least") +
         " so far";
}

}  // namespace

Lack denied_lack(const ClauseFacts& facts, const Clause& clause) {
  for (const Clause::What& what : clause.what) {
    // Of several nouns of one word it may be any; of a noun in the plural it is each.
    if (what.of.size() != 1 && !what.is_several) continue;
    for (const ObjectId thing : what.of) {
      if (auto why = thing_lack(facts, clause, thing)) return why;
    }
  }
  return std::nullopt;
}

Lack left_lack(const ClauseFacts& facts, const Clauses::Left& left) {
  const std::string said = fold_case(left.words);
  const bool is_kept_off =
      said.starts_with("keep ") && (has_words(said, "off") || has_words(said, "away from"));
  if (left.is_spared && is_kept_off && left.of.size() == 2) {
    const auto one = facts.bearing(*left.of.begin(), *left.of.rbegin());
    if (one && one->near && one->asked && !one->apart) {
      const bool is_first = facts.goal.above.contains({*left.of.begin(), *left.of.rbegin()});
      return "success wants " + facts.name(is_first ? *left.of.begin() : *left.of.rbegin()) +
             " to be there";
    }
  }
  if (!left.is_spared || left.of.size() != 1) return std::nullopt;
  const ObjectId thing = *left.of.begin();
  const auto begins = [&](std::string_view text) { return said.starts_with(text); };
  if (facts.goal.raised.contains(thing) &&
      (begins("without lifting ") || begins("without raising ") || begins("without picking ")))
    return "success wants " + facts.name(thing) + " to be higher than it began";
  const bool is_left = begins("leave ") && (has_words(said, "alone") || has_words(said, "where"));
  if (facts.goal.shifted.contains(thing) &&
      (is_left || begins("without moving ") || begins("not move ")))
    return "success wants " + facts.name(thing) + " to be elsewhere than it began";
  return std::nullopt;
}

}  // namespace probe::sema
