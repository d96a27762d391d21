// Free answers that restate an instruction: which objects they mention, in which roles, by whose
// words, and how much of the instruction they repeat. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/ask/reading/read_answer.h"

namespace probe::ask {

enum class MentionRole : std::uint8_t {
  kUnmarked,  // named, with no word that says as what: "the carrot goes ..."
  kMoved,     // behind a verb of moving: "pick up the carrot"
  kGoal,      // behind a word of place, or before a verb of holding: "on the plate"
  kAvoided,   // behind a denial in its clause, or said to be left alone: "not the towel"
  kAside,     // where something comes from, or beside what is avoided in one clause
};
std::string_view word_of(MentionRole role);

// Whose words a mention is in.
enum class MentionWords : std::uint8_t {
  kPlain,        // the plain name, or its last word where no other option has it
  kInstruction,  // another phrase, as the instruction has it
  kOther,        // another phrase that the instruction does not have
};
std::string_view word_of(MentionWords words);

struct Mention {
  std::uint32_t option = 0;  // of the question's options
  MentionRole role = MentionRole::kUnmarked;
  MentionWords words = MentionWords::kPlain;
  bool operator==(const Mention&) const = default;
};

struct RestateContext {
  std::span<const ShownOption> options = {};
  // Of the question's options: what is moved, and where to; none: nothing has to be mentioned so.
  std::optional<std::uint32_t> source = {}, target = {};
  std::string_view instruction = {};
};

struct Restatement {
  Reading reading;                // as read_answer's of a free question
  std::vector<Mention> mentions;  // in the order of the text
  bool right = false;
  std::string_view wrong_by = {};  // why it is not right; empty when it is, or was not read
  double copied = 0;               // share_copied of the whole answer
};

// Right is an answer that
// - mentions the source as what is moved (or unmarked) and the target as the goal, each by its
//   plain name; where the instruction itself uses the plain name, any words that denote it will do.
//   A phrase that the instruction uses instead of the name is no mention: who repeats "rabbit's
//   favorite vegetable" has not said which object that is;
// - mentions neither in the other's role, nor as what to avoid;
// - mentions nothing else but as what to avoid;
// - says to put it there, in whatever words of the task's frame, or nothing but "carrot on plate";
//   asks nothing, and goes on to no other place.
Restatement restate(const RestateContext& context, std::string_view raw,
                    std::string_view finish = {});

// The share, 0 .. 1, of the instruction's own words that stand in the answer: its words, each
// once, without articles, prepositions and the like (a table) and without the words of the plain
// names of source and target, which every right answer has. Of an instruction that has no others
// all words but articles count. A copy has 1, "put the carrot on the plate" for "put rabbit's
// favorite vegetable on the plate" 1/4.
double share_copied(const RestateContext& context, std::string_view answer);

}  // namespace probe::ask
