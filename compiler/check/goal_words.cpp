// P1202 of instructions: words that ask for something are held to what success is.
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>

#include "compiler/check/called.h"
#include "compiler/check/check.h"
#include "compiler/check/clause_goal.h"
#include "compiler/check/clauses.h"
#include "compiler/check/goal.h"
#include "compiler/check/noun_words.h"
#include "compiler/check/relation_words.h"
#include "compiler/check/said.h"
#include "compiler/define/telling.h"
#include "compiler/define/wording.h"
#include "runtime/base/nouns.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {
namespace {

// The relations that a metric measures, through the predicates that it calls.
void collect_relations(const Model& model, ExprRef ref, std::set<ExprRef>& seen,
                       std::set<PredicateId>& out) {
  if (ref == kNoExpr || !seen.insert(ref).second) return;
  const ExprNode& node = model.exprs.nodes[ref];
  for (const ExprRef arg : node.args) collect_relations(model, arg, seen, out);
  if (node.op != ExprOp::kCall) return;
  if (model.predicates[node.predicate].is_relation) {
    out.insert(node.predicate);
  } else {
    collect_relations(model, model.predicates[node.predicate].body, seen, out);
  }
}

// What an instruction says beside its slots, which say themselves how many they mean.
std::string literal_text(const Template& say) {
  std::string text;
  for (const Template::Part& part : say.parts) {
    text += part.literal + " ";
    if (!part.slot || part.slot->avoid) continue;
    if (part.slot->count == syntax::SlotCount::kBoth) text += "both ";
    if (part.slot->count == syntax::SlotCount::kAll) text += "all ";
  }
  return text;
}

// The first words of a relation between things that are said where none that is judged is; empty
// where there are none.
std::string other_relation(const Model& model, const std::set<PredicateId>& judged,
                           std::string_view text) {
  for (const PredicateId id : judged) {
    if (says(text, model.predicates[id])) return {};
  }
  for (const Predicate& relation : model.predicates) {
    if (!relation.is_relation || relation.objects < 2) continue;
    for (const std::string& words : relation.words) {
      if (has_words(text, words)) return words;
    }
  }
  return {};
}

// What each of the table's words asks of a goal; empty where that is there.
enum class Asks : std::uint8_t {
  kOpens,
  kCloses,
  kAmong,
  kSides,
  kThen,
  kAfter,
  kEach,
  kSpares,
  kLeaves
};
struct GoalWords {
  std::string_view words;
  Asks asks;
};
constexpr auto kGoalWords = std::to_array<GoalWords>({
#define PROBE_GOAL_WORDS(words, asks) {words, Asks::asks},
#include "compiler/check/goal_words.def"
});

using PartOf = std::pair<FixtureId, std::uint32_t>;

// The parts that success measures: by themselves, by their joint or by a region of theirs.
void collect_parts(const Model& model, ExprRef ref, std::set<ExprRef>& seen,
                   std::set<PartOf>& out) {
  if (ref == kNoExpr || !seen.insert(ref).second) return;
  const ExprNode& node = model.exprs.nodes[ref];
  const auto fixture = static_cast<FixtureId>(node.a);
  if (node.op == ExprOp::kPart) out.insert({fixture, node.b});
  if (node.op == ExprOp::kRegion)
    out.insert({fixture, model.fixtures[fixture].regions[node.b].part});
  if (node.op == ExprOp::kJoint) {
    const auto& parts = model.fixtures[fixture].parts;
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
      if (parts[i].joint == node.b) out.insert({fixture, i});
    }
  }
  if (node.op == ExprOp::kAny || node.op == ExprOp::kAll || node.op == ExprOp::kNo) {
    for (const ExprRef body : model.exprs.sets[node.set].bodies)
      collect_parts(model, body, seen, out);
  }
  for (const ExprRef arg : node.args) collect_parts(model, arg, seen, out);
  if (node.op == ExprOp::kCall)
    collect_parts(model, model.predicates[node.predicate].body, seen, out);
}

// What tasks that say or are judged by the same have in common, read once.
class Shared {
 public:
  explicit Shared(const Model& model) : model_(model), callings_(model) {}

  using Filled = std::vector<std::uint32_t>;  // by role: how many, and which

  struct Text {
    std::string folded;
    std::vector<GoalWords> words;  // those of the table that are said
  };
  const Text& text(TemplateId say) {
    const auto [at, is_new] = texts_.try_emplace(say);
    if (!is_new) return at->second;
    at->second.folded = fold_case(literal_text(model_.templates[say]));
    for (const GoalWords& one : kGoalWords) {
      if (has_words(at->second.folded, one.words)) at->second.words.push_back(one);
    }
    return at->second;
  }

  // What success is, as expressions.
  static std::vector<ExprRef> success_of(const Task& task) {
    std::vector<ExprRef> found;
    for (const Metric& metric : task.judged) {
      if (metric.name == "success") found.push_back(metric.expr);
    }
    return found;
  }

