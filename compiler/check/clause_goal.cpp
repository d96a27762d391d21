#include "compiler/check/clause_goal.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "compiler/check/relation_words.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {
namespace {

using Does = Clause::Does;

class ClauseGoal {
 public:
  ClauseGoal(const Model& model, const Task& task, const Clauses& clauses, const Goal& goal)
      : model_(model), task_(task), clauses_(clauses), goal_(goal) {}

  std::optional<std::string> lack() const {
    for (const Clause& clause : clauses_.all) {
      if (!clause.certain) continue;
      std::optional<std::string> why;
      if (clause.denied) {
        if (why = denied_lack(clause); why) return "says \"not " + clause.words + "\" and " + *why;
        continue;
      }
      if (clause.does == Does::kPuts && clause.goes) why = put_lack(clause);
      if (!why && (clause.does == Does::kPuts || clause.does == Does::kTakes)) {
        why = count_lack(clause);
        if (!why) why = quantity_lack(clause);
        if (!why) why = from_lack(clause);
        if (!why) why = ground_lack(clause);
        if (!why) why = taken_lack(clause);
      }
      if (!why && (clause.does == Does::kOpens || clause.does == Does::kCloses)) {
        why = quantity_lack(clause);
        for (const Clause::What& what : clause.what) {
          if (!why) why = joint_lack(clause, what);
        }
      }
      if (!why && !clause.repeats.empty() && goal_.forgets)
        why = "success is the same after once as after " + clause.repeats;
      if (why) return "says \"" + clause.words + "\" and " + *why;
    }
    for (const Rank& rank : clauses_.ranks) {
      if (const auto why = rank_lack(rank)) return "says \"" + rank.words + "\" and " + *why;
    }
    return place_left_out();
  }

  std::vector<NotHeld> not_held() const {
    std::vector<NotHeld> found;
    for (const Clause& clause : clauses_.all) {
      std::string why = unheld(clause);
      if (why.empty() && !clause.repeats.empty() && !goal_.forgets)
        why = "whether success counts how often is not known";
      if (!why.empty()) found.push_back({clause.words, std::move(why)});
    }
    for (const Rank& rank : clauses_.ranks) {
      const bool is_ordered =
          std::any_of(goal_.order.begin(), goal_.order.end(), [&](const auto& order) {
            return shares(order.first, rank.of) || shares(order.second, rank.of);
          });
      if (!is_ordered) found.push_back({rank.words, "success wants no order of it"});
    }
    for (const Clauses::Left& left : clauses_.left) {
      if (!left.is_spared || left.of.empty()) {
        found.push_back({left.words, "not understood"});
        continue;
      }
      for (const ObjectId id : left.of) {
        if (is_measured(model_, task_, id)) continue;
        found.push_back({left.words, "no metric measures anything of " + name(id)});
        break;
      }
    }
    return found;
  }

 private:
  static bool shares(const Things& a, const Things& b) {
    return std::any_of(a.begin(), a.end(), [&](ObjectId id) { return b.contains(id); });
  }
  bool shares_spoken(const Things& things) const { return shares(things, goal_.spoken); }

