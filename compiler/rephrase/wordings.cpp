#include "compiler/rephrase/wordings.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "compiler/define/denote.h"
#include "compiler/define/template.h"
#include "compiler/define/thing.h"
#include "compiler/define/wording.h"
#include "compiler/rephrase/draw.h"
#include "runtime/base/utf8.h"

namespace probe::rephrase {

using sema::Model;
using sema::ObjectId;
using sema::Phrase;
using sema::Task;
using sema::Template;
using sema::TemplateId;

// One way to call an object: by a phrase, or by its name.
struct Prover::Choice {
  const Phrase* phrase = nullptr;
  std::optional<Refusal> refused;
};

namespace {

// The object of a slot; one that fills a role is that role, however the text names it.
std::string role_of(const Model& model, const Task& task, const std::string& slot) {
  return sema::role_word(model, task, slot);
}

std::set<std::string> wanted_by(const Model& model, const Task& task, const Template& say) {
  std::set<std::string> wanted;
  for (const Template::Part& part : say.parts) {
    if (part.slot && !part.slot->avoid) wanted.insert(role_of(model, task, part.slot->name.text));
  }
  return wanted;
}

std::set<Forbidden> forbidden_by(const Model& model, const Task& task, const Actions& actions,
                                 TemplateId say) {
  std::set<Forbidden> forbidden;
  for (const Forbidden& thing : actions.forbidden(say))
    forbidden.insert({role_of(model, task, thing.first), thing.second});
  return forbidden;
}

bool mentions_role(const Template& say, std::string_view role) {
  return std::any_of(say.parts.begin(), say.parts.end(), [&](const Template::Part& part) {
    return part.slot && part.slot->name.text == role;
  });
}

// What rendering and comparing ask of a task, without its starts and metrics.
Task words_alone(const Task& task) {
  Task words;
  words.name = task.name;
  words.scene = task.scene;
  words.source = task.source;
  words.target = task.target;
  words.others = task.others;
  words.declared_objects = task.declared_objects;
  words.distractors = task.distractors;
  words.part_distractors = task.part_distractors;
  words.placed = task.placed;
  words.say = task.say;
  words.refer = task.refer;
  return words;
}

// Which of `count` combinations are made: all, or as many as are drawn, in their order.
std::vector<std::uint64_t> drawn(std::uint64_t count, std::uint64_t seed, const std::string& task) {
  std::vector<std::uint64_t> all;
  if (count <= kMostEnumerated) {
    for (std::uint64_t i = 0; i < count; ++i) all.push_back(i);
    return all;
  }
  std::set<std::uint64_t> some;
  for (std::uint64_t at = 0; some.size() < kMostDrawn; ++at)
    some.insert(draw("candidate", seed, task, std::to_string(at)) % count);
  return {some.begin(), some.end()};
}

}  // namespace

namespace {

std::optional<Refusal> why_unclear(const sema::Denotation& meant) {
  if (!meant.may_fit) return Refusal::kNotMeant;
  if (!meant.sure.empty()) return Refusal::kAmbiguous;
  if (!meant.fits || !meant.perhaps.empty()) return Refusal::kUnknown;
  return std::nullopt;
}

}  // namespace

Prover::Prover(const Model& model, AssetRoot asset_root)
    : model_(model),
      actions_(model),
      mentions_(model),
      relations_(model, std::move(asset_root), unsaid_) {}

// Of words that say where things are: the first reason of refusals.def that some start gives.
std::optional<Refusal> Prover::why_not_there(const Task& task, ObjectId wanted,
                                             const Phrase& phrase) {
  std::optional<Refusal> first;
  for (const sema::Start& start : task.starts) {
    const auto why = why_unclear(sema::InStart(relations_, task, start).denote(phrase, wanted));
    if (why && (!first || *why < *first)) first = why;
  }
  return first;
}

std::optional<Refusal> Prover::why_no_phrase(const Task& task, ObjectId wanted,
                                             const Phrase& phrase) {
  const std::vector<ObjectId> objects = sema::denotable(model_, task);
  const auto why = phrase.is_spatial() ? why_not_there(task, wanted, phrase)
                                       : why_unclear(sema::denote(model_, objects, phrase, wanted));
  if (why) return why;
  // Its words may name an object themselves: "juice squeezed from orange".
  Template alone;
  alone.parts.push_back({"put the " + phrase.text.text + " on it", std::nullopt});
  for (const ObjectId named : mentions_.in(alone)) {
    if (fold_case(model_.objects[named].text.text) == fold_case(model_.objects[wanted].text.text))
      continue;
    return mentions_.is_absent(task, named) ? Refusal::kAbsent : Refusal::kName;
  }
  return std::nullopt;
}

std::vector<Prover::Choice> Prover::choices(const Task& task, bool is_source, bool is_said) {
  const ObjectId wanted = is_source ? task.source : task.target;
  if (wanted == ObjectId::kNone) return std::vector<Choice>(1);
  const sema::Object& object = model_.objects[wanted];
  std::vector<Choice> all(1);
  if (!is_said) return all;
  const auto clashes = [&](const std::string& words) {
    const std::vector<ObjectId> objects = task.objects();
    return std::any_of(objects.begin(), objects.end(), [&](ObjectId id) {
      return id != wanted &&
             sema::clash(words, model_.objects[id].text.text) != sema::NameClash::kNone;
    });
  };
  if (clashes(object.text.text)) all[0].refused = Refusal::kName;
  for (const Phrase& phrase : object.phrases) {
    Choice& choice = all.emplace_back();
    choice.phrase = &phrase;
    choice.refused = why_no_phrase(task, wanted, phrase);
    if (!choice.refused && clashes(phrase.text.text)) choice.refused = Refusal::kName;
  }
  return all;
}

// Words of a sentence that turn what it asks for round, take it back or go on to something else.
// Those of a rewording are those of the instruction: nothing else knows what their author means.
// What an instruction forbids is compared by its slots, so that denials are free beside them.
std::set<std::string> turns(const Template& say) {
  static const std::set<std::string, std::less<>> kDenials = {
      "not",       "don't",   "dont",   "never",   "no",     "nothing", "nowhere",
      "anywhere",  "but",     "except", "besides", "avoid",  "nor",     "without",
      "elsewhere", "instead", "can't",  "won't",   "rather", "cannot",  "neither"};
  static const std::set<std::string, std::less<>> kOthers = {
      "unless", "refuse", "stop",   "pretend", "imagine", "remove", "undo",   "fail",
      "almost", "nearly", "hardly", "barely",  "partly",  "half",   "halfway"};
  // Of how it is to lie there, or how many of them: more than anybody proved.
  static const auto kPhrases = std::to_array<std::string_view>(
      {"upside down", "on its side", "two of", "three of", "several of", "some of", "both of",
       "each of", "most of", "part of"});
  // Behind the last object; between two it only says in which order they are thought of.
  static const std::set<std::string, std::less<>> kGoingOn = {"then", "afterwards", "before",
                                                              "until"};
  const bool is_free = sema::has_negation(say);
  std::set<std::string> found, going_on;
  std::string sentence = " ";
  for (std::string word : sema::sentence_of(say)) {
    sentence += word + " ";
    for (std::size_t at; (at = word.find("\u2019")) != word.npos;) word.replace(at, 3, "'");
    if (word.starts_with('{')) going_on.clear();
    if (kGoingOn.contains(word)) going_on.insert(word);
    if (kOthers.contains(word) || (!is_free && kDenials.contains(word))) found.insert(word);
  }
  for (const std::string_view phrase : kPhrases) {
    if (sentence.find(" " + std::string(phrase) + " ") != sentence.npos) found.emplace(phrase);
  }
  found.merge(going_on);
  return found;
}

// Whether words of a template are proved to ask the same of the task as its own, whatever its
// objects are called.
std::optional<Refusal> Prover::why_not(const Task& task, TemplateId say) {
  if (say == task.say) return std::nullopt;
  if (const auto other = actions_.why_other(task.say, say)) return other;
  const Template& own = model_.templates[task.say];
  const Template& words = model_.templates[say];
  if (sema::is_control(own) || sema::is_control(words)) return Refusal::kFrame;
  if (wanted_by(model_, task, own) != wanted_by(model_, task, words)) return Refusal::kRoles;
  if (!sema::fills_all(task, words)) return Refusal::kRoles;
  for (const Template::Part& part : words.parts) {
    if (!part.slot) continue;
    const sema::CountFit fit = sema::count_of(model_, task, words, *part.slot).fit;
    if (fit == sema::CountFit::kNumber) return Refusal::kRoles;
    if (fit == sema::CountFit::kNoun) return Refusal::kAmbiguous;
  }
  if (forbidden_by(model_, task, actions_, task.say) != forbidden_by(model_, task, actions_, say))
    return Refusal::kNegation;
  std::vector<ObjectId> named = mentions_.in(say), said = mentions_.in(task.say);
  for (const ObjectId object : named) {
    const bool is_said = std::find(said.begin(), said.end(), object) != said.end();
    if (!is_said && mentions_.is_absent(task, object)) return Refusal::kAbsent;
  }
  std::sort(named.begin(), named.end());
  std::sort(said.begin(), said.end());
  if (named != said) return Refusal::kRoles;
  if (turns(own) != turns(words)) return Refusal::kNegation;
  Task other = words_alone(task);
  other.say = say;
  if (sema::contradicts(model_, other, task)) return Refusal::kContradicts;
  for (const Template::Part& part : words.parts) {
    if (!part.slot || !part.slot->category) continue;
    const std::string role = role_of(model_, task, part.slot->name.text);
    for (const ObjectId id : task.objects()) {
      const sema::RoleId filled = task.role_of(id);
      const bool fills = role == model_.objects[id].name ||
                         (filled != sema::RoleId::kNone && role == model_.roles[filled].name);
      if (fills && sema::fits_category(model_, model_.objects[id], part.slot->category->text) !=
                       sema::CategoryFit::kYes)
        return Refusal::kCategory;
    }
  }
  return std::nullopt;
}

Proved Prover::prove(const Task& task, std::uint64_t seed) {
  Proved proved;
  // A wording stands for all that is said, and one sentence of several is not.
  if (!task.later.empty()) return proved;
  const Template& own = model_.templates[task.say];
  const std::vector<Choice> sources = choices(task, true, mentions_role(own, "source"));
  const std::vector<Choice> targets = choices(task, false, mentions_role(own, "target"));
  const std::uint64_t pairs = sources.size() * targets.size();

  std::vector<TemplateId> templates;
  for (std::size_t i = 0; i < model_.templates.size(); ++i) {
    const TemplateId say = model_.templates.id(i);
    // Words on the spot are those of their own task.
    if (say != task.say && model_.templates[say].name.empty()) continue;
    proved.candidates += pairs;
    if (const auto why = why_not(task, say)) {
      proved.refused[*why] += pairs;
    } else {
      templates.push_back(say);
    }
  }
  std::vector<std::pair<const Phrase*, const Phrase*>> called;
  for (const Choice& source : sources) {
    for (const Choice& target : targets) {
      const auto& why = source.refused ? source.refused : target.refused;
      if (why) {
        proved.refused[*why] += templates.size();
      } else {
        called.emplace_back(source.phrase, target.phrase);
      }
    }
  }

  const std::uint64_t count = templates.size() * called.size();
  const std::vector<std::uint64_t> made = drawn(count, seed, task.name);
  proved.not_drawn = count - made.size();
  std::set<std::string> known = {task.prompt};
  Task words = words_alone(task);
  const auto set_refer = [&words](sema::RoleId role, const Phrase* phrase) {
    words.refer.erase(role);
    if (phrase != nullptr) words.refer[role] = {phrase->name, phrase->text.span};
  };
  for (const std::uint64_t at : made) {
    const auto& [source, target] = called[at % called.size()];
    words.say = templates[at / called.size()];
    words.refer = task.refer;
    set_refer(sema::RoleId::kSource, source);
    set_refer(sema::RoleId::kTarget, target);
    std::string text = sema::render_prompt(model_, words);
    if (sema::fault_of_prompt(text) != sema::PromptFault::kNone) {
      ++proved.refused[Refusal::kForm];
    } else if (!known.insert(text).second) {
      ++proved.same_words;
    } else {
      proved.wordings.push_back({std::move(text), words.say, source, target});
    }
  }
  return proved;
}

}  // namespace probe::rephrase
