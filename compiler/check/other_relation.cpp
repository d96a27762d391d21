// P1202 of relations: "to the left of" of what is judged to be on the right.
#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/check/check.h"
#include "compiler/check/other_said.h"
#include "compiler/check/relation_words.h"
#include "compiler/define/wording.h"
#include "runtime/base/words.h"

namespace probe::sema {
namespace {

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

// What goes beside what by the words, where success asks the relation of them the other way
// round.
std::optional<std::pair<ObjectId, ObjectId>> turned_round(Told& told, PredicateId relation) {
  if (told.model().predicates[relation].objects != 2) return std::nullopt;
  for (const Clause& clause : told.clauses().all) {
    if (!clause.certain || clause.denied || !clause.is_aside() ||
        clause.what.size() != 1 || clause.what[0].of.size() != 1 || clause.where.size() != 1)
      continue;
    const Things& thing = clause.what[0].of;
    const auto asks = [&](const Things& a, const Things& b) {
      return std::ranges::any_of(told.goal().asked, [&](const Goal::Asked& asked) {
        return asked.predicate == relation && asked.of.size() >= 2 && asked.of[0] == a &&
               asked.of[1] == b;
      });
    };
    if (asks(clause.where, thing) && !asks(thing, clause.where))
      return std::pair(*thing.begin(), *clause.where.begin());
  }
  return std::nullopt;
}

}  // namespace

bool says_other_relation(const Model& model, const Task& task, Told& told, Shared& shared,
                         Reporter& reporter) {
  const std::vector<ExprRef> success = Shared::success_of(task);
  const std::set<PredicateId>& judged = shared.relations(success);
  if (judged.empty() || shared.has_right_relations(told.key())) return false;
  const std::string& text = shared.text(task.say).folded;
  const std::string elsewhere = other_relation(model, judged, text);
  bool is_said = false, is_of_its_own = false;
  for (const PredicateId id : judged) {
    const Predicate& relation = model.predicates[id];
    // "To the right of B" is `left_of(B, A)`, and "to the left of B" is not.
    const auto turned = turned_round(told, id);
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
  if (!is_said && !is_of_its_own) shared.keep_right_relations(told.key());
  return is_said;
}

}  // namespace probe::sema
