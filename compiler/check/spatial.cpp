// P1202: words that say where things are must be those of the relation that proves or judges them.
#include <algorithm>
#include <initializer_list>
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

// What an instruction says beside its slots.
std::string literal_text(const Model& model, const Task& task) {
  std::string text;
  for (const Template::Part& part : model.templates[task.say].parts) text += part.literal + " ";
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

// An instruction that says the opposite of what success is, or another relation alone.
void check_goal_words(const Model& model, Reporter& reporter) {
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete) continue;
    std::set<PredicateId> judged;
    std::set<ExprRef> seen;
    for (const Metric& metric : task.judged) {
      if (metric.name == "success") collect_relations(model, metric.expr, seen, judged);
    }
    if (judged.empty()) continue;
    const std::string text = fold_case(literal_text(model, task));
    const std::string elsewhere = other_relation(model, judged, text);
    for (const PredicateId id : judged) {
      const Predicate& relation = model.predicates[id];
      if (says(text, relation)) continue;
      std::string other = opposite_in(text, relation.words);
      if (other.empty()) other = elsewhere;
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

std::string_view first_of(std::string_view text, std::initializer_list<std::string_view> words) {
  for (const std::string_view one : words) {
    if (has_words(text, one)) return one;
  }
  return {};
}

// "close the drawer" of which success is that it is open.
void check_joint_words(const Model& model, Reporter& reporter) {
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete) continue;
    JointGoal travels{model};
    for (const Metric& metric : task.judged) {
      if (metric.name == "success") travels.look(metric.expr);
    }
    if (travels.opens == travels.closes || travels.is_open_ended) continue;
    const std::string text = fold_case(literal_text(model, task));
    const std::string_view open = first_of(text, {"open", "turn on", "switch on"}),
                           close = first_of(text, {"close", "shut", "turn off", "switch off"});
    const bool says_open = !open.empty(), says_close = !close.empty();
    if (says_open == says_close || says_open == travels.opens) continue;
    const About about(reporter, task.decl_span);
    reporter
        .report(Code::P1202, task.say_span.is_none() ? task.span : task.say_span,
                "`" + task.name + "` says \"" + std::string(says_open ? open : close) +
                    "\" and succeeds when a joint's travel is " +
                    (travels.opens ? "at least so much" : "at most so much"))
        .label(model.metrics[task.metrics].span, "judged by these");
  }
}

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

// What the task does with parts: what fills its roles, what success measures, what its solution
// handles on the way.
std::set<PartOf> parts_meant(const Model& model, const Task& task) {
  std::set<PartOf> meant;
  for (const auto& [role, id] : task.things())
    meant.insert({model.objects[id].of->fixture, model.objects[id].of->part});
  std::set<ExprRef> seen;
  for (const Metric& metric : task.judged) {
    if (metric.name == "success") collect_parts(model, metric.expr, seen, meant);
  }
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
void check_part_words(const Model& model, Reporter& reporter) {
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete || has_negation(model.templates[task.say])) continue;
    const std::set<PartOf> meant = parts_meant(model, task);
    if (meant.empty()) continue;
    const auto is_meant = [&](const Object& thing) {
      return meant.contains({thing.of->fixture, thing.of->part});
    };
    const std::string text = fold_case(literal_text(model, task));
    const auto& parts = model.templates[task.say].parts;
    const auto is_said = [&](const Object& thing) {
      const std::string words = fold_case(thing.text.text);
      return has_words(text, words) ||
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
      continue;
    const auto& fixtures = model.scenes[task.scene].fixtures;
    for (const Object& thing : model.objects) {
      if (!thing.of || is_meant(thing) || !is_said(thing) ||
          std::find(fixtures.begin(), fixtures.end(), thing.of->fixture) == fixtures.end())
        continue;
      const About about(reporter, task.decl_span);
      reporter
          .report(
              Code::P1202, task.say_span.is_none() ? task.span : task.say_span,
              "`" + task.name + "` says `" + thing.name + "`, which its success does not measure")
          .label(model.metrics[task.metrics].span, "judged by these");
      break;
    }
  }
}

}  // namespace

void check_spatial_words(const Model& model, Reporter& reporter) {
  check_phrase_words(model, reporter);
  check_goal_words(model, reporter);
  check_joint_words(model, reporter);
  check_part_words(model, reporter);
}

}  // namespace probe::sema