  const std::set<PredicateId>& relations(const std::vector<ExprRef>& success) {
    const auto [at, is_new] = relations_.try_emplace(success);
    std::set<ExprRef> seen;
    if (is_new) {
      for (const ExprRef expr : success) collect_relations(model_, expr, seen, at->second);
    }
    return at->second;
  }
  const std::set<PartOf>& parts(const std::vector<ExprRef>& success) {
    const auto [at, is_new] = parts_.try_emplace(success);
    std::set<ExprRef> seen;
    if (is_new) {
      for (const ExprRef expr : success) collect_parts(model_, expr, seen, at->second);
    }
    return at->second;
  }

  // What the metrics ask, of tasks that are judged by the same and whose roles the same fills.
  const Goal& goal(const Task& task) {
    std::pair<std::vector<Judged>, Filled> key;
    for (const Metric& metric : task.judged)
      key.first.emplace_back(metric.name == "success", metric.expr, metric.readout);
    key.second = filled(task, all);
    const auto [at, is_new] = goals_.try_emplace(std::move(key));
    if (is_new) at->second = goal_of(model_, task);
    return at->second;
  }

  // What an instruction says, of tasks that say the same of the same where the same stands.
  const Said& said(const Task& task) {
    const auto [at, is_new] = said_.try_emplace(heard_key(task));
    if (is_new) at->second = said_by(model_, task);
    return at->second;
  }
  const Clauses& clauses(const Task& task) {
    const auto [at, is_new] = clauses_.try_emplace(heard_key(task));
    if (is_new) at->second = clauses_of(model_, task, callings_);
    return at->second;
  }

  // Words and success of which nothing was to be said but for what the task itself is.
  bool is_known_right(TemplateId say, const std::vector<ExprRef>& success) const {
    return right_.contains({say, success});
  }
  void keep_right(TemplateId say, const std::vector<ExprRef>& success) {
    right_.insert({say, success});
  }

  // The same of clauses, of tasks whose roles are filled alike: each by as many objects, by the
  // same parts; by the same objects where expressions name some.
  using ClauseKey = std::tuple<TemplateId, std::vector<ExprRef>, Filled>;
  ClauseKey clause_key(const Task& task) const {
    Filled by_role = filled(
        task, [&](ObjectId id) { return model_.exprs.names_objects || !task.is_object(id); });
    // The layout says what lies on what.
    by_role.push_back(static_cast<std::uint32_t>(task.layout));
    return {task.say, success_of(task), std::move(by_role)};
  }
  bool has_right_clauses(const ClauseKey& key) const { return right_clauses_.contains(key); }
  void keep_right_clauses(ClauseKey key) { right_clauses_.insert(std::move(key)); }

 private:
  using Judged = std::tuple<bool, ExprRef, plan::Readout>;
  using HeardKey = std::tuple<TemplateId, Filled, std::vector<ObjectId>>;

  // The scene with them: `parts` are those of its fixtures. `is_told`: of which objects it matters
  // who they are.
  template <typename IsTold>
  Filled filled(const Task& task, IsTold is_told) const {
    Filled by_role = {static_cast<std::uint32_t>(task.scene)};
    for (std::size_t i = 0; i < model_.roles.size(); ++i) {
      const auto objects = task.objects_in(model_.roles.id(i));
      by_role.push_back(static_cast<std::uint32_t>(objects.size()));
      for (const ObjectId id : objects) {
        if (is_told(id)) by_role.push_back(static_cast<std::uint32_t>(id));
      }
    }
    return by_role;
  }
  static bool all(ObjectId) { return true; }
  HeardKey heard_key(const Task& task) const {
    return {task.say, filled(task, all), task.objects()};
  }

  const Model& model_;
  Callings callings_;
  std::map<TemplateId, Text> texts_;
  std::map<std::pair<std::vector<Judged>, Filled>, Goal> goals_;
  std::map<HeardKey, Said> said_;
  std::map<HeardKey, Clauses> clauses_;
  std::map<std::vector<ExprRef>, std::set<PredicateId>> relations_;
  std::map<std::vector<ExprRef>, std::set<PartOf>> parts_;
  std::set<std::pair<TemplateId, std::vector<ExprRef>>> right_;
  std::set<ClauseKey> right_clauses_;
};

// Which way success goes: a joint's travel at least so much, or at most.
struct JointGoal {
  const Model& model;
  bool opens = false, closes = false, is_open_ended = false;
  std::set<ExprRef> seen = {};

  bool has_travel(ExprRef ref) const {
    const ExprNode& node = model.exprs.nodes[ref];
    if (node.op == ExprOp::kMeasure &&
        (node.measure == Measure::kTravel || node.measure == Measure::kSlide ||
         node.measure == Measure::kTurn))
      return true;
    return std::ranges::any_of(node.args, [&](ExprRef arg) { return has_travel(arg); });
  }
  void look(ExprRef ref) {
    if (ref == kNoExpr || !seen.insert(ref).second) return;
    const ExprNode& node = model.exprs.nodes[ref];
    // What is denied, latched or one of several ways says nothing for certain.
    is_open_ended = is_open_ended || node.op == ExprOp::kNot || node.op == ExprOp::kOr ||
                    node.op == ExprOp::kOnce || node.op == ExprOp::kNo;
    if (node.op == ExprOp::kLess || node.op == ExprOp::kLessEqual) {
      const bool less = has_travel(node.args[0]), more = has_travel(node.args[1]);
      closes = closes || (less && !more);
      opens = opens || (more && !less);
      return;
    }
    for (const ExprRef arg : node.args) look(arg);
    if (node.op == ExprOp::kCall) look(model.predicates[node.predicate].body);
  }
};