  // Why a clause is held to nothing; empty where it is held.
  std::string unheld(const Clause& clause) const {
    if (!clause.certain)
      return clause.stopped.empty() ? "not understood" : "`" + clause.stopped + "` is not understood";
    Things things;
    for (const Clause::What& what : clause.what) things.insert(what.of.begin(), what.of.end());
    const bool moves_joint = clause.does == Does::kOpens || clause.does == Does::kCloses;
    if (moves_joint) {
      const Things parts = parts_of(clause);
      if (parts.empty()) return "no part that a joint moves is called so";
      const bool is_way = &clause != &clauses_.all.back();
      const bool has_way = std::any_of(parts.begin(), parts.end(),
                                       [&](ObjectId id) { return goal_.ways.contains(id); });
      if (has_way || is_way || goal_.moves_unnamed) return {};
      return "success measures nothing of how far " + name(*parts.begin()) + " has moved";
    }
    if (clause.does == Does::kOther)
      return clause.goes && is_placed(clause, things) ? "" : "what it asks for is not known";
    if (clause.does == Does::kTakes) {
      // The way to where it goes.
      const bool is_way = std::any_of(&clause + 1, clauses_.all.data() + clauses_.all.size(),
                                      [](const Clause& later) { return later.does == Does::kPuts; });
      if (is_way || shares_spoken(things) || goal_.asks_of_all || things.empty()) return {};
      return "success measures nothing of " + name(*things.begin());
    }
    if (!clause.goes) {
      if (!clause.ground.empty())
        return "how success measures the " + clause.ground + " is not known";
      return is_placed(clause, things) ? "" : "it is not said where to";
    }
    if (is_placed(clause, things)) return {};
    if (goal_.asks_of_all) return "success asks something of things that it does not name";
    if (things.empty() || clause.where.empty()) return "it is not known what goes where";
    return "success measures " + name(*things.begin()) + " against no such place";
  }
  // Whether what a clause moves is measured against where it goes, or one of what it moves against
  // another.
  bool is_placed(const Clause& clause, const Things& things) const {
    Things places = clause.where;
    if (!clause.goes) places = things;
    return std::any_of(things.begin(), things.end(), [&](ObjectId thing) {
      return std::any_of(places.begin(), places.end(),
                         [&](ObjectId place) { return thing != place && bearing(thing, place); });
    });
  }

  std::string name(ObjectId id) const { return "`" + model_.objects[id].name + "`"; }
  const std::optional<OfFixture>& of(ObjectId id) const { return model_.objects[id].of; }
  bool is_spoken(ObjectId id) const { return goal_.spoken.contains(id); }

  // Whether a region or a part stands for the other, or for the fixture that both are of. Two parts
  // with regions of their own are two places.
  bool is_same_place(ObjectId a, ObjectId b) const {
    if (a == b) return true;
    if (!of(a) || !of(b) || of(a)->fixture != of(b)->fixture) return false;
    return of(a)->part == of(b)->part || !has_own_region(a) || !has_own_region(b);
  }
  bool has_own_region(ObjectId id) const {
    const Fixture& fixture = model_.fixtures[of(id)->fixture];
    const Fixture::Part& part = fixture.parts[of(id)->part];
    return part.declared && part.joint &&
           std::any_of(fixture.regions.begin(), fixture.regions.end(),
                       [&](const Fixture::OwnRegion& own) { return own.part == of(id)->part; });
  }

  // How success measures a thing against a place, of all its comparisons of the two.
  std::optional<Goal::Bearing> bearing(ObjectId thing, ObjectId place) const {
    std::optional<Goal::Bearing> found;
    for (const auto& [two, one] : goal_.bearings) {
      if (two.first != thing && two.second != thing) continue;
      const ObjectId other = two.first == thing ? two.second : two.first;
      if (!is_same_place(other, place)) continue;
      if (!found) found.emplace();
      found->near = found->near || one.near;
      found->apart = found->apart || one.apart;
      found->other = found->other || one.other;
      found->asked = found->asked || one.asked;
    }
    return found;
  }

  // Where success wants a thing to be: near to another, or somewhere in a region, by whatever
  // coordinates.
  Things wanted_at(ObjectId thing) const {
    Things found;
    for (const auto& [two, one] : goal_.bearings) {
      if (!one.asked || (two.first != thing && two.second != thing)) continue;
      const ObjectId other = two.first == thing ? two.second : two.first;
      if (one.near || (one.other && of(other) && of(other)->region)) found.insert(other);
    }
    return found;
  }

  // Other objects that success measures it against.
  Things measured_against(ObjectId thing) const {
    Things found = wanted_at(thing);
    for (const auto& [two, one] : goal_.bearings) {
      if (!one.asked || (two.first != thing && two.second != thing)) continue;
      const ObjectId other = two.first == thing ? two.second : two.first;
      if (task_.is_object(other)) found.insert(other);
    }
    return found;
  }

