// P04xx: every phrase must single out its referent among the objects of the task, and every
// instruction must be a sentence that a policy can be given.
#include <algorithm>
#include <set>
#include <tuple>

#include "compiler/check/check.h"
#include "compiler/check/count_words.h"
#include "compiler/check/starts.h"
#include "compiler/check/unclear_starts.h"
#include "compiler/define/in_start.h"
#include "compiler/define/likeness.h"
#include "compiler/define/query.h"
#include "compiler/define/remembered.h"
#include "compiler/define/task.h"
#include "compiler/define/telling.h"
#include "compiler/define/template.h"
#include "compiler/define/thing.h"
#include "compiler/define/wording.h"
#include "compiler/names/texts.h"
#include "runtime/plan/axes.h"

namespace probe::sema {
namespace {

// Phrases that do not fit their own object, whatever else is in the scene.
using Unfit = std::set<std::pair<const Phrase*, ObjectId>>;

struct TaskLanguage {
  const Model& model;
  Reporter& reporter;
  const Task& task;
  Unfit& unfit;
  Relations& relations;
  UnclearStarts& unclear;
  Silence& silence;

  // Where the words for a role are chosen, here or in what is copied.
  const Span& chosen(RoleId role) const {
    const Spelled* refer = task.refer_of(role);
    return refer != nullptr ? refer->span : task.say_span;
  }
  const Span& place(RoleId role) const { return task.place(chosen(role)); }

  // What made `other` a rival of the words for a role: the newcomer when the words were there
  // before it, else the words.
  Span rivalry(RoleId role, ObjectId other) const {
    if (chosen(role).is_none() || is_within(chosen(role), task.decl_span)) return place(role);
    return task.place(entry_of(task, other).value_or(task.span));
  }

  // An attribute or fact that would tell the two apart: a hint that certainly helps.
  std::string discriminator(const Object& wanted, const Object& other) const {
    for (std::size_t a = 0; a < wanted.values.size(); ++a) {
      if (wanted.values[a].size() != 1 || other.values[a].empty()) continue;
      bool shared = false;
      for (const std::uint32_t value : other.values[a])
        shared = shared || value == wanted.values[a][0];
      if (shared) continue;
      const Attribute& attribute = model.attributes[static_cast<AttributeId>(a)];
      return attribute.name + " " + attribute.values[wanted.values[a][0]];
    }
    for (std::size_t f = 0; f < wanted.facts.size(); ++f) {
      if (wanted.facts[f] == Truth::kYes && other.facts[f] == Truth::kNo) return model.facts[f];
    }
    return {};
  }

  void check_phrase(RoleId role, const Phrase& phrase, ObjectId wanted_id) const {
    if (phrase.is_spatial()) return check_places(role, phrase, wanted_id);
    const Object& wanted = model.objects[wanted_id];
    const std::string quoted = "\"" + phrase.text.text + "\"";
    const std::vector<ObjectId> objects = rivals_of(role, wanted_id, denotable(model, task));
    const Denotation meant = denote(model, objects, phrase, wanted_id);
    if (!meant.fits) {
      if (!unfit.insert({&phrase, wanted_id}).second) return silence.hold_back();
      Diagnostic& diagnostic =
          reporter.report(Code::P0401, place(role),
                          quoted + " does not denote `" + wanted.name + "` in `" + task.name + "`");
      diagnostic.label(phrase.text.span, "means `" + phrase.means_text + "`");
      const std::string lack =
          lack_of(model, phrase.means, wanted, [](const QueryOp&) { return Truth::kUnknown; });
      if (!lack.empty()) diagnostic.note(lack);
      return;
    }
    const bool is_sure = !meant.sure.empty();
    const std::vector<ObjectId>& rivals = is_sure ? meant.sure : meant.perhaps;
    if (rivals.empty()) return check_looks(role, phrase.text.text, wanted_id);
    std::string names;
    for (const ObjectId id : rivals)
      names += (names.empty() ? "`" : ", `") + model.objects[id].name + "`";
    const Object& first = model.objects[rivals.front()];
    Diagnostic& diagnostic =
        is_sure ? reporter.report(Code::P0402, rivalry(role, rivals.front()),
                                  quoted + " denotes " + std::to_string(rivals.size() + 1) +
                                      " objects in `" + task.name + "`")
                : reporter.report(Code::P0403, rivalry(role, rivals.front()),
                                  quoted + " may also denote " + names + " in `" + task.name + "`");
    diagnostic.point("also `" + phrase.means_text + "`: " + names)
        .label(phrase.text.span, "meant for `" + wanted.name + "`");
    if (diagnostic.primary != place(role)) diagnostic.label(place(role), "said here");
    const std::string hint = discriminator(wanted, first);
    if (!hint.empty()) {
      diagnostic.help("`" + hint + "` holds for `" + wanted.name + "` and not for `" + first.name +
                      "`");
    }
  }

