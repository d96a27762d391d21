// `template`, and words on the spot: what is said, and how it is printed for a task.
#include "compiler/define/template.h"

#include <algorithm>
#include <array>

#include "compiler/define/define.h"
#include "compiler/define/role.h"
#include "compiler/define/thing.h"
#include "compiler/define/wording.h"
#include "compiler/names/texts.h"
#include "runtime/base/nouns.h"
#include "runtime/base/utf8.h"

namespace probe::sema {

TemplateId add_template(Context& context, const syntax::TemplateText& text, std::string name,
                        const Span& span, const std::optional<syntax::Name>& frame) {
  Template record;
  record.name = std::move(name);
  record.span = span;
  for (const syntax::TemplatePart& part : text.parts) {
    if (const auto* literal = std::get_if<std::string>(&part)) {
      record.parts.push_back({*literal, std::nullopt, words_of(*literal)});
      continue;
    }
    const auto& slot = std::get<syntax::Slot>(part);
    const auto role = find_role(context, slot.name.text);
    const auto fixture = context.symbols.fixtures.peek(slot.name.text);
    const bool is_fixture = !role && fixture && !peek_thing(context, slot.name.text);
    if (!role && !is_fixture && !find_thing(context, slot.name)) record.broken = true;
    if (is_fixture && slot.category) {
      context.report(Code::P0407, slot.category->span,
                     "`" + std::string(slot.name.text) + "` is a fixture, which has no category");
      record.broken = true;
    }
    SlotRef ref{.avoid = slot.avoid,
                .the = slot.the,
                .count = slot.count,
                .number = slot.number,
                .name = spelled(slot.name),
                .role = role.value_or(RoleId::kNone),
                .category = std::nullopt,
                .span = slot.span};
    if (slot.count != syntax::SlotCount::kPlain && !(role && context.model.roles[*role].is_set)) {
      context
          .report(Code::P1104, slot.span,
                  "`" + std::string(slot.name.text) + "` is one, and the words count several")
          .help("`role NAME: set` declares a role that several objects fill");
      record.broken = true;
    }
    if (slot.category) ref.category = spelled(*slot.category);
    record.parts.push_back({{}, std::move(ref)});
  }
  record.frame = frame ? fold_case(frame->text) : first_word(record.parts);
  return context.model.templates.add(std::move(record));
}

Referring referring(const Model& model, const Task& task, ObjectId id) {
  const Object& object = model.objects[id];
  const Spelled* refer = task.refer_of(task.role_of(id));
  const Phrase* phrase = refer != nullptr ? object.find_phrase(refer->text) : nullptr;
  if (phrase != nullptr) return {&phrase->text.text, phrase->bare, phrase};
  return {&object.text.text, object.bare, nullptr};
}

Referring referring(const Model& model, const Task& task, RoleId role) {
  const std::vector<ObjectId> objects = task.objects_in(role);
  return objects.empty() ? Referring() : referring(model, task, objects.front());
}

std::optional<FixtureId> fixture_of(const Model& model, const SlotRef& slot) {
  if (slot.role != RoleId::kNone) return std::nullopt;
  const auto is_it = [&](const auto& known) { return known.name == slot.name.text; };
  if (std::ranges::any_of(model.objects, is_it)) return std::nullopt;
  const auto found = std::ranges::find_if(model.fixtures, is_it);
  if (found == model.fixtures.end()) return std::nullopt;
  return model.fixtures.id(static_cast<std::size_t>(found - model.fixtures.begin()));
}

std::vector<ObjectId> meant_by(const Model& model, const Task& task, const Template& say,
                               const SlotRef& slot) {
  if (slot.role == RoleId::kNone) {
    for (std::size_t i = 0; i < model.objects.size(); ++i) {
      if (model.objects[model.objects.id(i)].name == slot.name.text) return {model.objects.id(i)};
    }
    return {};
  }
  std::vector<ObjectId> meant = task.objects_in(slot.role);
  if (slot.count != syntax::SlotCount::kOther) return meant;
  for (const Template::Part& part : say.parts) {
    if (!part.slot) continue;
    if (part.slot->span == slot.span) break;
    for (const ObjectId said : meant_by(model, task, say, *part.slot)) std::erase(meant, said);
  }
  return meant;
}

namespace {

std::vector<std::string> words_in(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; (at = text.find_first_not_of(' ', at)) < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

// Several objects as one slot says them: "the carrot and the spoon", "both cubes".
std::string words_for(const Model& model, const Task& task, const SlotRef& slot,
                      const std::vector<ObjectId>& objects) {
  using syntax::SlotCount;
  std::vector<std::string> plain, whole;
  for (const ObjectId id : objects) {
    const Referring said = referring(model, task, id);
    plain.push_back(*said.text);
    const bool has_article = (slot.the || slot.count != SlotCount::kPlain) && !said.bare;
    whole.push_back((has_article ? "the " : "") + *said.text);
  }
  const bool are_alike = std::equal(plain.begin() + 1, plain.end(), plain.begin());
  const bool is_counted = slot.count == SlotCount::kBoth || slot.count == SlotCount::kAll;
  const auto noun = is_counted || are_alike ? common_noun(plain) : std::nullopt;
  if (slot.count == SlotCount::kBoth) return "both " + (noun ? *noun : list_of(whole));
  if (!noun) return list_of(whole);
  if (slot.count != SlotCount::kAll) return (slot.the ? "the " : "") + *noun;
  const std::string_view number = number_word(slot.number);
  return "all " + std::string(number) + (number.empty() ? "" : " ") + *noun;
}

// "the other cube", or "the other one" where the objects have no noun in common.
std::string words_for_other(const Model& model, const Task& task, const SlotRef& slot) {
  std::vector<std::string> plain;
  for (const ObjectId id : task.objects_in(slot.role))
    plain.push_back(*referring(model, task, id).text);
  if (plain.size() < 2 || !common_noun(plain)) return "the other one";
  return "the other " + words_in(plain.front()).back();
}

}  // namespace

std::string_view number_word(std::size_t number) {
  constexpr std::array<std::string_view, 13> kNumbers = {"",     "",       "two",   "three", "four",
                                                         "five", "six",    "seven", "eight", "nine",
                                                         "ten",  "eleven", "twelve"};
  return number < kNumbers.size() ? kNumbers[number] : "";
}

std::optional<std::string> common_noun(const std::vector<std::string>& words) {
  if (words.empty()) return std::nullopt;
  std::vector<std::string> common = words_in(words.front());
  // One text is shared whole; of different ones it is their last word.
  const bool are_alike = std::all_of(
      words.begin(), words.end(), [&](const std::string& text) { return text == words.front(); });
  if (!are_alike && common.size() > 1) common = {common.back()};
  for (const std::string& text : words) {
    const std::vector<std::string> own = words_in(text);
    if (own.empty() || common.empty() || own.back() != common.back()) return std::nullopt;
  }
  common.back() = plural_of(common.back());
  std::string text;
  for (const std::string& word : common) text += (text.empty() ? "" : " ") + word;
  return text;
}

Counted count_of(const Model& model, const Task& task, const Template& say, const SlotRef& slot) {
  using syntax::SlotCount;
  const std::vector<ObjectId> filled = task.objects_in(slot.role);
  switch (slot.count) {
    case SlotCount::kPlain:
      return {};
    case SlotCount::kOther:
      return {meant_by(model, task, say, slot).size() == 1 ? CountFit::kYes : CountFit::kNumber};
    case SlotCount::kBoth:
      if (filled.size() != 2) return {CountFit::kNumber};
      break;
    case SlotCount::kAll:
      if (slot.number != 0 ? filled.size() != slot.number : filled.size() < 3)
        return {CountFit::kNumber};
      break;
  }
  // "all three cubes" with a fourth cube in the scene.
  std::vector<std::string> words;
  for (const ObjectId id : filled) words.push_back(*referring(model, task, id).text);
  const auto noun = common_noun(words);
  if (!noun) return {};
  std::vector<ObjectId> others = task.objects();
  // Drawers are told apart from the drawers that are there.
  if (!task.is_object(filled.front())) {
    for (const ObjectId part : parts_in_scene(model, task)) others.push_back(part);
  }
  for (const ObjectId id : others) {
    if (task.role_of(id) == slot.role) continue;
    words.push_back(model.objects[id].text.text);
    if (common_noun(words) == noun) return {CountFit::kNoun, id};
    words.pop_back();
  }
  return {};
}

bool counts_fit(const Model& model, const Task& task, const Template& say) {
  return std::all_of(say.parts.begin(), say.parts.end(), [&](const Template::Part& part) {
    return !part.slot || count_of(model, task, say, *part.slot).fit == CountFit::kYes;
  });
}

bool fills_all(const Task& task, const Template& say) {
  return std::all_of(say.parts.begin(), say.parts.end(), [&](const Template::Part& part) {
    return !part.slot || part.slot->role == RoleId::kNone ||
           !task.objects_in(part.slot->role).empty();
  });
}

std::string render_prompt(const Model& model, const Task& task) {
  std::string prompt;
  const Template& say = model.templates[task.say];
  for (const Template::Part& part : say.parts) {
    prompt += part.literal;
    if (!part.slot) continue;
    const SlotRef& slot = *part.slot;
    const std::vector<ObjectId> meant = meant_by(model, task, say, slot);
    if (meant.empty()) {
      if (!fixture_of(model, slot)) continue;
      std::string name = slot.name.text;
      std::ranges::replace(name, '_', ' ');
      prompt += (slot.the ? "the " : "") + name;
      continue;
    }
    if (slot.count == syntax::SlotCount::kOther) {
      prompt += words_for_other(model, task, slot);
    } else if (meant.size() > 1) {
      prompt += words_for(model, task, slot, meant);
    } else {
      // A role that the words do not refer to is called by its object's name, as by a slot of it.
      const Object& object = model.objects[meant.front()];
      const Referring words = slot.role == RoleId::kNone
                                  ? Referring{&object.text.text, object.bare, nullptr}
                                  : referring(model, task, meant.front());
      if (slot.the && !words.bare) prompt += "the ";
      prompt += *words.text;
    }
  }
  return prompt;
}

PromptFault fault_of_prompt(std::string_view prompt) {
  if (is_blank(prompt)) return PromptFault::kNoWords;
  if (prompt.size() > kMaxPromptBytes) return PromptFault::kTooLong;
  if (prompt.find('{') != prompt.npos || prompt.find('}') != prompt.npos) return PromptFault::kBraces;
  return defect_of(prompt).empty() ? PromptFault::kNone : PromptFault::kForm;
}

void define_templates(Context& context) {
  for (const auto& declared : context.symbols.template_decls) {
    const syntax::TemplateDecl& node = *declared.node;
    const TemplateId id = add_template(context, node.text, std::string(node.name.text),
                                       node.text.text.span, node.frame);
    if (!declared.decl->complete) context.model.templates[id].broken = true;
  }
}

}  // namespace probe::sema
