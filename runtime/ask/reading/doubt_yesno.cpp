// What makes a yes or no doubtful that a rule read.
#include <algorithm>
#include <array>

#include "runtime/ask/reading/doubt_words.h"
#include "runtime/ask/reading/read_doubt.h"
#include "runtime/ask/reading/read_letters.h"

namespace probe::ask {
namespace {

constexpr auto kSides = std::to_array<std::string_view>(
    {"left", "right", "above", "below", "front", "behind", "under", "over", "near", "far"});
// What may follow a "no" that answers.
constexpr auto kBehindNo =
    std::to_array<std::string_view>({"it", "its", "there", "the", "they", "this", "that", "i",
                                     "because", "since", "as", "not", "a", "an", "sorry"});

bool has_word_of(const std::vector<std::string>& asked, const Token& token) {
  return std::any_of(asked.begin(), asked.end(),
                     [&](const std::string& word) { return is_same_noun(word, token.text); });
}

// "No doubt", "No objects block": a "no" that denies its noun, not what was asked.
bool is_about_noun(const Tokens& tokens, const std::vector<std::string>& asked, bool presence) {
  for (std::size_t at = 0; at + 1 < tokens.size(); ++at) {
    if (!tokens[at].is("no") || !tokens[at + 1].is_word()) continue;
    const bool begins = at == 0 || !tokens[at - 1].is_word();
    if (!begins || is_one_of(tokens[at + 1], kBehindNo)) continue;
    if (!presence || !has_word_of(asked, tokens[at + 1])) return true;
  }
  return false;
}

// "No, it is.", "No, I can see it", "No, there is a carrot": a clause that says yes.
bool says_yes(const Tokens& tokens, bool presence) {
  constexpr auto kWho = std::to_array<std::string_view>({"it", "there", "they"});
  constexpr auto kDoes = std::to_array<std::string_view>({"is", "are", "does", "do", "has"});
  constexpr auto kSeeing =
      std::to_array<std::string_view>({"i see", "i can see", "i do see", "it is there"});
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const std::size_t end = end_of_clause(tokens, at);
    if (end == at) continue;
    const auto clause = std::span(tokens).subspan(at, end - at);
    const bool denies = has_against(clause, kSaysNot);
    const auto last = clause.size() - 1;
    if (!denies && clause.size() > 1 && is_one_of(clause[last - 1], kWho) &&
        is_one_of(clause[last], kDoes))
      return true;
    if (!denies && presence && has_phrase(clause, kSeeing)) return true;
    if (!denies && presence && clause.size() > 2 && clause[0].is("there") &&
        (clause[1].is("is") || clause[1].is("are")))
      return true;
    at = end;
  }
  return false;
}

// What stands behind the yes or no itself: a share ("Yes: 10 %"), a verb ("Yes is wrong").
bool is_verdict_talked_of(const Tokens& tokens) {
  constexpr auto kOfVerdict = std::to_array<std::string_view>(
      {"is", "isnt", "was", "would", "should", "must", "can", "cannot", "may", "seems"});
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    if (tokens[at].kind == TokenKind::kNumber || tokens[at].is_sign('%')) return true;
    if (!tokens[at].is("yes") && !tokens[at].is("no")) continue;
    if (at + 1 < tokens.size() && is_one_of(tokens[at + 1], kOfVerdict)) return true;
  }
  return false;
}

}  // namespace

bool is_yesno_doubtful(const ReadContext& context, const AnswerPart& part, const ReadRule& rule,
                       const Reading& reading) {
  constexpr Against kAll[] = {Against::kRejects, Against::kDoubts, Against::kTurns};
  constexpr auto kNegative =
      std::to_array<std::string_view>({"false", "incorrect", "missing", "absent"});
  const Tokens& tokens = part.tokens;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    if (tokens[at].is_sign('?')) return true;
    const bool says_no = !reading.yes.value_or(false) && is_one_of(tokens[at], kNegative);
    if (!says_no && is_against(tokens, at, kAll)) return true;
  }
  if (is_verdict_talked_of(tokens)) return true;
  if (reading.yes == false && rule.name == "yes or no first" &&
      says_yes(tokens, asks_for_presence(context)))
    return true;
  const std::vector<std::string> asked = plain_words(context.question);
  const bool presence = asks_for_presence(context);
  if (rule.name == "there is") return !presence;
  if (is_about_noun(tokens, asked, presence)) return true;
  const bool yes = reading.yes.value_or(false);
  if (yes && has_against(tokens, kDenials)) return true;
  const bool has_side = std::any_of(asked.begin(), asked.end(), [](const std::string& word) {
    return std::find(kSides.begin(), kSides.end(), word) != kSides.end();
  });
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    if (!yes && tokens[at].is("yes")) return true;
    if (!has_side || !is_one_of(tokens[at], kSides)) continue;
    const bool same = std::find(asked.begin(), asked.end(), tokens[at].text) != asked.end();
    if (yes && !same) return true;
    // The "no" that answers denies nothing behind its sign.
    std::size_t from = at;
    constexpr std::size_t kFar = 30;  // tokens
    while (from > 0 && at - from < kFar && !tokens[from - 1].is_end() &&
           !tokens[from - 1].is_sign(','))
      --from;
    const auto clause = std::span(tokens).subspan(from, at - from);
    if (!yes && same && !has_against(clause, kDenials)) return true;
  }
  return false;
}

}  // namespace probe::ask