  // Words that no other object fits or is called, and an object that looks as the one that is meant
  // does: whoever sees the two cannot tell which they are for.
  void check_looks(RoleId role, const std::string& words, ObjectId wanted_id) const {
    for (const ObjectId id : rivals_of(role, wanted_id, task.objects())) {
      if (id == wanted_id || !look_alike(model, wanted_id, id)) continue;
      if (clash(model.objects[wanted_id].text.text, model.objects[id].text.text) !=
          NameClash::kNone)
        continue;  // told of the name
      Diagnostic& diagnostic = reporter.report(
          Code::P0405, rivalry(role, id),
          "`" + model.objects[id].name + "` looks as `" + model.objects[wanted_id].name +
              "` does in `" + task.name + "`: \"" + words + "\" may be either");
      diagnostic.help("say where it is by a `spatial` phrase, or let them look different");
      return;
    }
  }

  // "start 7: coke at (7.5cm, 0cm), plate at (-7.5cm, 0cm)".
  std::string drawn(std::size_t start) const {
    std::string text;
    for (const Start::Placed& placed : task.starts[start].placed)
      text += (text.empty() ? "" : ", ") + at(model.objects[placed.object], placed);
    return "start " + std::to_string(start) + ": " + text;
  }

  // What the words lack in a start, or what else they denote there.
  void tell_why(const Phrase& phrase, ObjectId wanted, std::size_t start,
                Diagnostic& diagnostic) const {
    const std::vector<ObjectId> here = denotable(model, task);
    for (const QueryOp& op : phrase.means) {
      if (op.kind != QueryOp::kRelation) continue;
      for (const ObjectId other : op.to) {
        if (other == ObjectId::kNone || std::ranges::find(here, other) != here.end()) continue;
        diagnostic.note("`" + model.objects[other].name + "` is not in the scene of `" + task.name +
                        "`: nothing is `" + model.predicates[static_cast<PredicateId>(op.a)].name +
                        "` to it");
        return;
      }
    }
    const InStart in_start(relations, task, task.starts[start]);
    const Denotation meant = in_start.denote(phrase, wanted);
    const std::string lack = in_start.lack(phrase, wanted);
    if (!lack.empty()) diagnostic.note(lack);
    std::string names;
    for (const ObjectId id : meant.sure)
      names += (names.empty() ? "`" : ", `") + model.objects[id].name + "`";
    if (names.empty()) return;
    diagnostic.note("there it denotes " + (meant.fits ? names + ", too" : names));
  }

  void check_places(RoleId role, const Phrase& phrase, ObjectId wanted) const {
    const std::size_t mistakes = reporter.diagnostics.error_count();
    const Unclear& found = unclear.find(task, phrase, wanted);
    if (found.count() == 0 || reporter.diagnostics.error_count() != mistakes) return;
    const auto& [code, starts, says] =
        !found.unfit.empty() ? std::tuple(Code::P0401, &found.unfit, "does not denote `")
        : !found.ambiguous.empty()
            ? std::tuple(Code::P0402, &found.ambiguous, "does not denote alone `")
            : std::tuple(Code::P0403, &found.unknown, "cannot be told to denote `");
    const std::string name = model.objects[wanted].name;
    Diagnostic& diagnostic = reporter.report(
        code, place(role),
        "\"" + phrase.text.text + "\" " + says + name + "` in " + std::to_string(starts->size()) +
            " of the " + std::to_string(task.starts.size()) + " starts of `" + task.name + "`");
    diagnostic.point(drawn(starts->front()))
        .label(phrase.text.span, "means `" + phrase.means_text + "`");
    tell_why(phrase, wanted, starts->front(), diagnostic);
    const std::string unsaid = code == Code::P0403 ? unsaid_in(model, task, phrase) : "";
    if (!unsaid.empty()) diagnostic.note(unsaid);
    diagnostic.severity = Severity::kError;  // `where clear` is how such starts are left out
    const std::size_t clear = task.starts.size() - found.count();
    if (clear > 0)
      diagnostic.help("it is clear in " + std::to_string(clear) + " of them: `layout " +
                      model.layouts[task.layout].name + " where clear " + phrase.name + " of " +
                      model.roles[role].name + "` keeps those, in its baseline, too");
  }

