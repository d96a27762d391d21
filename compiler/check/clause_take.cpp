// What a clause takes away, or puts down beside everything: held to where success wants it.
#include <algorithm>

#include "compiler/check/clause_lacks.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {
Lack from_lack(const ClauseFacts& facts, const Clause& clause) {
  if (clause.goes || clause.from.size() != 1 || clause.what.size() != 1) return std::nullopt;
  const auto moved = handled(clause, clause.what[0]);
  if (moved.size() != 1 || !facts.task.is_object(moved[0]) ||
      facts.is_moved_later(clause, moved[0]))
    return std::nullopt;
  const auto one = facts.bearing(moved[0], *clause.from.begin());
  if (!one || !one->near || !one->asked || one->apart) return std::nullopt;
  // By another number than just "higher" it may be above it and off it.
  if (one->other && !facts.goal.above.contains({moved[0], *clause.from.begin()}))
    return std::nullopt;
  return "success wants " + facts.name(moved[0]) + " to be there";
}

Lack ground_lack(const ClauseFacts& facts, const Clause& clause) {
  if (clause.ground.empty() || clause.does != Does::kPuts || !clause.where.empty() ||
      clause.what.size() != 1)
    return std::nullopt;
  const auto moved = handled(clause, clause.what[0]);
  if (moved.size() != 1 || facts.is_moved_later(clause, moved[0])) return std::nullopt;
  const auto low = facts.lies_upon(moved[0]);
  if (!low || facts.clauses.said.contains(*low)) return std::nullopt;
  return "success " + facts.asks(moved[0], *low);
}

Lack taken_lack(const ClauseFacts& facts, const Clause& clause) {
  // "Put it on the tray, lifting it carefully" takes it before.
  if (clause.does != Does::kTakes || clause.what.size() != 1 || !facts.goal.forgets ||
      !has_words(fold_case(clause.words), "again"))
    return std::nullopt;
  for (const Clause* put = facts.clauses.all.data(); put != &clause; ++put) {
    if (!put->certain || put->does != Does::kPuts || !put->goes || put->where.size() != 1 ||
        put->what.size() != 1)
      continue;
    const auto moved = handled(*put, put->what[0]);
    const auto taken = handled(*put, clause.what[0]);
    if (moved.size() != 1 || taken != moved || facts.is_moved_later(clause, moved[0])) continue;
    const auto one = facts.bearing(moved[0], *put->where.begin());
    if (one && one->near && one->asked && !one->apart && facts.lies_upon(moved[0]))
      return "success wants " + facts.name(moved[0]) + " to lie there at the end";
  }
  return std::nullopt;
}

Lack place_left_out(const ClauseFacts& facts) {
  if (!facts.clauses.is_whole || facts.clauses.all.empty()) return std::nullopt;
  const bool takes_alone =
      std::all_of(facts.clauses.all.begin(), facts.clauses.all.end(), [](const Clause& clause) {
        return clause.does == Does::kTakes && clause.certain && !clause.denied &&
               clause.where.empty() && clause.ground.empty() && clause.what.size() == 1 &&
               clause.what[0].of.size() == 1;
      });
  if (!takes_alone) return std::nullopt;
  const Clause& last = facts.clauses.all.back();
  const ObjectId thing = *last.what[0].of.begin();
  const auto low = facts.lies_upon(thing);
  if (!low || facts.clauses.said.contains(*low)) return std::nullopt;
  return "says \"" + last.words + "\" and no place, and success " + facts.asks(thing, *low);
}

}  // namespace probe::sema
