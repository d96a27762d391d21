// What a clause opens or closes, held to how far success wants the joint to have moved.
#include <algorithm>

#include "compiler/check/clause_lacks.h"

namespace probe::sema {

Lack joint_lack(const ClauseFacts& facts, const Clause& clause, const Clause::What& what) {
  const Things parts = facts.parts_of(what);
  if (parts.empty() || facts.goal.moves_unnamed) return std::nullopt;
  // What is done last is what is left.
  for (const Clause* later = &clause + 1;
       later != facts.clauses.all.data() + facts.clauses.all.size(); ++later) {
    const bool moves = later->does == Does::kOpens || later->does == Does::kCloses ||
                       later->does == Does::kOther || !later->certain;
    const Things others = facts.parts_of(*later);
    if (moves && (later->what.empty() || others.empty() ||
                  std::any_of(others.begin(), others.end(),
                              [&](ObjectId id) { return parts.contains(id); })))
      return std::nullopt;
  }
  const bool closes = clause.does == Does::kCloses;
  Goal::Way all;
  bool has_way = false, is_any_free = false;  // of several it may be any that is meant
  for (const ObjectId part : parts) {
    if (facts.is_spoken(part) && !facts.goal.ways.contains(part)) return std::nullopt;
    const auto way = facts.goal.ways.find(part);
    is_any_free = is_any_free || way == facts.goal.ways.end();
    if (way == facts.goal.ways.end()) continue;
    has_way = true;
    all.opens = all.opens || way->second.opens;
    all.closes = all.closes || way->second.closes;
    all.other = all.other || way->second.other;
  }
  if (has_way) {
    if (is_any_free || all.other || (closes ? all.closes : all.opens)) return std::nullopt;
    return "success is that " + facts.name(*parts.begin()) + " has moved at " +
           (closes ? "least" : "most") + " so far";
  }
  // What is kept as it is may be the matter of another metric.
  if (clause.is_kept) {
    for (const ObjectId part : parts) {
      if (is_measured(facts.model, facts.task, part)) return std::nullopt;
    }
    return "no metric measures anything of " + facts.name(*parts.begin());
  }
  const bool is_about = std::any_of(parts.begin(), parts.end(), [&](ObjectId part) {
    return std::any_of(facts.goal.bearings.begin(), facts.goal.bearings.end(),
                       [&](const auto& one) {
                         const auto is_of = [&](ObjectId id) {
                           return facts.of(id) && facts.of(id)->fixture == facts.of(part)->fixture;
                         };
                         return is_of(one.first.first) || is_of(one.first.second);
                       });
  });
  // What lies in a drawer got there through its being open; what is not done last may be the way
  // to what is.
  const bool is_last = &clause == &facts.clauses.all.back();
  if ((!closes && is_about) || !is_last || !facts.clauses.is_whole) return std::nullopt;
  if (facts.goal.spoken.empty() && facts.goal.ways.empty() && facts.goal.bearings.empty())
    return std::nullopt;
  return "success asks nothing of how far " + facts.name(*parts.begin()) + " has moved";
}

}  // namespace probe::sema