  // "asks `on_top_of` of `cube` and `plate`", by the predicate that is of the fewest things.
  std::string asks(ObjectId thing, ObjectId place) const {
    const Goal::Asked* least = nullptr;
    for (const Goal::Asked& asked : goal_.asked) {
      const auto has = [&](ObjectId id) {
        return std::any_of(asked.of.begin(), asked.of.end(),
                           [&](const Things& things) { return things.contains(id); });
      };
      // Of as many the last one declared, which speaks of the others.
      if (has(thing) && has(place) && (least == nullptr || asked.of.size() <= least->of.size()))
        least = &asked;
    }
    const std::string both = " of " + name(thing) + " and " + name(place);
    if (least == nullptr) return "measures " + name(thing) + " against " + name(place);
    return "asks `" + model_.predicates[least->predicate].name + "`" + both;
  }

  std::optional<std::string> put_lack(const Clause& clause) const {
    if (goal_.asks_of_all) return std::nullopt;
    if (auto why = between_lack(clause)) return why;
    for (const Clause::What& what : clause.what) {
      std::vector<ObjectId> moved;
      for (const ObjectId id : what.of) {
        if (task_.is_object(id) && !clause.where.contains(id)) moved.push_back(id);
      }
      if (auto why = moved_lack(moved, clause)) return why;
    }
    return std::nullopt;
  }

  std::optional<std::string> moved_lack(const std::vector<ObjectId>& moved,
                                        const Clause& clause) const {
    Goal::Bearing all;
    bool is_measured = false;
    for (const ObjectId thing : moved) {
      for (const ObjectId place : clause.where) {
        const auto one = bearing(thing, place);
        if (!one) continue;
        is_measured = true;
        all.near = all.near || one->near;
        all.apart = all.apart || one->apart;
        all.other = all.other || one->other;
        all.asked = all.asked || one->asked;
      }
    }
    if (is_measured) {
      if (auto why = height_lack(moved, clause)) return why;
      if (auto why = beside_lack(moved, clause, all)) return why;
      if (auto why = anywhere_lack(moved, clause)) return why;
      // Not there is all that it wants.
      if (all.near || !all.apart || (all.other && all.asked) || moved.size() != 1 ||
          clause.where.empty())
        return std::nullopt;
      return "success wants " + name(moved.front()) + " not to be there";
    }
    const bool speaks =
        std::any_of(moved.begin(), moved.end(), [&](ObjectId thing) { return is_spoken(thing); });
    if (!speaks) return unspoken(moved, clause);
    if (moved.size() != 1) return std::nullopt;
    const ObjectId thing = moved.front();
    const bool is_beside = clause.lies == Clause::Where::kBeside;
    for (const ObjectId place : is_beside ? measured_against(thing) : wanted_at(thing)) {
      const bool may_be_there = std::any_of(
          clause.where.begin(), clause.where.end(),
          [&](ObjectId said) { return is_same_place(said, place) || lies_on(said, place); });
      if (!may_be_there) return "success " + asks(thing, place);
    }
    return std::nullopt;
  }

  bool is_measured_beside(const Things& things) const {
    const auto& beside = goal_.measured_beside;
    return std::any_of(beside.begin(), beside.end(), [&](const auto& two) {
      return things.contains(two.first) || things.contains(two.second);
    });
  }

  // What of a clause is handled: not the place it goes to.
  static std::vector<ObjectId> handled(const Clause& clause, const Clause::What& what) {
    std::vector<ObjectId> found;
    for (const ObjectId id : what.of) {
      if (!clause.where.contains(id)) found.push_back(id);
    }
    return found;
  }

  // "next to the plate" of which success wants it to be on the plate; "on the plate" of which it is
  // to be apart from it.
  std::optional<std::string> beside_lack(const std::vector<ObjectId>& moved, const Clause& clause,
                                         const Goal::Bearing& all) const {
    if (moved.size() != 1 || clause.where.size() != 1 || !all.near || !all.asked)
      return std::nullopt;
    const ObjectId thing = moved.front(), place = *clause.where.begin();
    if (clause.lies == Clause::Where::kBeside && !all.apart &&
        goal_.above.contains({thing, place}) && !goal_.above.contains({place, thing}))
      return "success wants " + name(thing) + " to be higher than " + name(place);
    if (clause.lies != Clause::Where::kOn) return std::nullopt;
    for (const Goal::Asked& asked : goal_.asked) {
      const Predicate& relation = model_.predicates[asked.predicate];
      if (!relation.is_relation || asked.of.size() < 2 || goal_.above.contains({thing, place}))
        continue;
      const bool is_of_both = (asked.of[0] == Things{thing} && asked.of[1] == Things{place}) ||
                              (asked.of[0] == Things{place} && asked.of[1] == Things{thing});
      if (is_of_both && !relation.words.empty() && !says(fold_case(clause.words), relation))
        return "success asks `" + relation.name + "`, which is said by \"" + relation.words.front() +
               "\"";
    }
    return std::nullopt;
  }

