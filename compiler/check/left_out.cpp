// P1202 of what an instruction leaves out: it says one of two of which success asks the same.
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/check/check.h"
#include "compiler/check/other_said.h"
#include "runtime/base/nouns.h"

namespace probe::sema {
namespace {

// Whether the words could speak of a thing in a way that is not its name: by a noun of a phrase, by
// a value of an attribute, or of several at once.
bool may_speak_of(const Model& model, const Said& said, const Clauses& clauses, ObjectId thing) {
  // Which things "everything" and "these" are is not said by words.
  constexpr auto kAny = std::to_array<std::string_view>({"everything", "this", "these", "those"});
  const bool is_open = std::any_of(said.words.begin(), said.words.end(), [&](const auto& word) {
    return std::find(kAny.begin(), kAny.end(), word.text) != kAny.end();
  });
  if (is_open) return true;
  // "Both cans" where one is called so: another is one, too.
  const bool counts_more =
      std::any_of(clauses.all.begin(), clauses.all.end(), [](const Clause& clause) {
        return std::any_of(clause.what.begin(), clause.what.end(),
                           [](const Clause::What& what) { return what.count > what.of.size(); });
      });
  if (counts_more) return true;
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

// "Move it", "push them away", "move": of whatever is there.
bool is_of_any(const Clause& clause) {
  return clause.what.empty() ||
         std::any_of(clause.what.begin(), clause.what.end(),
                     [](const Clause::What& what) { return what.of.empty(); });
}

}  // namespace

bool AskedTwice::operator()(const Task& task) {
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

bool AskedTwice::look(ExprRef ref, std::set<PredicateId>& called) const {
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

// "put A on the plate" of which success is that C has moved as well.
bool moves_unsaid(const Model& model, const Task& task, Told& told, Reporter& reporter) {
  if (told.goal().shifted.empty() || !told.clauses().is_whole || told.clauses().all.empty())
    return false;
  const auto& clauses = told.clauses().all;
  if (std::any_of(clauses.begin(), clauses.end(), is_of_any)) return false;
  for (const ObjectId thing : told.goal().shifted) {
    if (may_speak_of(model, told.said(), told.clauses(), thing)) continue;
    report_of(reporter, Code::P1202, task, task.say_span,
              "success of `" + task.name + "` wants `" + model.objects[thing].name +
                  "` to be elsewhere than it began, of which nothing is said")
        .label(model.metrics[task.metrics].span, "judged by these");
    return true;
  }
  return false;
}

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

}  // namespace probe::sema
