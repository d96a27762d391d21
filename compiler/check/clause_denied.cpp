// What an instruction forbids, held to what success wants.
#include "compiler/check/clause_lacks.h"

namespace probe::sema {
Lack denied_lack(const ClauseFacts& facts, const Clause& clause) {
  if (clause.what.size() != 1 || clause.what[0].of.size() != 1) return std::nullopt;
  const ObjectId thing = *clause.what[0].of.begin();
  if (clause.does == Does::kPuts && clause.goes && clause.where.size() == 1) {
    const auto one = facts.bearing(thing, *clause.where.begin());
    if (one && one->near && one->asked && !one->apart)
      return "success wants " + facts.name(thing) + " to be there";
  }
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

}  // namespace probe::sema
