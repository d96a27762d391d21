// Templates of instructions, and the slots inside a string: "put {the source} on {target:
// dishware}".
#include "compiler/syntax/braces.h"

namespace probe::syntax {
namespace {

// 0 for a word that is no number from two to twelve.
std::uint32_t number_of_word(std::string_view word) {
  constexpr std::string_view kWords[] = {"two",   "three", "four", "five",   "six",   "seven",
                                         "eight", "nine",  "ten",  "eleven", "twelve"};
  for (std::uint32_t i = 0; i < std::size(kWords); ++i) {
    if (kWords[i] == word) return i + 2;
  }
  return 0;
}

// What is wrong with it; empty when `slot` could be read.
std::string read_slot(BraceWords& words, Slot& slot) {
  Name word;
  if (!words.take_word(word)) return "a name";
  if (word.text == "avoid" && words.is_word_next()) {
    slot.avoid = true;
    words.take_word(word);
  }
  if (word.text == "the" && words.is_word_next()) {
    slot.the = true;
    words.take_word(word);
  }
  if (words.is_word_next()) {
    slot.count = word.text == "both"                ? SlotCount::kBoth
                 : word.text == "all"               ? SlotCount::kAll
                 : slot.the && word.text == "other" ? SlotCount::kOther
                                                    : SlotCount::kPlain;
    if (slot.count != SlotCount::kPlain) words.take_word(word);
  }
  if (slot.count == SlotCount::kAll && words.is_word_next()) {
    slot.number = number_of_word(word.text);
    if (slot.number == 0) return "a number such as `three`";
    words.take_word(word);
  }
  slot.name = word;
  if (Name part; words.take('.')) {  // of a fixture, as one name
    if (!words.take_word(part)) return "a part";
    slot.name.span = join(word.span, part.span);
    slot.name.text = {
        word.text.data(),
        static_cast<std::size_t>(part.text.data() + part.text.size() - word.text.data())};
  }
  if (words.take(':')) {
    Name category;
    if (!words.take_word(category)) return "a category after `:`";
    slot.category = category;
  }
  return words.is_at_end() ? "" : "`}`";
}

}  // namespace

DeclNode Parser::template_decl() {
  advance();
  TemplateDecl out;
  out.name = name();
  out.frame = optional_name_after("frame");
  out.text = template_text();
  return out;
}

TemplateText Parser::template_text() {
  TemplateText out;
  out.text = string();
  braced_text<Slot>(out.text, out.parts, "a slot",
                    "a slot is `{source}`, `{the target}`, `{both goods}`, `{all three goods}`, "
                    "`{avoid the plate}` or "
                    "`{source: drink}`",
                    read_slot);
  return out;
}

}  // namespace probe::syntax