  // "into a drawer" of which success wants a certain one.
  std::optional<std::string> anywhere_lack(const std::vector<ObjectId>& moved,
                                           const Clause& clause) const {
    if (!clause.is_anywhere || moved.size() != 1) return std::nullopt;
    Things wanted, free;
    for (const ObjectId place : clause.where) {
      const auto one = bearing(moved[0], place);
      (one && one->asked ? wanted : free).insert(place);
    }
    // A part and its region are one place.
    for (const ObjectId place : wanted)
      std::erase_if(free, [&](ObjectId other) { return is_same_place(place, other); });
    if (wanted.empty() || free.empty()) return std::nullopt;
    const ObjectId other = *wanted.begin();
    const bool is_one = std::all_of(wanted.begin(), wanted.end(),
                                    [&](ObjectId id) { return is_same_place(id, other); });
    if (!is_one) return std::nullopt;
    return "success " + asks(moved[0], other) + " alone";
  }

  // "take the cube off the tray" of which success is that it is there, and no later clause puts it
  // back.
  std::optional<std::string> from_lack(const Clause& clause) const {
    if (clause.goes || clause.from.size() != 1 || clause.what.size() != 1) return std::nullopt;
    const auto moved = handled(clause, clause.what[0]);
    if (moved.size() != 1 || !task_.is_object(moved[0]) || is_moved_later(clause, moved[0]))
      return std::nullopt;
    const auto one = bearing(moved[0], *clause.from.begin());
    if (!one || !one->near || !one->asked || one->apart) return std::nullopt;
    // By another number than just "higher" it may be above it and off it.
    if (one->other && !goal_.above.contains({moved[0], *clause.from.begin()})) return std::nullopt;
    return "success wants " + name(moved[0]) + " to be there";
  }

  // Whether a later clause may do something with it.
  bool is_moved_later(const Clause& clause, ObjectId thing) const {
    if (!clauses_.is_whole) return true;
    const Clause* end = clauses_.all.data() + clauses_.all.size();
    return std::any_of(&clause + 1, end, [&](const Clause& later) {
      return !later.certain || later.what.empty() ||
             std::any_of(later.what.begin(), later.what.end(),
                         [&](const Clause::What& what) { return what.of.contains(thing); });
    });
  }

  // The one object that success wants above another and near it; none where it is not one.
  std::optional<ObjectId> lies_upon(ObjectId thing) const {
    std::optional<ObjectId> found;
    for (const auto& [high, low] : goal_.above) {
      if (high != thing || !task_.is_object(low)) continue;
      const auto one = bearing(thing, low);
      if (!one || !one->near || !one->asked || one->apart) continue;
      if (found) return std::nullopt;
      found = low;
    }
    return found;
  }

  // "put the cube on the table" of which success wants it to lie on the tray.
  std::optional<std::string> ground_lack(const Clause& clause) const {
    if (clause.ground.empty() || clause.does != Does::kPuts || !clause.where.empty() ||
        clause.what.size() != 1)
      return std::nullopt;
    const auto moved = handled(clause, clause.what[0]);
    if (moved.size() != 1 || is_moved_later(clause, moved[0])) return std::nullopt;
    const auto low = lies_upon(moved[0]);
    if (!low || clauses_.said.contains(*low)) return std::nullopt;
    return "success " + asks(moved[0], *low);
  }