  // With `wanted`, the objects that it has to be told apart from: those that are said in one breath
  // with it have not.
  std::vector<ObjectId> rivals_of(RoleId role, ObjectId wanted,
                                  std::vector<ObjectId> objects) const {
    std::erase_if(objects, [&](ObjectId id) {
      return id != wanted && model.roles[role].is_set && task.role_of(id) == role;
    });
    return objects;
  }

  // A region is called as the part that it belongs to.
  static bool is_of(const Object& region, const Object& part) {
    return region.of && part.of && region.of->fixture == part.of->fixture &&
           region.of->part == part.of->part;
  }

  void check_name(RoleId role, ObjectId wanted_id) const {
    const Object& wanted = model.objects[wanted_id];
    std::vector<ObjectId> objects = task.objects();
    for (const ObjectId part : parts_in_scene(model, task)) objects.push_back(part);
    for (const ObjectId id : rivals_of(role, wanted_id, std::move(objects))) {
      if (id == wanted_id || is_of(wanted, model.objects[id])) continue;
      const std::string& other = model.objects[id].text.text;
      const std::string& name = wanted.text.text;
      const NameClash found = clash(name, other);
      if (found == NameClash::kNone) continue;
      reporter.report(
          Code::P0405, rivalry(role, id),
          found == NameClash::kSame
              ? "two objects of `" + task.name + "` are called \"" + name + "\""
              : "\"" + name + "\" is part of the name \"" + other + "\" in `" + task.name + "`");
    }
    check_looks(role, wanted.text.text, wanted_id);
  }

  void check_category(const SlotRef& slot, const Object& object) const {
    if (!slot.category) return;
    const CategoryFit fit = fits_category(model, object, slot.category->text);
    if (fit == CategoryFit::kYes) return;
    if (fit == CategoryFit::kNoAttribute) {
      reporter.report(Code::P0407, slot.category->span, "there is no attribute `category`");
      return;
    }
    reporter
        .report(Code::P0407, task.place(task.say_span),
                "`" + object.name + "` is no `" + slot.category->text + "`")
        .label(slot.span, "this slot wants one");
  }

  // The source is what is to be moved, and the target is avoided only where the goal moves with it.
  bool check_avoided(const SlotRef& slot) const {
    const auto is = [&](RoleId role, ObjectId id) {
      return slot.role == role ||
             (id != ObjectId::kNone && slot.name.text == model.objects[id].name);
    };
    if (is(RoleId::kSource, task.source)) {
      report_of(reporter, Situation::kAvoidsSource, task, slot.span,
                "the source cannot be the object to avoid");
      return false;
    }
    if (!is(RoleId::kTarget, task.target) || task.baseline == TaskId::kNone) return true;
    const Task& baseline = model.tasks[task.baseline];
    if (!baseline.complete || baseline.abstract || has_negation(model.templates[baseline.say]) ||
        plan::moves(task.axes, plan::Axis::kGoal))
      return true;
    report_of(
        reporter, Situation::kAvoidsTarget, task, slot.span,
        "`" + task.name + "` says to avoid the target and is judged as `" + baseline.name + "` is")
        .help("change the goal with the words, or avoid a distractor");
    return false;
  }

  // What fits instead.
  std::string count_advice(const SlotRef& slot, std::size_t number, bool is_noun) const {
    using syntax::SlotCount;
    const std::string& goods = slot.name.text;
    const std::string lists = "`{the " + goods + "}`, which lists them";
    if (is_noun) return "say " + lists + ", or take the other one out of the scene";
    if (slot.count == SlotCount::kOther)
      return "name all but one of them before it, or say " + lists;
    if (number < 2) return "say `{the " + goods + "}`";
    std::string word(number_word(number));
    const std::string counted = number == 2 ? "both " + goods : "all " + word + " " + goods;
    if (word.empty()) return "say " + lists;
    return "of " + word + " one says `{" + counted + "}`, or " + lists;
  }

