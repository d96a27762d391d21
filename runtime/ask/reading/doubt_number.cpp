// What makes a count doubtful that a rule read.
#include <algorithm>
#include <array>

#include "runtime/ask/reading/read_doubt.h"
#include "runtime/ask/reading/read_letters.h"

namespace probe::ask {
namespace {

std::size_t begin_of_last_sentence(const Tokens& tokens) {
  std::size_t end = tokens.size();
  while (end > 0 && tokens[end - 1].is_end()) --end;
  return begin_of_sentence(tokens, end);
}

// "one" as a pronoun: "One can see", "the orange one".
bool is_pronoun_one(const Tokens& tokens, std::size_t at) {
  constexpr auto kModals = std::to_array<std::string_view>(
      {"can", "could", "may", "might", "would", "sees", "should", "must"});
  constexpr auto kCounting = std::to_array<std::string_view>(
      {"is", "are", "only", "just", "exactly", "see", "count", "be", "say", "answer", "there",
       "number", "so", "zero", "or", "and"});
  if (!tokens[at].is("one")) return false;
  const bool more = at + 1 < tokens.size() && tokens[at + 1].is_word();
  if (more && is_one_of(tokens[at + 1], kModals)) return true;
  // "One of them" is one that is meant, "only one of them" a count.
  const bool ends = !more || tokens[at + 1].is("and");
  const bool part = more && tokens[at + 1].is("of");
  if (part && (at == 0 || !tokens[at - 1].is_word())) return true;
  return (ends || part) && at > 0 && tokens[at - 1].is_word() &&
         !is_one_of(tokens[at - 1], kCounting);
}

}  // namespace

bool is_number_doubtful(const ReadContext& context, const AnswerPart& part,
                        const Reading& reading) {
  constexpr auto kNoCounts =
      std::to_array<std::string_view>({"thirty", "forty", "fifty", "sixty", "seventy", "eighty",
                                       "ninety", "couple", "pair", "few", "some", "another"});
  const Tokens& tokens = part.tokens;
  if (has_one_of(tokens, kNoCounts)) return true;
  // Of a count that stands alone at the end all before it were thoughts.
  const std::size_t last = begin_of_last_sentence(tokens);
  const bool alone = std::none_of(tokens.begin() + static_cast<std::ptrdiff_t>(last), tokens.end(),
                                  [](const Token& token) { return token.is_word(); });
  if (reading.number != 0 &&
      speaks_against(context, part, alone ? last : 0, tokens.size(), reading))
    return true;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    if (is_pronoun_one(tokens, at) || tokens[at].is_sign('?')) return true;
    if (tokens[at].is("none") && reading.number != 0) return true;
    if (tokens[at].kind != TokenKind::kNumber) continue;
    if (at + 1 < tokens.size() && tokens[at + 1].is_sign('+')) return true;
    std::size_t before = tokens[at].begin;
    while (before > 0 && part.text[before - 1] == ' ') --before;
    if (before > 0 && part.text[before - 1] == '~') return true;
  }
  return false;
}

}  // namespace probe::ask