// What a task says and what it is judged by, read when some word asks for it.
class Told {
 public:
  Told(const Model& model, const Task& task, Shared& shared)
      : model_(model), task_(task), shared_(shared), text_(shared.text(task.say)) {}

  const Said& said() {
    if (said_ == nullptr) said_ = &shared_.said(task_);
    return *said_;
  }
  const Goal& goal() {
    if (goal_ == nullptr) goal_ = &shared_.goal(task_);
    return *goal_;
  }
  const Clauses& clauses() {
    if (clauses_ == nullptr) clauses_ = &shared_.clauses(task_);
    return *clauses_;
  }

  // Those of the table that are said.
  const std::vector<GoalWords>& words() const { return text_.words; }

  // What goes beside what by the words, where success asks the relation of them the other way
  // round.
  std::optional<std::pair<ObjectId, ObjectId>> turned_round(PredicateId relation) {
    if (model_.predicates[relation].objects != 2) return std::nullopt;
    for (const Clause& clause : clauses().all) {
      if (!clause.certain || clause.denied || clause.lies != Clause::Where::kBeside ||
          clause.what.size() != 1 || clause.what[0].of.size() != 1 || clause.where.size() != 1)
        continue;
      const Things& thing = clause.what[0].of;
      const auto asks = [&](const Things& a, const Things& b) {
        return std::ranges::any_of(goal().asked, [&](const Goal::Asked& asked) {
          return asked.predicate == relation && asked.of.size() >= 2 && asked.of[0] == a &&
                 asked.of[1] == b;
        });
      };
      if (asks(clause.where, thing) && !asks(thing, clause.where))
        return std::pair(*thing.begin(), *clause.where.begin());
    }
    return std::nullopt;
  }

  // Why success is not what the words ask for; none where it is, or nothing is certain.
  std::optional<std::string> lack_of(const GoalWords& one) {
    switch (one.asks) {
      case Asks::kOpens:
      case Asks::kCloses:
        return joint_lack(one);
      case Asks::kAmong:
        return among_lack(one);
      case Asks::kSides:
        return side_lack(one);
      case Asks::kThen:
      case Asks::kAfter:
        return order_lack(one);
      case Asks::kEach:
        return each_lack(one);
      case Asks::kSpares:
        return spare_lack(one);
      case Asks::kLeaves:
        return leave_lack(one);
    }
    return std::nullopt;
  }

 private:
  bool says(Asks asks) {
    return std::any_of(text_.words.begin(), text_.words.end(),
                       [&](const GoalWords& one) { return one.asks == asks && tells_to(one); });
  }

  // Words that tell to do so, not how a thing is: "open the drawer", not "the open drawer", "left
  // open" or "close to".
  bool tells_to(const GoalWords& one) {
    constexpr auto kBefore =
        std::to_array<std::string_view>({"and", "then", "please", "to", "first", "you", "can",
                                         "could", "should", "must", "now", "or", "but", "just"});
    const std::size_t length = folded_words(one.words).size();
    const auto& words = said().words;
    for (auto at = said().find(one.words); at; at = said().find(one.words, *at + 1)) {
      if (*at + length < words.size() && words[*at + length].text == "to") continue;
      if (length > 1 || *at == 0) return true;
      const std::string& before = words[*at - 1].text;
      if (before.ends_with("ly") ||
          std::find(kBefore.begin(), kBefore.end(), before) != kBefore.end())
        return true;
    }
    return false;
  }

  // "close the drawer" of which success is that it is open.
  std::optional<std::string> joint_lack(const GoalWords& one) {
    if (!tells_to(one)) return std::nullopt;
    const Asks asks = one.asks;
    JointGoal travels{model_};
    for (const Metric& metric : task_.judged) {
      if (metric.name == "success") travels.look(metric.expr);
    }
    if (travels.opens == travels.closes || travels.is_open_ended) return std::nullopt;
    if (says(Asks::kOpens) == says(Asks::kCloses) || travels.opens == (asks == Asks::kOpens))
      return std::nullopt;
    return std::string("succeeds when a joint's travel is ") +
           (travels.opens ? "at least so much" : "at most so much");
  }