  // Words that count, held against how many there are: of the role, and in the scene where one noun
  // stands for all.
  bool check_count(const SlotRef& slot, const std::vector<ObjectId>& meant) const {
    using syntax::SlotCount;
    const Template& say = model.templates[task.say];
    const Counted counted = count_of(model, task, say, slot);
    if (counted.fit == CountFit::kYes) return true;
    const std::size_t number = task.objects_in(slot.role).size();
    const std::string of_role = "`" + slot.name.text + "` of `" + task.name + "` is " +
                                std::to_string(number) + (number == 1 ? " object" : " objects");
    const bool is_noun = counted.fit == CountFit::kNoun;
    std::string why = "the words count otherwise: " + of_role;
    if (slot.count == SlotCount::kOther)
      why = "\"the other\" is one: " + of_role + ", of which " + std::to_string(meant.size()) +
            " were not said before";
    if (is_noun)
      why = "`" + model.objects[counted.other].name + "` of `" + task.name +
            "` is called so, too, and is not of `" + slot.name.text + "`";
    Diagnostic& said = reporter.report(Code::P1104, task.place(task.say_span), std::move(why));
    said.label(slot.span, "these words");
    if (is_noun)
      said.label(entry_of(task, counted.other).value_or(task.span), "it is in the scene");
    said.help(count_advice(slot, number, is_noun));
    return false;
  }

  // "both {the goods}" of three: words before the slot that count what it lists.
  bool check_written_count(const SlotRef& slot) const {
    if (!model.roles[slot.role].is_set || slot.count != syntax::SlotCount::kPlain) return true;
    std::string before;
    for (const Template::Part& part : model.templates[task.say].parts) {
      if (part.slot && part.slot->span == slot.span) break;
      before = part.literal;  // of a slot empty
    }
    const std::size_t number = task.objects_in(slot.role).size();
    const std::size_t said = count_at_end(before);
    if (said == 0 || said == number) return true;
    reporter
        .report(Code::P1104, task.place(task.say_span),
                "the words count otherwise: `" + slot.name.text + "` of `" + task.name + "` is " +
                    std::to_string(number) + (number == 1 ? " object" : " objects"))
        .label(slot.span, "these words")
        .help(count_advice(slot, number, false));
    return false;
  }

  void absent_fixture(const SlotRef& slot, const std::string& what,
                      const std::string& fixture) const {
    report_of(reporter, Situation::kAbsentSlot, task, slot.span,
              what + " is not in the scene of `" + task.name + "`")
        .help("a scene names its fixtures: `fixture " + fixture + "`");
  }

  void check_fixture_slot(const SlotRef& slot, FixtureId id) const {
    const auto& here = model.scenes[task.scene].fixtures;
    if (std::ranges::find(here, id) != here.end()) return;
    if (task.keeps_absent && !task.allow_absent) return;
    absent_fixture(slot, "fixture `" + model.fixtures[id].name + "`", model.fixtures[id].name);
  }

