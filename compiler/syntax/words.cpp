#include "compiler/syntax/words.h"

#include <algorithm>

#include "runtime/plan/axes.h"
#include "runtime/plan/readouts.h"

namespace probe::syntax {
namespace {

constexpr std::string_view kDeclarations[] = {
#define PROBE_DECL(word, parse) #word,
#include "compiler/syntax/keywords.def"
};

constexpr StatementWord kStatements[] = {
#define PROBE_STATEMENT(of, word, parse, repeat) {Block::k##of, #word, Repeat::k##repeat},
#include "compiler/syntax/keywords.def"
};

constexpr std::string_view kWords[] = {
#define PROBE_WORD(word) #word,
#include "compiler/syntax/keywords.def"
};

}  // namespace

std::span<const std::string_view> declaration_words() { return kDeclarations; }
std::span<const StatementWord> statement_words() { return kStatements; }

std::vector<std::string_view> inner_words() {
  std::vector<std::string_view> words(std::begin(kWords), std::end(kWords));
  for (const plan::ReadoutInfo& readout : plan::kReadoutTable) {
    for (std::string_view rest = readout.words; !rest.empty();) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      words.push_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  for (const plan::AxisInfo& axis : plan::kAxisTable) {
    if (axis.is_phrase) words.push_back(axis.word());
  }
  std::ranges::sort(words);
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return words;
}

bool is_declaration_word(std::string_view word) {
  return std::ranges::find(kDeclarations, word) != std::end(kDeclarations);
}

const StatementWord* find_statement(Block block, std::string_view word) {
  const auto found = std::ranges::find_if(kStatements, [&](const StatementWord& known) {
    return known.block == block && known.word == word;
  });
  return found == std::end(kStatements) ? nullptr : found;
}

}  // namespace probe::syntax
