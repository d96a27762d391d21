// Words of clauses that are held to nothing, and why.
#include <algorithm>

#include "compiler/check/clause_facts.h"
#include "compiler/check/clause_goal.h"
#include "runtime/base/utf8.h"

namespace probe::sema {
namespace {

// Whether what a clause moves is measured against where it goes, or one of what it moves against
// another.
bool is_placed(const ClauseFacts& facts, const Clause& clause, const Things& things) {
  Things places = clause.where;
  if (!clause.goes) places = things;
  return std::any_of(things.begin(), things.end(), [&](ObjectId thing) {
    return std::any_of(places.begin(), places.end(), [&](ObjectId place) {
      return thing != place && facts.bearing(thing, place);
    });
  });
}

// Why a clause is held to nothing; empty where it is held.
std::string unheld(const ClauseFacts& facts, const Clause& clause) {
  if (!clause.certain)
    return clause.stopped.empty() ? "not understood" : "`" + clause.stopped + "` is not understood";
  Things things;
  for (const Clause::What& what : clause.what) things.insert(what.of.begin(), what.of.end());
  const bool moves_joint = clause.does == Does::kOpens || clause.does == Does::kCloses;
  if (moves_joint) {
    const Things parts = facts.parts_of(clause);
    if (parts.empty()) return "no part that a joint moves is called so";
    const bool is_way = &clause != &facts.clauses.all.back();
    const bool has_way = std::any_of(parts.begin(), parts.end(),
                                     [&](ObjectId id) { return facts.goal.ways.contains(id); });
    if (has_way || is_way || facts.goal.moves_unnamed) return {};
    return "success measures nothing of how far " + facts.name(*parts.begin()) + " has moved";
  }
  if (clause.does == Does::kOther)
    return clause.goes && is_placed(facts, clause, things) ? "" : "what it asks for is not known";
  if (clause.does == Does::kTakes) {
    // The way to where it goes.
    const bool is_way =
        std::any_of(&clause + 1, facts.clauses.all.data() + facts.clauses.all.size(),
                    [](const Clause& later) { return later.does == Does::kPuts; });
    if (is_way || shares(things, facts.goal.spoken) || facts.goal.asks_of_all || things.empty())
      return {};
    return "success measures nothing of " + facts.name(*things.begin());
  }
  if (!clause.goes) {
    if (!clause.ground.empty())
      return "how success measures the " + clause.ground + " is not known";
    return is_placed(facts, clause, things) ? "" : "it is not said where to";
  }
  if (is_placed(facts, clause, things)) return {};
  if (facts.goal.asks_of_all) return "success asks something of things that it does not name";
  if (things.empty() || clause.where.empty()) return "it is not known what goes where";
  return "success measures " + facts.name(*things.begin()) + " against no such place";
}

// "First put the carrot on the plate, then the cube": a name alone, of what success asks to lie where
// a clause put another. Of other success it may be the place, and is no clause.
bool goes_likewise(const ClauseFacts& facts, const Clauses::Left& left) {
  if (left.of.size() != 1) return false;
  const ObjectId thing = *left.of.begin();
  const std::string name = fold_case(facts.model.objects[thing].text.text);
  const std::string said = fold_case(left.words);
  if (said != name && said != "the " + name) return false;
  return std::ranges::any_of(facts.clauses.all, [&](const Clause& clause) {
    return clause.does == Does::kPuts && clause.certain && clause.goes && !clause.denied &&
           std::ranges::any_of(clause.where, [&](ObjectId place) {
             return place != thing && facts.bearing(thing, place);
           });
  });
}

}  // namespace

std::vector<NotHeld> words_not_held(const Model& model, const Task& task, const Clauses& clauses,
                                    const Goal& goal) {
  const ClauseFacts facts{model, task, clauses, goal};
  std::vector<NotHeld> found;
  for (const Clause& clause : facts.clauses.all) {
    std::string why = unheld(facts, clause);
    if (why.empty() && !clause.repeats.empty() && !facts.goal.forgets)
      why = "whether success counts how often is not known";
    if (!why.empty()) found.push_back({clause.words, std::move(why)});
  }
  for (const Rank& rank : facts.clauses.ranks) {
    const bool is_ordered =
        std::any_of(facts.goal.order.begin(), facts.goal.order.end(), [&](const auto& order) {
          return shares(order.first, rank.of) || shares(order.second, rank.of);
        });
    if (!is_ordered) found.push_back({rank.words, "success wants no order of it"});
  }
  for (const Clauses::Left& left : facts.clauses.left) {
    if (!left.is_spared && goes_likewise(facts, left)) continue;
    if (!left.is_spared || left.of.empty()) {
      found.push_back({left.words, "not understood"});
      continue;
    }
    for (const ObjectId id : left.of) {
      if (is_measured(facts.model, facts.task, id)) continue;
      found.push_back({left.words, "no metric measures anything of " + facts.name(id)});
      break;
    }
  }
  return found;
}

}  // namespace probe::sema