  // "Pick up the bowl between A and B": that says which bowl, not where to.
  bool tells_which(std::size_t at) {
    static constexpr std::string_view kTakes[] = {"pick", "grasp", "grab", "take", "lift"};
    static constexpr std::string_view kPuts[] = {"put",  "place", "move", "set",
                                                 "drop", "push",  "lay",  "bring"};
    const auto is_in = [](const auto& words, std::string_view word) {
      return std::find(std::begin(words), std::end(words), word) != std::end(words);
    };
    while (at-- > 0) {
      const std::string_view word = said().words[at].text;
      if (is_in(kPuts, word)) return false;
      if (is_in(kTakes, word)) return true;
    }
    return false;
  }

  // "between A and B" of which success is that it lies on A.
  std::optional<std::string> among_lack(const GoalWords& one) {
    if (goal().tells_sides) return std::nullopt;
    const auto at = said().find(one.words);
    if (!at || tells_which(*at)) return std::nullopt;
    // What it stands before is not understood.
    if (*at == 0 && !clauses().is_whole) return std::nullopt;
    std::vector<Things> behind;
    for (std::size_t i = *at + 1; i < said().words.size() && behind.size() < 2; ++i) {
      if (!said().words[i].of.empty()) behind.push_back(said().words[i].of);
    }
    // "Between yourself and the plate": of one of them there is no telling.
    if (behind.empty() || (behind.size() == 1 && behind.front().size() == 1)) return std::nullopt;
    const Things& a = behind.front();
    const Things& b = behind.back();  // of several that one slot means they are the same
    const auto is_compared = [&](ObjectId thing, const Things& with) {
      return std::any_of(with.begin(), with.end(), [&](ObjectId other) {
        return goal().compared.contains(std::minmax(thing, other));
      });
    };
    const std::vector<ObjectId> there = nameable(model_, task_);
    if (std::any_of(there.begin(), there.end(), [&](ObjectId thing) {
          return !a.contains(thing) && !b.contains(thing) && is_compared(thing, a) &&
                 is_compared(thing, b);
        }))
      return std::nullopt;
    return "its success measures nothing to both of what that stands before";
  }

  // "without touching the can" of which success measures nothing of the can.
  std::optional<std::string> spare_lack(const GoalWords& one) {
    const auto at = said().find(one.words);
    if (!at || goal().speaks_of_all) return std::nullopt;
    for (std::size_t i = *at + 1; i < said().words.size(); ++i) {
      const Things& spared = said().words[i].of;
      if (spared.empty()) continue;
      if (std::any_of(spared.begin(), spared.end(),
                      [&](ObjectId thing) { return goal().spoken.contains(thing); }))
        return std::nullopt;
      return "its success measures nothing of " + name_of(spared);
    }
    return std::nullopt;
  }

  // "do not move the can" of which no metric at all measures anything.
  std::optional<std::string> leave_lack(const GoalWords& one) {
    const auto at = said().find(one.words);
    if (!at) return std::nullopt;
    const auto& words = said().words;
    for (std::size_t i = *at; i < words.size(); ++i) {
      const Things& spared = words[i].of;
      if (spared.empty()) continue;
      if (one.words == "leave" && (i + 1 >= words.size() || !says_leave(words[i + 1].text)))
        return std::nullopt;
      if (std::any_of(spared.begin(), spared.end(),
                      [&](ObjectId thing) { return is_measured(model_, task_, thing); }))
        return std::nullopt;
      return "no metric measures anything of " + name_of(spared);
    }
    return std::nullopt;
  }
  static bool says_leave(std::string_view word) {
    return word == "alone" || word == "where" || word == "untouched" || word == "as";
  }

  // "to the left of the plate" of which success is that it lies on the plate.
  std::optional<std::string> side_lack(const GoalWords& one) {
    if (goal().tells_sides) return std::nullopt;
    const std::size_t length = folded_words(one.words).size();
    for (auto at = said().find(one.words); at; at = said().find(one.words, *at + 1)) {
      // "next to the left knob" says of a knob which it is.
      const std::size_t next = *at + length;
      const bool is_side = one.words.ends_with("left") || one.words.ends_with("right");
      if (is_side && next < said().words.size()) {
        const std::string& word = said().words[next].text;
        if (word != "of" && word != "and" && word != "then" && word != "side") continue;
      }
      // "Pick up the book on the right" says which book; "take it to the right" says where to.
      const auto& words = said().words;
      const bool says_whither =
          one.words.starts_with("to the") ||
          (*at >= 2 && words[*at - 2].text == "to" && words[*at - 1].text == "the");
      if (!says_whither && (tells_which(*at) || follows_place(*at))) continue;
      return "its success measures nothing that tells one side from another";
    }
    return std::nullopt;
  }

  // "On the plate behind the towel": which plate.
  bool follows_place(std::size_t at) {
    const auto& words = said().words;
    std::size_t noun = at;
    while (noun > 0 && words[noun - 1].of.empty()) --noun;
    if (noun == 0 || noun != at) return false;
    constexpr auto kOn = std::to_array<std::string_view>({"on", "in", "into", "onto", "inside"});
    for (std::size_t i = noun - 1; i > 0 && i + 4 > noun; --i) {
      if (std::ranges::find(kOn, words[i - 1].text) != kOn.end()) return true;
      if (!words[i - 1].of.empty() || words[i - 1].ends) return false;
    }
    return false;
  }