  // "put the cube on the tray, then pick it up again" of which success is that it lies there at the
  // end.
  std::optional<std::string> taken_lack(const Clause& clause) const {
    // "Put it on the tray, lifting it carefully" takes it before.
    if (clause.does != Does::kTakes || clause.what.size() != 1 || !goal_.forgets ||
        !has_words(fold_case(clause.words), "again"))
      return std::nullopt;
    for (const Clause* put = clauses_.all.data(); put != &clause; ++put) {
      if (!put->certain || put->does != Does::kPuts || !put->goes || put->where.size() != 1 ||
          put->what.size() != 1)
        continue;
      const auto moved = handled(*put, put->what[0]);
      const auto taken = handled(*put, clause.what[0]);
      if (moved.size() != 1 || taken != moved || is_moved_later(clause, moved[0])) continue;
      const auto one = bearing(moved[0], *put->where.begin());
      if (one && one->near && one->asked && !one->apart && lies_upon(moved[0]))
        return "success wants " + name(moved[0]) + " to lie there at the end";
    }
    return std::nullopt;
  }

  // "the cube last" of which success wants the cube first.
  std::optional<std::string> rank_lack(const Rank& rank) const {
    if (rank.of.size() != 1) return std::nullopt;
    const ObjectId thing = *rank.of.begin();
    for (const auto& [first, second] : goal_.order) {
      const Things& wrong = rank.is_last ? first : second;
      const Things& right = rank.is_last ? second : first;
      if (!wrong.contains(thing) || right.contains(thing) || right.empty()) continue;
      return "succeeds when " + name(*first.begin()) + " comes before " + name(*second.begin());
    }
    return std::nullopt;
  }

  // "pick up the cube" and no more, of which success wants it to lie on the tray.
  std::optional<std::string> place_left_out() const {
    if (!clauses_.is_whole || clauses_.all.empty()) return std::nullopt;
    const bool takes_alone =
        std::all_of(clauses_.all.begin(), clauses_.all.end(), [](const Clause& clause) {
          return clause.does == Does::kTakes && clause.certain && !clause.denied &&
                 clause.where.empty() && clause.ground.empty() && clause.what.size() == 1 &&
                 clause.what[0].of.size() == 1;
        });
    if (!takes_alone) return std::nullopt;
    const Clause& last = clauses_.all.back();
    const ObjectId thing = *last.what[0].of.begin();
    const auto low = lies_upon(thing);
    if (!low || clauses_.said.contains(*low)) return std::nullopt;
    return "says \"" + last.words + "\" and no place, and success " + asks(thing, *low);
  }

  // How success asks the same of several of these: by what is asked, of whom.
  using Alike = std::map<std::pair<PredicateId, std::vector<Things>>, Things>;
  Alike asked_alike(const Things& things) const {
    Alike alike;
    for (const Goal::Asked& asked : goal_.asked) {
      if (asked.of.empty() || asked.of[0].size() != 1) continue;
      const ObjectId thing = *asked.of[0].begin();
      if (things.contains(thing))
        alike[{asked.predicate, {asked.of.begin() + 1, asked.of.end()}}].insert(thing);
    }
    return alike;
  }
  std::string names(const Things& things) const {
    std::string text;
    for (const ObjectId id : things) text += (text.empty() ? "" : " and ") + name(id);
    return text;
  }

  // "open all drawers" of which success is that one is open; "one of the drawers" where it asks for
  // all of them, or for a certain one; "the cube and the can" where either will do.
  std::optional<std::string> quantity_lack(const Clause& clause) const {
    if (auto why = either_lack(clause)) return why;
    const bool is_of_joints = clause.does == Does::kOpens || clause.does == Does::kCloses;
    for (const Clause::What& what : clause.what) {
      if (what.is_back || !(what.is_some || what.is_each || what.is_several)) continue;
      Things of;
      for (const ObjectId id : what.of) {
        const bool is_one = is_of_joints ? this->of(id) && this->of(id)->is_part()
                                         : task_.is_object(id) && !clause.where.contains(id);
        if (is_one) of.insert(id);
      }
      if (of.size() < 2) continue;
      if (auto why = of_several(what, of)) return why;
    }
    return std::nullopt;
  }

