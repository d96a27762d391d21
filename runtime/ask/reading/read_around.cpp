// What stands around a part that answers and speaks against it.
#include <algorithm>
#include <array>

#include "runtime/ask/reading/doubt_words.h"
#include "runtime/ask/reading/read_doubt.h"
#include "runtime/ask/reading/read_letters.h"

namespace probe::ask {
namespace {

// The first token that begins at or behind a byte.
std::size_t token_at(const Tokens& tokens, std::size_t byte) {
  const auto at =
      std::lower_bound(tokens.begin(), tokens.end(), byte,
                       [](const Token& token, std::size_t b) { return token.begin < b; });
  return static_cast<std::size_t>(at - tokens.begin());
}

}  // namespace

bool is_denied_before(const ReadContext& context, const AnswerPart& whole, const FoundPart& part,
                      const Place& place, const Reading& reading) {
  constexpr auto kConcluding =
      std::to_array<std::string_view>({"so", "thus", "hence", "therefore"});
  const Tokens& tokens = whole.tokens;
  const std::size_t to = token_at(tokens, part.begin);
  std::size_t from = to, clause = to;
  while (from > 0 && !tokens[from - 1].is_end()) {
    --from;
    const bool parts = tokens[from].is_sign(',') || tokens[from].is_sign(':');
    if (clause == to && parts) clause = from;
    if (!std::ranges::any_of(kConcluding, [&](std::string_view w) { return tokens[from].is(w); }))
      continue;
    break;
  }
  const std::size_t begin = from < tokens.size() ? tokens[from].begin : part.begin;
  if (has_striking_sign(
          whole.text.substr(std::min(begin, part.begin), part.begin - std::min(begin, part.begin))))
    return true;
  if (!place.says_its_end && !is_plain_speech(context, whole, clause < to ? clause : from, to))
    return true;
  return speaks_against(context, whole, from, to, reading);
}

bool is_denied_behind(const ReadContext& context, const AnswerPart& whole, std::size_t from,
                      const Reading& reading) {
  if (has_striking_sign(whole.text.substr(from))) return true;
  const std::size_t first = token_at(whole.tokens, from);
  const bool asks =
      std::any_of(whole.tokens.begin() + static_cast<std::ptrdiff_t>(first), whole.tokens.end(),
                  [](const Token& token) { return token.is_sign('?'); });
  return asks || speaks_against(context, whole, first, whole.tokens.size(), reading);
}

}  // namespace probe::ask