  // "first A, then B" of which success is that B was done first, wants no order of the two, or is
  // content with A.
  std::optional<std::string> order_lack(const GoalWords& one) {
    if (one.words == "once" && !is_of_time()) return std::nullopt;
    if (one.words == "until" && !is_denied_until()) return std::nullopt;
    if (auto lack = other_order(one)) return lack;
    for (const auto& [first, second] : goal().order) {
      if (earliest(first) && earliest(second) && !is_asked(second))
        return "succeeds without " + name_of(second);
    }
    return no_order(one);
  }

  // "put B there once A is on it", not "at once" or "once more".
  bool is_of_time() {
    const auto at = said().find("once");
    if (!at || *at + 1 >= said().words.size()) return false;
    const std::string& next = said().words[*at + 1].text;
    return (*at == 0 || said().words[*at - 1].text != "at") && next != "more" && next != "again" &&
           next != "and";
  }

  // "do not put B there until A is on it".
  bool is_denied_until() {
    const auto at = said().find("until");
    return at && is_denied_before(*at);
  }
  bool is_denied_before(std::size_t at) {
    const auto& words = said().words;
    return std::any_of(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(at),
                       [](const Said::Word& word) {
                         return word.text == "not" || word.text == "don't" || word.text == "never";
                       });
  }

  bool is_asked(const Things& things) {
    return std::any_of(goal().asked.begin(), goal().asked.end(), [&](const Goal::Asked& asked) {
      return std::any_of(asked.of.begin(), asked.of.end(), [&](const Things& of) {
        return std::any_of(of.begin(), of.end(), [&](ObjectId id) { return things.contains(id); });
      });
    });
  }

  // Two objects that are said on both sides of the word, of each of which something is asked that
  // the other has no part in.
  std::optional<std::string> no_order(const GoalWords& one) {
    const auto at = said().find(one.words);
    if (!at) return std::nullopt;
    std::set<ObjectId> before, behind;
    for (const Goal::Asked& asked : goal().asked) {
      if (asked.of.empty() || asked.of[0].size() != 1) continue;
      const ObjectId thing = *asked.of[0].begin();
      const auto first = said().first(thing);
      if (!first) continue;
      (*first < *at ? before : behind).insert(thing);
    }
    for (const ObjectId a : before) {
      for (const ObjectId b : behind) {
        // "Open the drawer, then put the cup in it" says the way there.
        const bool is_way = model_.objects[a].of || model_.objects[b].of;
        if (is_way && !is_asked_alike(a, b)) continue;
        if (is_beside(a, b) && is_beside(b, a) && !is_ordered(a, b))
          return "its success wants no order of `" + model_.objects[a].name + "` and `" +
                 model_.objects[b].name + "`";
      }
    }
    return std::nullopt;
  }

  // Whether one predicate is asked of both, of parts: "open the top drawer, then the middle drawer".
  bool is_asked_alike(ObjectId a, ObjectId b) {
    const auto has = [&](PredicateId predicate, ObjectId thing) {
      return goal().asked.contains({predicate, {Things{thing}}});
    };
    return std::any_of(goal().asked.begin(), goal().asked.end(), [&](const Goal::Asked& asked) {
      return has(asked.predicate, a) && has(asked.predicate, b);
    });
  }

  // Whether nothing that is asked of A is asked of A and B together.
  bool is_beside(ObjectId a, ObjectId b) {
    return std::none_of(goal().asked.begin(), goal().asked.end(), [&](const Goal::Asked& asked) {
      return std::any_of(asked.of.begin(), asked.of.end(),
                         [&](const Things& of) { return of.contains(a); }) &&
             std::any_of(asked.of.begin(), asked.of.end(),
                         [&](const Things& of) { return of.contains(b); });
    });
  }
  bool is_ordered(ObjectId a, ObjectId b) {
    return std::any_of(goal().order.begin(), goal().order.end(), [&](const auto& order) {
      return (order.first.contains(a) && order.second.contains(b)) ||
             (order.first.contains(b) && order.second.contains(a));
    });
  }

  bool speaks_back(std::size_t at) {
    constexpr auto kBack =
        std::to_array<std::string_view>({"that", "this", "it", "them", "which", "these", "those"});
    return at < said().words.size() &&
           std::find(kBack.begin(), kBack.end(), said().words[at].text) != kBack.end();
  }

