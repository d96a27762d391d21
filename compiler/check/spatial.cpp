// P1202: words that say where things are must be those of the relation that proves or judges them.
#include <algorithm>
#include <set>

#include "compiler/check/check.h"
#include "compiler/define/wording.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {
namespace {

bool says(std::string_view text, const Predicate& relation) {
  return std::any_of(relation.words.begin(), relation.words.end(),
                     [&](const std::string& words) { return has_words(text, words); });
}

// Whether words behind the relation's speak of the object: by the last word of its name, or by a
// phrase of it.
bool speaks_of(std::string_view text, const Predicate& relation, const Object& object) {
  std::size_t behind = text.size();
  for (const std::string& words : relation.words) {
    const std::size_t at = text.find(words);
    if (at != text.npos) behind = std::min(behind, at + words.size());
  }
  const std::string_view rest = text.substr(behind);
  const std::string name = fold_case(object.text.text);
  if (has_words(rest, std::string_view(name).substr(name.rfind(' ') + 1))) return true;
  return std::any_of(object.phrases.begin(), object.phrases.end(), [&](const Phrase& phrase) {
    return has_words(rest, fold_case(phrase.text.text));
  });
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "\"" : ", \"") + word + "\"";
  return text;
}

void check_phrase_words(const Model& model, Reporter& reporter) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> said;  // objects are copied with their phrases
  for (const Object& object : model.objects) {
    for (const Phrase& phrase : object.phrases) {
      const std::string text = fold_case(phrase.text.text);
      for (const QueryOp& op : phrase.means) {
        if (op.kind != QueryOp::kRelation) continue;
        const Predicate& relation = model.predicates[static_cast<PredicateId>(op.a)];
        if (relation.broken) continue;
        const Span& span = phrase.text.span;
        const About about(reporter, object.decl_span);
        if (says(text, relation)) {
          for (const ObjectId other : op.to) {
            if (other == ObjectId::kNone || speaks_of(text, relation, model.objects[other]))
              continue;
            if (!said.insert({span.file.value, span.begin}).second) continue;
            reporter
                .report(Code::P1202, span,
                        "\"" + phrase.text.text + "\" does not say to which object: `" +
                            model.objects[other].name + "`")
                .point("`" + relation.name + "` is to \"" + model.objects[other].text.text + "\"");
          }
          continue;
        }
        if (!said.insert({span.file.value, span.begin}).second) continue;
        reporter
            .report(Code::P1202, span,
                    "\"" + phrase.text.text + "\" does not say `" + relation.name + "`")
            .point("it is said by " + listed(relation.words))
            .label(relation.span, "declared here");
      }
    }
  }
}

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

// An instruction that says the opposite of what success is.
void check_goal_words(const Model& model, Reporter& reporter) {
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete) continue;
    std::set<PredicateId> judged;
    std::set<ExprRef> seen;
    for (const Metric& metric : task.judged) {
      if (metric.name == "success") collect_relations(model, metric.expr, seen, judged);
    }
    if (judged.empty()) continue;
    std::string text;
    for (const Template::Part& part : model.templates[task.say].parts) text += part.literal + " ";
    text = fold_case(text);
    for (const PredicateId id : judged) {
      const Predicate& relation = model.predicates[id];
      if (says(text, relation)) continue;
      const std::string other = opposite_in(text, relation.words);
      if (other.empty()) continue;
      const About about(reporter, task.decl_span);
      reporter
          .report(
              Code::P1202, task.say_span.is_none() ? task.span : task.say_span,
              "`" + task.name + "` says \"" + other + "\" and is judged by `" + relation.name + "`")
          .point("that is said by " + listed(relation.words))
          .label(relation.span, "declared here");
    }
  }
}

}  // namespace

void check_spatial_words(const Model& model, Reporter& reporter) {
  check_phrase_words(model, reporter);
  check_goal_words(model, reporter);
}

}  // namespace probe::sema
