// What a clause takes away, or puts down beside everything: held to where success wants it.
#include <algorithm>
#include <array>
#include <string_view>

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

Lack begun_lack(const ClauseFacts& facts, const Clause& clause) {
  if (!facts.is_alone || !clause.begins_there || clause.from.size() != 1 ||
      clause.what.size() != 1 || facts.task.starts.empty())
    return std::nullopt;
  const auto moved = handled(clause, clause.what[0]);
  const ObjectId place = *clause.from.begin();
  if (moved.size() != 1 || !facts.task.is_object(moved[0]) || facts.lies_on(moved[0], place))
    return std::nullopt;
  // A table of starts does not say what lies in what.
  if (!facts.task.is_object(place) && !facts.model.layouts[facts.task.layout].given.empty())
    return std::nullopt;
  // What an earlier clause put there, or may have.
  for (const Clause* earlier = facts.clauses.all.data(); earlier != &clause; ++earlier) {
    const bool is_other = earlier->does == Does::kOpens || earlier->does == Does::kCloses;
    if (!is_other || !earlier->certain) return std::nullopt;
  }
  return facts.name(moved[0]) + " does not begin there";
}

Lack idle_lack(const ClauseFacts& facts, const Clause& clause) {
  const Goal& goal = facts.goal;
  const bool asks_nothing = goal.spoken.empty() && goal.ways.empty() && goal.bearings.empty() &&
                            !goal.speaks_of_all && !goal.asks_of_all && !goal.moves_unnamed &&
                            !goal.tells_sides;
  if (!asks_nothing || !facts.clauses.is_whole || clause.what.size() != 1 ||
      clause.what[0].of.size() != 1)
    return std::nullopt;
  const ObjectId thing = *clause.what[0].of.begin();
  if (!facts.task.is_object(thing) || is_measured(facts.model, facts.task, thing))
    return std::nullopt;
  return "success asks nothing of " + facts.name(thing);
}

Lack raised_lack(const ClauseFacts& facts, const Clause& clause) {
  if (clause.what.size() != 1 || clause.goes || &clause != &facts.clauses.all.back() ||
      !facts.clauses.is_whole)
    return std::nullopt;
  const auto moved = handled(clause, clause.what[0]);
  if (moved.size() != 1 || !facts.goal.raised.contains(moved[0])) return std::nullopt;
  const std::string words = fold_case(clause.words);
  const bool is_put_down = clause.does == Does::kPuts && facts.goal.forgets &&
                           (has_words(words, "down") || !clause.ground.empty());
  constexpr auto kLow = std::to_array<std::string_view>(
      {"touch", "push", "slide", "turn", "rotate", "press", "squeeze"});
  const bool is_low = facts.clauses.all.size() == 1 && facts.is_alone && clause.from.empty() &&
                      !has_words(words, "up") && !has_words(words, "out") &&
                      std::any_of(kLow.begin(), kLow.end(), [&](const auto verb) {
                        return words.starts_with(std::string(verb) + " ");
                      });
  if (!is_put_down && !is_low) return std::nullopt;
  return "success wants " + facts.name(moved[0]) + " to be higher than it began";
}

Lack place_left_out(const ClauseFacts& facts) {
  if (!facts.is_alone || !facts.clauses.is_whole || facts.clauses.all.empty()) return std::nullopt;
  const bool takes_alone =
      std::all_of(facts.clauses.all.begin(), facts.clauses.all.end(), [](const Clause& clause) {
        return (clause.does == Does::kTakes || clause.does == Does::kOther) && clause.certain &&
               !clause.denied && clause.where.empty() && clause.ground.empty() &&
               clause.what.size() == 1 && clause.what[0].of.size() == 1;
      });
  if (!takes_alone) return std::nullopt;
  const Clause& last = facts.clauses.all.back();
  const ObjectId thing = *last.what[0].of.begin();
  const auto low = facts.lies_upon(thing);
  if (!low || facts.clauses.said.contains(*low)) return std::nullopt;
  return "says \"" + last.words + "\" and no place, and success " + facts.asks(thing, *low);
}

}  // namespace probe::sema
