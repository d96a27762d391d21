// P1202 of instructions: words that ask for something are held to what success is.
#include "compiler/check/goal_words.h"

#include <optional>
#include <set>
#include <string>
#include <utility>

#include "compiler/check/check.h"
#include "compiler/check/clause_goal.h"
#include "compiler/check/noun_words.h"
#include "compiler/check/other_said.h"
#include "compiler/check/shared.h"
#include "compiler/check/told.h"
#include "compiler/check/word_lacks.h"
#include "compiler/define/remembered.h"
#include "compiler/define/telling.h"
#include "compiler/define/wording.h"

namespace probe::sema {
namespace {

// Why success is not what the words ask for; none where it is, or nothing is certain.
std::optional<std::string> lack_of(Told& told, const GoalWords& one) {
  switch (one.asks) {
    case Asks::kOpens:
    case Asks::kCloses:
      return joint_word_lack(told, one);
    case Asks::kAmong:
      return among_word_lack(told, one);
    case Asks::kSides:
      return side_word_lack(told, one);
    case Asks::kThen:
    case Asks::kAfter:
      return order_word_lack(told, one);
    case Asks::kEach:
      return each_word_lack(told, one);
    case Asks::kSpares:
      return spare_word_lack(told, one);
    case Asks::kLeaves:
      return leave_word_lack(told, one);
  }
  return std::nullopt;
}

// What a task that means them would write; empty where there is no telling.
std::string_view help_for(Asks asks) {
  switch (asks) {
    case Asks::kAmong:
      return "where the words tell which thing is meant, declare them as its phrase, `phrase amid spatial "
             "\"..\" means between(..)`, and say `refer source as amid`: that is proved in every start";
    case Asks::kThen:
    case Asks::kAfter:
      return "`put_in_order(source, target, helper, target)` of std/place.probe asks for an order";
    case Asks::kEach:
      return "ask for each: `.. and on_top_of(helper, target)`, or `all g in goods: on_top_of(g, target)`";
    case Asks::kOpens:
    case Asks::kCloses:
    case Asks::kSides:
    case Asks::kSpares:
    case Asks::kLeaves:
      break;
  }
  return {};
}

// Words of the table that success is not about.
bool says_other_goal(const Model& model, const Task& task, Told& told, Reporter& reporter) {
  for (const GoalWords& one : told.words()) {
    const std::optional<std::string> lack = lack_of(told, one);
    if (!lack) continue;
    Diagnostic& said = report_of(
        reporter, Code::P1202, task, task.say_span,
        "`" + task.name + "` says \"" + std::string(one.words) + "\" and " + *lack);
    said.label(model.metrics[task.metrics].span, "judged by these");
    if (const std::string_view help = help_for(one.asks); !help.empty()) said.help(std::string(help));
    return true;
  }
  return false;
}

using Mistaken = std::set<std::pair<TemplateId, ObjectId>>;  // of which it was said

// "the blue cube" of a red one, once for an instruction.
void says_other_value(const Model& model, const Task& task, Told& told, Mistaken& said,
                      Silence& silence, Reporter& reporter) {
  for (const Clauses::Mistaken& one : told.clauses().mistaken) {
    if (!said.insert({task.say, one.thing}).second) {
      silence.hold_back();
      continue;
    }
    const Object& object = model.objects[one.thing];
    report_of(reporter, Code::P1510, task, task.say_span,
              "`" + task.name + "` calls `" + object.name + "` \"" + one.words + "\", and its `" +
                  one.attribute + "` is " + one.value)
        .label(object.span, "declared here")
        .severity = Severity::kWarning;
  }
}

// "put the cube on the towel" of which success is that it lies on the plate.
bool says_other_clause(const Model& model, const Task& task, Told& told, Shared& shared,
                       Mistaken& mistaken, bool is_whole, Silence& silence,
                       Reporter& reporter) {
  if (shared.has_right_clauses(told.key())) return false;
  says_other_value(model, task, told, mistaken, silence, reporter);
  const auto lack = clause_lack(model, task, told.clauses(), told.goal(), is_whole);
  if (!lack) {
    if (is_whole && moves_unsaid(model, task, told, reporter)) return true;
    // Of a later sentence less is asked.
    if (is_whole && told.clauses().is_pure) shared.keep_right_clauses(told.key());
    return false;
  }
  report_of(reporter, Code::P1202, task, task.say_span, "`" + task.name + "` " + *lack)
      .label(model.metrics[task.metrics].span, "judged by these");
  return true;
}

}  // namespace

void check_goal_words(const Model& model, Reporter& reporter) {
  AskedTwice asks_twice(model);
  Shared shared(model);
  Mistaken mistaken;
  Silence silence(model, reporter, Silent::kGoals);
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
    if (is_last && says_other_clause(model, task, told, shared, mistaken, is_whole, silence,
                                     reporter))
      return;
    // What one of several sentences leaves out another may say.
    if (is_whole && asks_twice(task)) leaves_one_out(model, task, told, reporter);
  };
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete || silence.is_known(task)) continue;
    std::size_t sentence = 0;
    for_each_telling(task, [&](const Task& told) {
      check(told, ++sentence == sentence_count(task), task.later.empty());
    });
  }
}

}  // namespace probe::sema