  std::optional<std::string> other_order(const GoalWords& one) {
    for (const auto& [first, second] : goal().order) {
      const auto a = earliest(first), b = earliest(second);
      if (!a || !b || *a == *b) continue;
      // Between the two, else at the beginning, where "then" and "afterwards" ask for nothing.
      auto at = said().find(one.words, std::min(*a, *b));
      const bool is_between = at && *at < std::max(*a, *b);
      const bool leads = one.words == "before" || one.words == "prior to" || one.words == "ahead of";
      if (!is_between && !leads && one.asks != Asks::kAfter) continue;
      if (!is_between) at = said().find(one.words);
      if (!at || (!is_between && *at > std::min(*a, *b))) continue;
      if (*at > 0 && said().words[*at - 1].text == "not") continue;
      // "Do not put B there before A is": that is A first.
      if (leads && is_denied_before(*at)) continue;
      // "After that" and "before it" speak of what was said before.
      const bool looks_back = speaks_back(*at + 1);
      const bool is_forward =
          (one.asks == Asks::kThen) == (is_between != (looks_back && is_between));
      if ((*a < *b) == is_forward) continue;
      return "succeeds when " + name_of(first) + " comes before " + name_of(second);
    }
    return std::nullopt;
  }

  // "both spoons" of which success is that any of them is there.
  std::optional<std::string> each_lack(const GoalWords& one) {
    for (const Things& things : goal().one_of) {
      const bool is_said =
          std::any_of(said().words.begin(), said().words.end(), [&](const Said::Word& word) {
            return std::includes(word.of.begin(), word.of.end(), things.begin(), things.end());
          });
      if (is_said && !is_each_asked(things))
        return "succeeds with one of " + std::to_string(things.size()) + " (`any`, not `all`)";
    }
    for (const Things& two : goal().either) {
      const bool is_said =
          std::all_of(two.begin(), two.end(), [&](ObjectId thing) { return said().first(thing); });
      if (is_said && !is_each_asked(two)) return "succeeds with one of 2 (`or`, not `and`)";
    }
    return one.words == "both" ? both_lack() : std::nullopt;
  }
  // "both the can and the cup" of which success asks of the can alone.
  std::optional<std::string> both_lack() {
    const auto at = said().find("both");
    if (!at) return std::nullopt;
    std::vector<ObjectId> behind;
    for (std::size_t i = *at + 1; i < said().words.size() && behind.size() < 2; ++i) {
      const Things& of = said().words[i].of;
      if (of.size() > 1) return std::nullopt;
      if (of.size() == 1 && (behind.empty() || behind[0] != *of.begin()))
        behind.push_back(*of.begin());
    }
    if (behind.size() < 2 || goal().asked.empty()) return std::nullopt;
    const bool first = is_asked(Things{behind[0]}), second = is_asked(Things{behind[1]});
    if (first == second) return std::nullopt;
    return "succeeds without " + name_of(Things{behind[first ? 1 : 0]});
  }
  bool is_each_asked(const Things& things) {
    return std::all_of(things.begin(), things.end(),
                       [&](ObjectId thing) { return is_asked(Things{thing}); });
  }

  std::optional<std::size_t> earliest(const Things& things) {
    std::optional<std::size_t> found;
    for (const ObjectId thing : things) {
      const auto at = said().first(thing);
      if (at && (!found || *at < *found)) found = at;
    }
    return found;
  }

  std::string name_of(const Things& things) const {
    return "`" + model_.objects[*things.begin()].name + "`";
  }

  const Model& model_;
  const Task& task_;
  Shared& shared_;
  const Shared::Text& text_;
  const Said* said_ = nullptr;
  const Goal* goal_ = nullptr;
  const Clauses* clauses_ = nullptr;
};

// An instruction that says the opposite of what success is, or another relation alone.
bool says_other_relation(const Model& model, const Task& task, Told& told, Shared& shared,
                         Reporter& reporter) {
  const std::vector<ExprRef> success = Shared::success_of(task);
  const std::set<PredicateId>& judged = shared.relations(success);
  if (judged.empty() || shared.is_known_right(task.say, success)) return false;
  const std::string& text = shared.text(task.say).folded;
  const std::string elsewhere = other_relation(model, judged, text);
  bool is_said = false, is_of_its_own = false;
  for (const PredicateId id : judged) {
    const Predicate& relation = model.predicates[id];
    // "To the right of B" is `left_of(B, A)`, and "to the left of B" is not.
    const auto turned = told.turned_round(id);
    is_of_its_own = is_of_its_own || turned;
    if (turned && has_opposite(relation.words) && says(text, relation)) {
      is_said = true;
      const auto name = [&](ObjectId object) { return "`" + model.objects[object].name + "`"; };
      report_of(reporter, Code::P1202, task, task.say_span,
                "`" + task.name + "` says " + listed(relation.words) + " of " +
                    name(turned->first) + " and is judged by `" + relation.name + "` of " +
                    name(turned->second) + ", the other way round")
          .label(relation.span, "declared here");
      continue;
    }
    if (says(text, relation)) continue;
    std::string other = opposite_in(text, relation.words);
    if (turned && !other.empty()) continue;
    if (other.empty()) other = elsewhere;
    if (other.empty()) continue;
    is_said = true;
    report_of(reporter, Code::P1202, task, task.say_span,
              "`" + task.name + "` says \"" + other + "\" and is judged by `" + relation.name + "`")
        .point("that is said by " + listed(relation.words))
        .label(relation.span, "declared here");
  }
  if (!is_said && !is_of_its_own) shared.keep_right(task.say, success);
  return is_said;
}