  std::optional<std::string> of_several(const Clause::What& what, const Things& of) const {
    // The predicate that is asked of most of them.
    const Alike alike = asked_alike(of);
    auto most = alike.begin();
    for (auto one = alike.begin(); one != alike.end(); ++one) {
      if (one->second.size() >= most->second.size()) most = one;
    }
    if (most == alike.end()) return std::nullopt;
    const Things& asked = most->second;
    const std::string so =
        "success asks `" + model_.predicates[most->first.first].name + "` of ";
    if (what.is_some) {
      const bool is_counted = what.count > 0;
      if (asked.size() == of.size())
        return is_counted && what.count >= of.size()
                   ? std::nullopt
                   : std::optional(so + (of.size() == 2 ? "both" : "all " + count(of.size())));
      if (is_counted ? asked.size() == what.count : asked.size() == 1)
        return so + names(asked) + " alone, of " + count(of.size());
      return std::nullopt;
    }
    Things missing;
    std::set_difference(of.begin(), of.end(), asked.begin(), asked.end(),
                        std::inserter(missing, missing.end()));
    std::erase_if(missing, [&](ObjectId id) { return has_part_in_it(id); });
    if (missing.empty()) return std::nullopt;
    const bool is_all = what.is_each && what.count == 0;
    const bool is_one = !what.is_each && what.count == 0 && asked.size() == 1 &&
                        missing.size() + 1 == of.size();
    const bool is_open = what.count > 0 && what.count < of.size() && asked.size() == what.count &&
                         missing.size() + asked.size() == of.size();
    if (is_open) return so + names(asked) + ", of " + count(of.size());
    if (is_all || is_one) return so + names(asked) + " and not of " + name(*missing.begin());
    return std::nullopt;
  }
  static std::string count(std::size_t number) { return std::to_string(number); }

  // Whether success asks or measures something of it, in whatever part.
  bool has_part_in_it(ObjectId id) const {
    const bool is_asked = std::any_of(goal_.asked.begin(), goal_.asked.end(), [&](const auto& one) {
      return std::any_of(one.of.begin(), one.of.end(),
                         [&](const Things& of) { return of.contains(id); });
    });
    return is_asked || goal_.ways.contains(id) || goal_.asks_of_all;
  }

  std::optional<std::string> either_lack(const Clause& clause) const {
    const auto says = [&](ObjectId id) {
      return std::any_of(clause.what.begin(), clause.what.end(), [&](const Clause::What& what) {
        return !what.is_some && !what.is_back && what.of == Things{id};
      });
    };
    const auto says_each = [&](const Things& things) {
      return things.size() > 1 && std::all_of(things.begin(), things.end(), says) &&
             !is_each_asked(things);
    };
    for (const Things& two : goal_.either) {
      if (says_each(two)) return "succeeds with one of the two (`or`, not `and`)";
    }
    for (const Things& some : goal_.one_of) {
      if (says_each(some))
        return "succeeds with one of " + count(some.size()) + " (`any`, not `all`)";
    }
    return std::nullopt;
  }
  bool is_each_asked(const Things& things) const {
    return std::all_of(things.begin(), things.end(), [&](ObjectId thing) {
      return std::any_of(goal_.asked.begin(), goal_.asked.end(), [&](const Goal::Asked& asked) {
        return !asked.of.empty() && asked.of[0] == Things{thing};
      });
    });
  }

  // "do not put the cube on the tray" of which success is that it is there.
  std::optional<std::string> denied_lack(const Clause& clause) const {
    if (clause.what.size() != 1 || clause.what[0].of.size() != 1) return std::nullopt;
    const ObjectId thing = *clause.what[0].of.begin();
    if (clause.does == Does::kPuts && clause.goes && clause.where.size() == 1) {
      const auto one = bearing(thing, *clause.where.begin());
      if (one && one->near && one->asked && !one->apart)
        return "success wants " + name(thing) + " to be there";
    }
    if (clause.does != Does::kOpens && clause.does != Does::kCloses) return std::nullopt;
    const auto way = goal_.ways.find(thing);
    if (way == goal_.ways.end() || way->second.other) return std::nullopt;
    const bool closes = clause.does == Does::kCloses;
    if (!(closes ? way->second.closes && !way->second.opens
                 : way->second.opens && !way->second.closes))
      return std::nullopt;
    return "success is that " + name(thing) + " has moved at " + (closes ? "most" : "least") +
           " so far";
  }

