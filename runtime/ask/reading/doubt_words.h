// Words and signs that speak against an answer, wherever it stands: the one table of them.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "runtime/ask/reading/answer_text.h"

namespace probe::ask {

enum class Against : std::uint8_t {
  kDenies,   // "not", "nobody"
  kRejects,  // says of something that it is not the one: "wrong", "a distractor", "discard"
  kDoubts,   // "perhaps", "at first glance"
  kTurns,    // takes back what was said: "however", "oops"
};

// What the word or phrase that begins at `at` does, of one of `kinds`; false where it is harmless
// ("I cannot be sure").
bool is_against(std::span<const Token> tokens, std::size_t at, std::span<const Against> kinds);
// The same of any kind, anywhere.
bool has_against(std::span<const Token> tokens);
bool has_against(std::span<const Token> tokens, std::span<const Against> kinds);
// Whether the word begins or ends a phrase that denies nothing although it looks so ("or not").
bool is_harmless(std::span<const Token> tokens, std::size_t at);

inline constexpr Against kDenials[] = {Against::kDenies};
inline constexpr Against kRejections[] = {Against::kRejects};
inline constexpr Against kSaysNot[] = {Against::kDenies, Against::kRejects};
inline constexpr Against kTakesBack[] = {Against::kDoubts, Against::kTurns};

// Whether a sign in the text denies or strikes out: a cross, "!=", \cancel, ~~, <del>. Of a text in
// plain form.
bool has_striking_sign(std::string_view text);

// Whether a word belongs to plain sentences that answer ("I think the robot must take ..."). What a
// lenient rule takes an answer from holds no others but those of the question and of the options.
bool is_plain_word(std::string_view word);

}  // namespace probe::ask
