#include "compiler/check/clause_goal.h"

#include <algorithm>

#include "compiler/check/clause_facts.h"
#include "compiler/check/clause_lacks.h"

namespace probe::sema {
std::optional<std::string> clause_lack(const Model& model, const Task& task, const Clauses& clauses,
                                       const Goal& goal, bool is_alone) {
  // What has no success is told elsewhere.
  if (std::none_of(task.judged.begin(), task.judged.end(),
                   [](const Metric& metric) { return metric.name == "success"; }))
    return std::nullopt;
  const ClauseFacts facts{model, task, clauses, goal, is_alone};
  for (const Clause& clause : facts.clauses.all) {
    if (!clause.certain) continue;
    std::optional<std::string> why;
    if (clause.denied) {
      if (why = denied_lack(facts, clause); why)
        return std::string("says \"") + (clause.is_none ? "" : "not ") + clause.words + "\" and " +
               *why;
      continue;
    }
    if (clause.does == Does::kPuts && clause.goes) why = put_lack(facts, clause);
    if (!why) why = spared_lack(facts, clause);
    if (!why && (clause.does == Does::kPuts || clause.does == Does::kTakes)) {
      why = count_lack(facts, clause);
      if (!why) why = quantity_lack(facts, clause);
      if (!why) why = from_lack(facts, clause);
      if (!why) why = ground_lack(facts, clause);
      if (!why) why = taken_lack(facts, clause);
      if (!why) why = begun_lack(facts, clause);
    }
    if (!why) why = idle_lack(facts, clause);
    if (!why) why = raised_lack(facts, clause);
    if (!why && (clause.does == Does::kOpens || clause.does == Does::kCloses)) {
      why = quantity_lack(facts, clause);
      for (const Clause::What& what : clause.what) {
        if (!why) why = joint_lack(facts, clause, what);
      }
    }
    if (!why && !clause.repeats.empty() && facts.goal.forgets)
      why = "success is the same after once as after " + clause.repeats;
    if (why) return "says \"" + clause.words + "\" and " + *why;
  }
  for (const Clauses::Left& left : facts.clauses.left) {
    if (const auto why = left_lack(facts, left)) return "says \"" + left.words + "\" and " + *why;
  }
  for (const Rank& rank : facts.clauses.ranks) {
    if (const auto why = rank_lack(facts, rank)) return "says \"" + rank.words + "\" and " + *why;
  }
  return place_left_out(facts);
}

}  // namespace probe::sema