  // "put the plate on the carrot" of which success wants the carrot to be higher.
  std::optional<std::string> height_lack(const std::vector<ObjectId>& moved,
                                         const Clause& clause) const {
    const bool is_on = clause.lies == Clause::Where::kOn;
    if (moved.size() != 1 || clause.where.size() != 1 ||
        (!is_on && clause.lies != Clause::Where::kUnder))
      return std::nullopt;
    const ObjectId thing = moved.front(), place = *clause.where.begin();
    const ObjectId high = is_on ? thing : place, low = is_on ? place : thing;
    if (!goal_.above.contains({low, high}) || goal_.above.contains({high, low}))
      return std::nullopt;
    return "success wants " + name(low) + " to be higher than " + name(high);
  }

  // "put the cube between the can and the tray" of which success is that the can is between.
  std::optional<std::string> between_lack(const Clause& clause) const {
    if (clause.lies != Clause::Where::kBeside || clause.what.size() != 1 ||
        clause.what[0].of.size() != 1 || clause.where.size() < 2)
      return std::nullopt;
    const Things& said = clause.what[0].of;
    const Goal::Asked* turned = nullptr;
    for (const Goal::Asked& asked : goal_.asked) {
      const Predicate& relation = model_.predicates[asked.predicate];
      if (!relation.is_relation || asked.of.size() != 3) continue;
      if (asked.of[0] == said) return std::nullopt;
      const bool is_in_it = asked.of[1] == said || asked.of[2] == said;
      if (is_in_it && asked.of[0].size() == 1 && clause.where.contains(*asked.of[0].begin()))
        turned = &asked;
    }
    if (turned == nullptr) return std::nullopt;
    return "success asks `" + model_.predicates[turned->predicate].name + "` of " +
           name(*turned->of[0].begin());
  }

  // Success is about other things.
  std::optional<std::string> unspoken(const std::vector<ObjectId>& moved,
                                      const Clause& clause) const {
    if (goal_.spoken.empty() && goal_.ways.empty()) return std::nullopt;
    // Another metric may judge it; and what is not understood may say why it is not judged.
    if (is_measured_beside({moved.begin(), moved.end()}) || !clauses_.is_whole)
      return std::nullopt;
    if (moved.size() == 1) return "success asks nothing of " + name(moved.front());
    const auto& spoken = goal_.spoken;
    const bool moves_none = std::none_of(spoken.begin(), spoken.end(),
                                         [&](ObjectId id) { return task_.is_object(id); });
    const bool is_there = std::any_of(clause.where.begin(), clause.where.end(), [&](ObjectId said) {
      return is_spoken(said) || std::any_of(spoken.begin(), spoken.end(),
                                            [&](ObjectId id) { return is_same_place(id, said); });
    });
    if (!moves_none || is_there || clause.where.empty()) return std::nullopt;
    return "success asks nothing of " + name(*clause.where.begin());
  }

  // Whether one begins on or in the other, seen from above: then it may be said for it.
  bool lies_on(ObjectId a, ObjectId b) const {
    if (task_.starts.empty()) return true;
    if (!task_.is_object(a) && !task_.is_object(b)) return false;
    if (!task_.is_object(a) || !task_.is_object(b)) {
      // What is put into a fixture has a height of its own; in a table of starts all may have.
      if (!model_.layouts[task_.layout].given.empty()) return false;
      const ObjectId object = task_.is_object(a) ? a : b;
      const auto at = placed(object);
      return at == nullptr || at->z.has_value();
    }
    const auto one = placed(a), other = placed(b);
    if (one == nullptr || other == nullptr) return true;
    const auto half = [&](ObjectId id) {
      const Object& object = model_.objects[id];
      return std::hypot(object.box_max[0] - object.box_min[0],
                        object.box_max[1] - object.box_min[1]) /
             2;
    };
    return std::hypot(one->x - other->x, one->y - other->y) < std::max(half(a), half(b));
  }
  const Start::Placed* placed(ObjectId id) const {
    const auto& all = task_.starts.front().placed;
    const auto at = std::find_if(all.begin(), all.end(),
                                 [&](const Start::Placed& one) { return one.object == id; });
    return at == all.end() ? nullptr : &*at;
  }