  void check_slot(const SlotRef& slot) const {
    if (slot.avoid && !check_avoided(slot)) return;
    if (slot.role != RoleId::kNone) {
      const std::vector<ObjectId> meant = meant_by(model, task, model.templates[task.say], slot);
      if (!check_count(slot, meant) || !check_written_count(slot)) return;
      for (const ObjectId id : meant) {
        check_category(slot, model.objects[id]);
        const Referring words = referring(model, task, id);
        if (words.phrase != nullptr) {
          check_phrase(slot.role, *words.phrase, id);
        } else {
          check_name(slot.role, id);
        }
      }
      return;
    }
    if (const auto fixture = fixture_of(model, slot)) return check_fixture_slot(slot, *fixture);
    for (const ObjectId id : task.objects()) {
      const Object& object = model.objects[id];
      if (object.name == slot.name.text) return check_category(slot, object);
    }
    const auto& objects = model.objects;
    const auto missing = std::find_if(objects.begin(), objects.end(), [&](const Object& known) {
      return known.name == slot.name.text;
    });
    if (missing == objects.end()) return;  // no object at all, which was reported
    if (task.keeps_absent && !task.allow_absent) return;
    const Object& object = *missing;
    if (object.of) {
      const auto& here = model.scenes[task.scene].fixtures;
      if (std::ranges::find(here, object.of->fixture) != here.end())
        return check_category(slot, object);
      const std::string& fixture = model.fixtures[object.of->fixture].name;
      absent_fixture(slot, "\"" + object.text.text + "\" names a part of `" + fixture + "`, which",
                     fixture);
      return;
    }
    const std::string words = (slot.avoid ? "not " : "") +
                              std::string(slot.the && !object.bare ? "the " : "") +
                              object.text.text;
    Diagnostic& diagnostic = report_of(
        reporter, Situation::kAbsentSlot, task, slot.span,
        "\"" + words + "\" names an object that is not in the scene of `" + task.name + "`");
    const std::string other =
        task_with(objects.id(static_cast<std::size_t>(missing - objects.begin())));
    diagnostic.point("the scene has " + objects_text(model, task))
        .help("add `distractors " + slot.name.text + "`" +
              (other.empty() ? "" : ", or derive from `" + other + "`"));
    // Only a warning can be silenced: a suite that was published like this says so.
    if (task.allow_absent) diagnostic.severity = Severity::kWarning;
  }

  // A task like this one in which the object is there as well; empty when there is none.
  std::string task_with(ObjectId wanted) const {
    for (const Task& other : model.tasks) {
      if (other.abstract || !other.complete || other.source != task.source ||
          other.target != task.target || other.scene != task.scene)
        continue;
      const std::vector<ObjectId> objects = other.objects();
      if (std::find(objects.begin(), objects.end(), wanted) != objects.end()) return other.name;
    }
    return {};
  }

  void check_sentence() const {
    const PromptFault fault = fault_of_prompt(task.prompt);
    if (fault == PromptFault::kNone) return;
    const Span& span = task.place(task.say_span);
    const std::string of_task = "the instruction of `" + task.name + "`";
    switch (fault) {
      case PromptFault::kNone:
        return;
      case PromptFault::kNoWords:
        if (is_control(model.templates[task.say])) return;
        reporter.report(Situation::kNoWords, span,
                        of_task + (task.prompt.empty() ? " is empty" : " has no words"));
        return;
      case PromptFault::kTooLong:
        reporter.report(Situation::kPromptTooLong, span,
                        of_task + " is longer than " + std::to_string(kMaxPromptBytes) + " bytes");
        return;
      case PromptFault::kBraces:
        reporter.report(Situation::kBraces, span,
                        "braces are left in the instruction of `" + task.name + "`");
        return;
      case PromptFault::kForm:
        reporter.report(Situation::kPromptForm, span, of_task + " " + defect_of(task.prompt));
        return;
    }
  }
};

// Whoever hears one sentence twice in turn cannot know that it came again.
void check_turns(const Task& task, Reporter& reporter) {
  for (std::size_t i = 0; i < task.later.size(); ++i) {
    const std::string& before = i == 0 ? task.prompt : task.later[i - 1].text;
    if (task.later[i].text != before) continue;
    reporter
        .report(Situation::kSaidAgain, task.place(task.later[i].say_span),
                "`" + task.name + "` says \"" + before + "\" twice in turn")
        .help("a sentence that is repeated changes nothing: leave one out");
  }
}

}  // namespace

void check_phrases(const Model& model, const AssetRoot& asset_root, Reporter& reporter) {
  Unfit unfit;
  Relations relations(model, asset_root, reporter.diagnostics);
  UnclearStarts unclear(model, relations);
  Silence silence(model, reporter, Silent::kPhrases);
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete || silence.is_known(task)) continue;
    const About about(reporter, task.decl_span);
    // A second slot of one name says nothing new, unless it counts; in a later sentence, either.
    std::set<std::tuple<std::string, bool, syntax::SlotCount>> checked;
    for_each_telling(task, [&](const Task& told) {
      const TaskLanguage check{model, reporter, told, unfit, relations, unclear, silence};
      for (const Template::Part& part : model.templates[told.say].parts) {
        if (part.slot &&
            checked.insert({part.slot->name.text, part.slot->avoid, part.slot->count}).second)
          check.check_slot(*part.slot);
      }
      check.check_sentence();
    });
    check_turns(task, reporter);
  }
}

}  // namespace probe::sema
