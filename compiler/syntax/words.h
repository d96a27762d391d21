// The words of the language as data, made from keywords.def and from the tables of plans: for what
// is not the parser. Knows no grammar.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace probe::syntax {

// The declarations whose blocks hold statements that begin with a word.
enum class Block : std::uint8_t {
  kDataset,
  kObject,
  kRobot,
  kControl,
  kCamera,
  kLight,
  kFixture,
  kPart,
  kScene,
  kLayout,
  kTask,
  kSolution,
  kQuestions,
  kSuite,
  kSpace
};

// How often a statement may stand in one block: the column `repeat`.
enum class Repeat : std::uint8_t { kOnce, kNamed, kMany };

struct StatementWord {
  Block block;
  std::string_view word;
  Repeat repeat;
};

// In the order of keywords.def.
std::span<const std::string_view> declaration_words();
std::span<const StatementWord> statement_words();
// All words that start neither, ascending, none twice.
std::vector<std::string_view> inner_words();

bool is_declaration_word(std::string_view word);
// Null when no statement of such a block begins with the word.
const StatementWord* find_statement(Block block, std::string_view word);

}  // namespace probe::syntax
