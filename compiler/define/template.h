// Instructions: their parts, the words they choose for an object, and their rendering.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/names/context.h"

namespace probe::sema {

// `frame` absent: the first word of the text is the verb frame. Frames have no case.
TemplateId add_template(Context& context, const syntax::TemplateText& text, std::string name,
                        const Span& span, const std::optional<syntax::Name>& frame);

// The words for one object of one task: the phrase that is chosen for its role, or its name.
struct Referring {
  const std::string* text = nullptr;
  bool bare = false;
  const Phrase* phrase = nullptr;  // null: the name
};
Referring referring(const Model& model, const Task& task, ObjectId object);
// Of a role that one object fills; no text where nothing fills it.
Referring referring(const Model& model, const Task& task, RoleId role);

// The fixture with joints that a slot names: `{the cabinet}`. It has no role, and no name but that
// of its declaration.
std::optional<FixtureId> fixture_of(const Model& model, const SlotRef& slot);

// Whom a slot means in a task: what fills its role, of `{the other goods}` what no slot before it
// means, or the object that it names. None where it names what does not exist.
std::vector<ObjectId> meant_by(const Model& model, const Task& task, const Template& say,
                               const SlotRef& slot);

// "two" to "twelve"; empty of other numbers.
std::string_view number_word(std::size_t number);

// What counted words say of several objects: one noun that all their words end with, in the
// plural; nothing where they have none in common.
std::optional<std::string> common_noun(const std::vector<std::string>& words);

// Whether words that count fit a task.
enum class CountFit : std::uint8_t {
  kYes,
  kNumber,  // the role has more objects, or fewer
  kNoun,    // their one noun means another object of the scene, too: `other`
};
struct Counted {
  CountFit fit = CountFit::kYes;
  ObjectId other = ObjectId::kNone;
};
Counted count_of(const Model& model, const Task& task, const Template& say, const SlotRef& slot);

// The same of all of its words.
bool counts_fit(const Model& model, const Task& task, const Template& say);

// Whether every role that the words speak of is filled in the task.
bool fills_all(const Task& task, const Template& say);

// Slots that name an object which does not exist print nothing; which was reported.
std::string render_prompt(const Model& model, const Task& task);

// Why no policy can be told a text; `defect_of` (names/texts.h) says which character has no place
// in it.
enum class PromptFault : std::uint8_t { kNone, kNoWords, kTooLong, kBraces, kForm };
inline constexpr std::size_t kMaxPromptBytes = 1000;
PromptFault fault_of_prompt(std::string_view prompt);

}  // namespace probe::sema