  // "both cubes" of which success asks the same of three.
  std::optional<std::string> count_lack(const Clause& clause) const {
    for (const Clause::What& what : clause.what) {
      if (what.count == 0) continue;
      for (const auto& [same, things] : asked_alike(what.of)) {
        if (!same.second.empty() && things.size() > what.count)
          return "success asks `" + model_.predicates[same.first].name + "` of " +
                 std::to_string(things.size());
      }
    }
    return std::nullopt;
  }

  // The parts of a clause that opens or closes.
  Things parts_of(const Clause::What& what) const {
    Things parts;
    for (const ObjectId id : what.of) {
      if (of(id) && of(id)->is_part()) parts.insert(id);
    }
    return parts;
  }
  Things parts_of(const Clause& clause) const {
    Things parts;
    for (const Clause::What& what : clause.what) parts.merge(parts_of(what));
    return parts;
  }

  // "open the drawer and close it" of which success asks that it is open, or nothing of it.
  std::optional<std::string> joint_lack(const Clause& clause, const Clause::What& what) const {
    const Things parts = parts_of(what);
    if (parts.empty() || goal_.moves_unnamed) return std::nullopt;
    // What is done last is what is left.
    for (const Clause* later = &clause + 1; later != clauses_.all.data() + clauses_.all.size();
         ++later) {
      const bool moves = later->does == Does::kOpens || later->does == Does::kCloses ||
                         later->does == Does::kOther || !later->certain;
      const Things others = parts_of(*later);
      if (moves && (later->what.empty() || others.empty() ||
                    std::any_of(others.begin(), others.end(),
                                [&](ObjectId id) { return parts.contains(id); })))
        return std::nullopt;
    }
    const bool closes = clause.does == Does::kCloses;
    Goal::Way all;
    bool is_measured = false, is_any_free = false;  // of several it may be any that is meant
    for (const ObjectId part : parts) {
      if (is_spoken(part) && !goal_.ways.contains(part)) return std::nullopt;
      const auto way = goal_.ways.find(part);
      is_any_free = is_any_free || way == goal_.ways.end();
      if (way == goal_.ways.end()) continue;
      is_measured = true;
      all.opens = all.opens || way->second.opens;
      all.closes = all.closes || way->second.closes;
      all.other = all.other || way->second.other;
    }
    if (is_measured) {
      if (is_any_free || all.other || (closes ? all.closes : all.opens)) return std::nullopt;
      return "success is that " + name(*parts.begin()) + " has moved at " +
             (closes ? "least" : "most") + " so far";
    }
    const bool is_about = std::any_of(parts.begin(), parts.end(), [&](ObjectId part) {
      return std::any_of(goal_.bearings.begin(), goal_.bearings.end(), [&](const auto& one) {
        const auto is_of = [&](ObjectId id) {
          return of(id) && of(id)->fixture == of(part)->fixture;
        };
        return is_of(one.first.first) || is_of(one.first.second);
      });
    });
    // What lies in a drawer got there through its being open; what is not done last may be the way
    // to what is.
    const bool is_last = &clause == &clauses_.all.back();
    if ((!closes && is_about) || !is_last || !clauses_.is_whole) return std::nullopt;
    if (goal_.spoken.empty() && goal_.ways.empty() && goal_.bearings.empty()) return std::nullopt;
    return "success asks nothing of how far " + name(*parts.begin()) + " has moved";
  }

  const Model& model_;
  const Task& task_;
  const Clauses& clauses_;
  const Goal& goal_;
};

}  // namespace

std::optional<std::string> clause_lack(const Model& model, const Task& task, const Clauses& clauses,
                                       const Goal& goal) {
  return ClauseGoal(model, task, clauses, goal).lack();
}

std::vector<NotHeld> words_not_held(const Model& model, const Task& task, const Clauses& clauses,
                                    const Goal& goal) {
  return ClauseGoal(model, task, clauses, goal).not_held();
}

}  // namespace probe::sema