// Words of the table that success is not about.
bool says_other_goal(const Model& model, const Task& task, Told& told, Reporter& reporter) {
  for (const GoalWords& one : told.words()) {
    const std::optional<std::string> lack = told.lack_of(one);
    if (!lack) continue;
    report_of(reporter, Code::P1202, task, task.say_span,
              "`" + task.name + "` says \"" + std::string(one.words) + "\" and " + *lack)
        .label(model.metrics[task.metrics].span, "judged by these");
    return true;
  }
  return false;
}

// Whether the words could speak of a thing in a way that is not its name: by a noun of a phrase, by
// a value of an attribute, or of several at once.
bool may_speak_of(const Model& model, const Said& said, const Clauses& clauses, ObjectId thing) {
  // Of words that are all understood it is known.
  if (clauses.is_whole && !clauses.all.empty()) return clauses.said.contains(thing);
  constexpr auto kSeveral = std::to_array<std::string_view>(
      {"all", "both", "each", "every", "everything", "them", "these", "those", "things", "objects",
       "items", "others", "other", "rest", "two", "three", "four", "together"});
  const Object& object = model.objects[thing];
  std::vector<std::string> nouns;
  const auto add_noun = [&](const std::string& text) {
    const std::vector<std::string> words = folded_words(text);
    if (!words.empty()) nouns.push_back(words.back());
  };
  add_noun(object.text.text);
  for (const Phrase& phrase : object.phrases) add_noun(phrase.text.text);
  for (std::size_t i = 0; i < object.values.size(); ++i) {
    for (const std::uint32_t value : object.values[i])
      add_noun(model.attributes[model.attributes.id(i)].values[value]);
  }
  return std::any_of(said.words.begin(), said.words.end(), [&](const Said::Word& word) {
    if (word.of.contains(thing)) return true;
    if (word.text.empty()) return false;
    return std::find(kSeveral.begin(), kSeveral.end(), word.text) != kSeveral.end() ||
           std::any_of(nouns.begin(), nouns.end(),
                       [&](const std::string& noun) { return is_same_noun(word.text, noun); });
  });
}

// Whether some predicate may be asked of two things, before a task says of which.
class AskedTwice {
 public:
  explicit AskedTwice(const Model& model) : model_(model) {}

  bool operator()(const Task& task) {
    return std::any_of(task.judged.begin(), task.judged.end(), [&](const Metric& metric) {
      if (metric.name != "success") return false;
      const auto [at, is_new] = known_.try_emplace(metric.expr, false);
      if (is_new) {
        std::set<PredicateId> called;
        at->second = look(metric.expr, called);
      }
      return at->second;
    });
  }

 private:
  bool look(ExprRef ref, std::set<PredicateId>& called) const {
    if (ref == kNoExpr) return false;
    const ExprNode& node = model_.exprs.nodes[ref];
    if (node.op == ExprOp::kAll) return true;
    if (node.op == ExprOp::kCall) {
      if (!called.insert(node.predicate).second) return true;
      return look(model_.predicates[node.predicate].body, called);
    }
    const bool is_certain = node.op == ExprOp::kAnd || node.op == ExprOp::kHold ||
                            node.op == ExprOp::kOnce || node.op == ExprOp::kAlways;
    return is_certain && std::any_of(node.args.begin(), node.args.end(),
                                     [&](ExprRef arg) { return look(arg, called); });
  }

  const Model& model_;
  std::map<ExprRef, bool> known_;
};

// "put A on the plate" of which success is that A and B lie on it: what is asked of two, of two
// things each, is said of both or of none.
bool leaves_one_out(const Model& model, const Task& task, Told& told, Reporter& reporter) {
  const auto is_given = [](const Goal::Asked& asked, ObjectId thing) {
    return std::any_of(asked.of.begin() + 1, asked.of.end(),
                       [&](const Things& of) { return of.contains(thing); });
  };
  // Of one thing and another; of parts of fixtures, of one alone.
  const auto is_of_one = [&](const Goal::Asked& one) {
    if (one.of.empty() || one.of[0].size() != 1) return false;
    const auto& part = model.objects[*one.of[0].begin()].of;
    return one.of.size() > 1 ? !one.of[1].empty() : part && part->is_part();
  };
  const auto& asked = told.goal().asked;
  for (const Goal::Asked& one : asked) {
    if (!is_of_one(one)) continue;
    const ObjectId left_out = *one.of[0].begin();
    if (may_speak_of(model, told.said(), told.clauses(), left_out)) continue;
    for (const Goal::Asked& other : asked) {
      if (other.predicate != one.predicate || !is_of_one(other)) continue;
      const ObjectId said = *other.of[0].begin();
      if (said == left_out || is_given(one, said) || is_given(other, left_out) ||
          !told.said().first(said))
        continue;
      report_of(reporter, Code::P1202, task, task.say_span,
                "`" + task.name + "` says `" + model.objects[said].name + "` and not `" +
                    model.objects[left_out].name + "`, of which success asks `" +
                    model.predicates[one.predicate].name + "` as well")
          .label(model.metrics[task.metrics].span, "judged by these");
      return true;
    }
  }
  return false;
}

