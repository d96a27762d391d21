// The words of an instruction that ask for something of success, whatever its clauses are.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace probe::sema {

// What each of the table's words asks of a goal; empty where that is there.
enum class Asks : std::uint8_t {
  kOpens,
  kCloses,
  kAmong,
  kSides,
  kThen,
  kAfter,
  kEach,
  kSpares,
  kLeaves
};
struct GoalWords {
  std::string_view words;
  Asks asks;
};
inline constexpr auto kGoalWords = std::to_array<GoalWords>({
#define PROBE_GOAL_WORDS(words, asks) {words, Asks::asks},
#include "compiler/check/goal_words.def"
});

}  // namespace probe::sema
