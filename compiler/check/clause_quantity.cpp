// How many things a clause speaks of, and whether of each or of any: held to how many success asks
// the same of.
#include <algorithm>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "compiler/check/clause_lacks.h"

namespace probe::sema {
namespace {

// How success asks the same of several of these: by what is asked, of whom.
using Alike = std::map<std::pair<PredicateId, std::vector<Things>>, Things>;

Alike asked_alike(const ClauseFacts& facts, const Things& things) {
  Alike alike;
  for (const Goal::Asked& asked : facts.goal.asked) {
    if (asked.of.empty() || asked.of[0].size() != 1) continue;
    const ObjectId thing = *asked.of[0].begin();
    if (things.contains(thing))
      alike[{asked.predicate, {asked.of.begin() + 1, asked.of.end()}}].insert(thing);
  }
  return alike;
}

std::string names(const ClauseFacts& facts, const Things& things) {
  std::string text;
  for (const ObjectId id : things) text += (text.empty() ? "" : " and ") + facts.name(id);
  return text;
}

// Whether success asks or measures something of it, in whatever part.
bool has_part_in_it(const ClauseFacts& facts, ObjectId id) {
  const bool is_asked =
      std::any_of(facts.goal.asked.begin(), facts.goal.asked.end(), [&](const auto& one) {
        return std::any_of(one.of.begin(), one.of.end(),
                           [&](const Things& of) { return of.contains(id); });
      });
  return is_asked || facts.goal.ways.contains(id) || facts.goal.asks_of_all;
}

bool is_each_asked_first(const ClauseFacts& facts, const Things& things) {
  return std::all_of(things.begin(), things.end(), [&](ObjectId thing) {
    return std::any_of(facts.goal.asked.begin(), facts.goal.asked.end(),
                       [&](const Goal::Asked& asked) {
                         return !asked.of.empty() && asked.of[0] == Things{thing};
                       });
  });
}

Lack either_lack(const ClauseFacts& facts, const Clause& clause) {
  const auto says = [&](ObjectId id) {
    return std::any_of(clause.what.begin(), clause.what.end(), [&](const Clause::What& what) {
      return !what.is_some && !what.is_back && what.of == Things{id};
    });
  };
  const auto says_each = [&](const Things& things) {
    return things.size() > 1 && std::all_of(things.begin(), things.end(), says) &&
           !is_each_asked_first(facts, things);
  };
  for (const Things& two : facts.goal.either) {
    if (says_each(two)) return content_with_either(two);
  }
  // "The cubes", "all three drawers".
  const auto says_them = [&](const Things& things) {
    return std::any_of(clause.what.begin(), clause.what.end(), [&](const Clause::What& what) {
      return !what.is_some && !what.is_back && (what.is_several || what.is_each) &&
             std::includes(what.of.begin(), what.of.end(), things.begin(), things.end());
    });
  };
  for (const Things& some : facts.goal.one_of) {
    if (says_each(some) || (says_them(some) && !is_each_asked_first(facts, some)))
      return content_with_any(some);
  }
  return std::nullopt;
}

Lack of_several(const ClauseFacts& facts, const Clause::What& what, const Things& of) {
  // The predicate that is asked of most of them.
  const Alike alike = asked_alike(facts, of);
  auto most = alike.begin();
  for (auto one = alike.begin(); one != alike.end(); ++one) {
    if (one->second.size() >= most->second.size()) most = one;
  }
  if (most == alike.end()) return std::nullopt;
  const Things& asked = most->second;
  const std::string so =
      "success asks `" + facts.model.predicates[most->first.first].name + "` of ";
  if (what.is_some) {
    const bool is_counted = what.count > 0;
    if (asked.size() == of.size())
      return is_counted && what.count >= of.size()
                 ? std::nullopt
                 : Lack(so + (of.size() == 2 ? "both" : "all " + std::to_string(of.size())));
    if (is_counted ? asked.size() == what.count : asked.size() == 1)
      return so + names(facts, asked) + " alone, of " + std::to_string(of.size());
    return std::nullopt;
  }
  Things missing;
  std::set_difference(of.begin(), of.end(), asked.begin(), asked.end(),
                      std::inserter(missing, missing.end()));
  std::erase_if(missing, [&](ObjectId id) { return has_part_in_it(facts, id); });
  if (missing.empty()) return std::nullopt;
  const bool is_all = what.is_each && what.count == 0;
  const bool is_one =
      !what.is_each && what.count == 0 && asked.size() == 1 && missing.size() + 1 == of.size();
  const bool is_open = what.count > 0 && what.count < of.size() && asked.size() == what.count &&
                       missing.size() + asked.size() == of.size();
  if (is_open) return so + names(facts, asked) + ", of " + std::to_string(of.size());
  if (is_all || is_one)
    return so + names(facts, asked) + " and not of " + facts.name(*missing.begin());
  return std::nullopt;
}

// Whether success is about no other thing that a clause may have in mind: a "coke" is a can, too.
bool are_all(const ClauseFacts& facts, const Clause& clause, const Things& things) {
  return !facts.goal.speaks_of_all && !facts.goal.asks_of_all &&
         std::none_of(facts.goal.spoken.begin(), facts.goal.spoken.end(), [&](ObjectId id) {
           return facts.task.is_object(id) && !things.contains(id) && !clause.where.contains(id);
         });
}

}  // namespace

Lack count_lack(const ClauseFacts& facts, const Clause& clause) {
  for (const Clause::What& what : clause.what) {
    if (what.count == 0) continue;
    if (what.is_several && !what.is_back && !what.is_some && what.of.size() < what.count &&
        are_all(facts, clause, what.of))
      return std::to_string(what.of.size()) +
             (what.of.size() == 1 ? " thing is called so" : " things are called so");
    // The last one declared speaks of the others.
    const Alike alike = asked_alike(facts, what.of);
    const auto more = std::find_if(alike.rbegin(), alike.rend(), [&](const auto& one) {
      return !one.first.second.empty() && one.second.size() > what.count;
    });
    if (more != alike.rend())
      return "success asks `" + facts.model.predicates[more->first.first].name + "` of " +
             std::to_string(more->second.size());
  }
  return std::nullopt;
}

Lack quantity_lack(const ClauseFacts& facts, const Clause& clause) {
  if (auto why = either_lack(facts, clause)) return why;
  const bool is_of_joints = clause.does == Does::kOpens || clause.does == Does::kCloses;
  for (const Clause::What& what : clause.what) {
    if (what.is_back || !(what.is_some || what.is_each || what.is_several)) continue;
    Things of;
    for (const ObjectId id : what.of) {
      const bool is_one = is_of_joints ? facts.of(id) && facts.of(id)->is_part()
                                       : facts.task.is_object(id) && !clause.where.contains(id);
      if (is_one) of.insert(id);
    }
    if (of.size() < 2) continue;
    if (auto why = of_several(facts, what, of)) return why;
  }
  return std::nullopt;
}

}  // namespace probe::sema