// "put the cube on the towel" of which success is that it lies on the plate.
bool says_other_clause(const Model& model, const Task& task, Told& told, Shared& shared,
                       Reporter& reporter) {
  Shared::ClauseKey key = shared.clause_key(task);
  if (shared.has_right_clauses(key)) return false;
  const auto lack = clause_lack(model, task, told.clauses(), told.goal());
  if (!lack) {
    if (told.clauses().is_pure) shared.keep_right_clauses(std::move(key));
    return false;
  }
  report_of(reporter, Code::P1202, task, task.say_span, "`" + task.name + "` " + *lack)
      .label(model.metrics[task.metrics].span, "judged by these");
  return true;
}

// What the task does with parts: what fills its roles, what success measures, what its solution
// handles on the way.
std::set<PartOf> parts_meant(const Model& model, const Task& task, Shared& shared) {
  std::set<PartOf> meant;
  for (const auto& [role, id] : task.things())
    meant.insert({model.objects[id].of->fixture, model.objects[id].of->part});
  const std::set<PartOf>& measured = shared.parts(Shared::success_of(task));
  meant.insert(measured.begin(), measured.end());
  if (meant.empty()) return meant;
  for (const SkillUse& skill : task.solution) {
    for (const SkillOperand& operand : {skill.what, skill.to}) {
      const std::string name = operand.owner.text + "." + operand.name.text;
      for (const Object& thing : model.objects) {
        if (thing.of && thing.name == name) meant.insert({thing.of->fixture, thing.of->part});
      }
    }
  }
  return meant;
}

// "open the middle drawer" of which success is that the top drawer is open.
bool says_other_part(const Model& model, const Task& task, Shared& shared, Reporter& reporter) {
  if (has_negation(model.templates[task.say]) || has_words(shared.text(task.say).folded, "except"))
    return false;
  const std::set<PartOf> meant = parts_meant(model, task, shared);
  if (meant.empty()) return false;
  const auto is_meant = [&](const Object& thing) {
    return meant.contains({thing.of->fixture, thing.of->part});
  };
  const std::string& text = shared.text(task.say).folded;
  const auto& parts = model.templates[task.say].parts;
  const auto is_said = [&](const Object& thing) {
    // A region without a name of its own is called like what it is of.
    const bool has_name =
        !thing.of->region ||
        !model.fixtures[thing.of->fixture].regions[*thing.of->region].text.text.empty();
    return (has_name && has_words(text, fold_case(thing.text.text))) ||
           std::any_of(parts.begin(), parts.end(), [&](const Template::Part& part) {
             if (!part.slot) return false;
             if (part.slot->role == RoleId::kNone) return part.slot->name.text == thing.name;
             const auto things = task.things();
             return std::any_of(things.begin(), things.end(), [&](const auto& filled) {
               return filled.first == part.slot->role && &model.objects[filled.second] == &thing;
             });
           });
  };
  // Whose part is meant may speak of others as well, as of the way there.
  if (std::any_of(model.objects.begin(), model.objects.end(), [&](const Object& thing) {
        return thing.of && is_meant(thing) && is_said(thing);
      }))
    return false;
  const auto& fixtures = model.scenes[task.scene].fixtures;
  for (const Object& thing : model.objects) {
    if (!thing.of || is_meant(thing) || !is_said(thing) ||
        std::find(fixtures.begin(), fixtures.end(), thing.of->fixture) == fixtures.end())
      continue;
    report_of(reporter, Code::P1202, task, task.say_span,
              "`" + task.name + "` says `" + thing.name + "`, which its success does not measure")
        .label(model.metrics[task.metrics].span, "judged by these");
    return true;
  }
  return false;
}

}  // namespace

void check_goal_words(const Model& model, Reporter& reporter) {
  AskedTwice asks_twice(model);
  Shared shared(model);
  const auto check = [&](const Task& task, bool is_last, bool is_whole) {
    if (is_control(model.templates[task.say])) return;
    const About about(reporter, task.decl_span);
    Told told(model, task, shared);
    // One thing is said of a task: the others may follow from it.
    if (says_other_relation(model, task, told, shared, reporter)) return;
    if (says_other_goal(model, task, told, reporter)) return;
    if (says_other_part(model, task, shared, reporter)) return;
    if (has_nouns_of_several(model, task) && leaves_noun_open(model, task, told.said(), reporter))
      return;
    // What is done before another sentence comes need not be so at the end.
    if (is_last && says_other_clause(model, task, told, shared, reporter)) return;
    // What one of several sentences leaves out another may say.
    if (is_whole && asks_twice(task)) leaves_one_out(model, task, told, reporter);
  };
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete) continue;
    std::size_t sentence = 0;
    for_each_telling(task, [&](const Task& told) {
      check(told, ++sentence == sentence_count(task), task.later.empty());
    });
  }
}

}  // namespace probe::sema
