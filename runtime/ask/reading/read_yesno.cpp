// How yes and no are read.
#include <algorithm>
#include <array>
#include <set>

#include "runtime/ask/reading/read_doubt.h"
#include "runtime/ask/reading/read_rules.h"

namespace probe::ask {
namespace {

constexpr auto kYes = std::to_array<std::string_view>(
    {"yes", "yeah", "yep", "yup", "true", "correct", "affirmative", "certainly", "indeed"});
constexpr auto kNo =
    std::to_array<std::string_view>({"no", "nope", "nah", "false", "incorrect", "negative"});

bool among(const auto& table, const Token& token) {
  return token.is_word() && std::find(table.begin(), table.end(), token.text) != table.end();
}

std::optional<bool> yes_or_no(const Token& token) {
  if (among(kYes, token)) return true;
  if (among(kNo, token)) return false;
  return std::nullopt;
}

Reading said(bool yes) { return {.verdict = Verdict::kRead, .yes = yes}; }

// "yes and no", "yes/no", "yes, no": the other word right behind, with no other word between.
bool is_taken_back(const Tokens& tokens, std::size_t at, bool yes) {
  constexpr auto kBetween = std::to_array<std::string_view>({"and", "or", "but", "also"});
  for (std::size_t i = at + 1; i < tokens.size(); ++i) {
    if (!tokens[i].is_word() || among(kBetween, tokens[i])) continue;
    return yes_or_no(tokens[i]) == !yes;
  }
  return false;
}

// Of the refusals those that no "no" can mean.
constexpr auto kHelpless = std::to_array<std::string_view>(
    {"cannot tell", "cant tell", "dont know", "do not know", "cannot be determined",
     "cant be determined", "cannot determine", "cant determine", "impossible to", "not possible to",
     "unable to", "no image", "no picture", "cannot answer", "well enough"});

// What each sentence begins with; they have to agree.
std::optional<Reading> word_first(const ReadContext&, const AnswerPart& part) {
  const Tokens& tokens = part.tokens;
  std::optional<bool> answer;
  bool leads = false;  // the first sentence or the last begins so
  const auto sentences = sentences_of(tokens);
  for (std::size_t s = 0; s < sentences.size(); ++s) {
    std::size_t at = sentences[s].first;
    while (at < sentences[s].second && !tokens[at].is_word()) ++at;
    if (at == sentences[s].second) continue;
    const auto here = yes_or_no(tokens[at]);
    if (!here) continue;
    // "No carrot is there" has no sign behind its first word, and denies all the same; "correct
    // objects are" says nothing.
    const bool is_plain = tokens[at].is("yes") || tokens[at].is("no");
    const bool ends = at + 1 == sentences[s].second || !tokens[at + 1].is_word();
    if (!is_plain && !ends) continue;
    if (is_taken_back(tokens, at, *here) || (answer && *answer != *here)) return unclear();
    answer = here;
    leads = leads || s == 0 || s + 1 == sentences.size();
  }
  if (!answer || !leads) return std::nullopt;
  // "No, I cannot tell": the word answers nothing.
  if (!*answer && has_phrase(tokens, kHelpless)) return std::nullopt;
  return said(*answer);
}

// "There is a carrot" answers only what was asked: its words are words of the question.
std::optional<Reading> there_is(const ReadContext& context, const AnswerPart& part) {
  const Tokens& tokens = part.tokens;
  std::set<std::string> asked;
  for (const std::string& word : plain_words(context.question)) asked.insert(word);
  std::optional<bool> answer;
  for (const auto& [first, end] : sentences_of(tokens)) {
    std::size_t at = first;
    if (!tokens[at].is("there") || at + 2 >= end) continue;
    ++at;
    bool yes = true;
    if (tokens[at].is("isnt") || tokens[at].is("arent")) {
      yes = false;
    } else if (!tokens[at].is("is") && !tokens[at].is("are")) {
      continue;
    }
    ++at;
    if (tokens[at].is("no") || tokens[at].is("not")) {
      if (!yes) return unclear();
      yes = false;
      ++at;
    }
    bool any = false;
    for (; at < end; ++at) {
      constexpr auto kFree = std::to_array<std::string_view>(
          {"a",     "an",   "the",     "any",     "one",     "in",    "on",
           "at",    "of",   "visible", "present", "picture", "image", "scene",
           "photo", "here", "shown",   "table",   "this",    "s"});
      if (!tokens[at].is_word()) continue;
      if (among(kFree, tokens[at])) continue;
      const bool known = std::any_of(asked.begin(), asked.end(), [&](const std::string& word) {
        return is_same_noun(word, tokens[at].text);
      });
      if (!known) return unclear();
      any = true;
    }
    if (!any || (answer && *answer != yes)) return unclear();
    answer = yes;
  }
  if (!answer) return std::nullopt;
  return said(*answer);
}

// "It is.", "It does not.": a whole sentence of a pronoun, a verb and perhaps a denial.
std::optional<Reading> it_is(const ReadContext&, const AnswerPart& part) {
  constexpr auto kWho = std::to_array<std::string_view>({"it", "they", "there"});
  constexpr auto kDoes = std::to_array<std::string_view>({"is", "are", "does", "do", "has", "did"});
  constexpr auto kDoesNot =
      std::to_array<std::string_view>({"isnt", "arent", "doesnt", "dont", "hasnt", "didnt"});
  std::vector<const Token*> words;
  for (const Token& token : part.tokens) {
    if (token.is_word()) words.push_back(&token);
    if (words.size() > 3) return std::nullopt;
  }
  if (words.size() < 2 || !among(kWho, *words[0])) return std::nullopt;
  if (words.size() == 2 && among(kDoes, *words[1])) return said(true);
  if (words.size() == 2 && among(kDoesNot, *words[1])) return said(false);
  if (words.size() == 3 && among(kDoes, *words[1]) && words[2]->is("not")) return said(false);
  return std::nullopt;
}

// Its last word, where it was not said before: "The carrot is there, so yes."
std::optional<Reading> one_word(const ReadContext&, const AnswerPart& part) {
  std::optional<bool> answer;
  for (std::size_t at = 0; at < part.tokens.size(); ++at) {
    const Token& token = part.tokens[at];
    // "no" before a noun, and "correct" as an adjective, belong to a sentence.
    const bool ends = at + 1 == part.tokens.size() || !part.tokens[at + 1].is_word();
    const auto here = yes_or_no(token);
    if (!here) continue;
    if (answer && *answer != *here) return unclear();
    // "That is correct" may speak of anything.
    if (!token.is("yes") && !token.is("no") && !token.is("yeah") && !token.is("nope"))
      return unclear();
    if (!ends && !token.is("yes")) return unclear();
    if (is_denied(part.tokens, at)) return unclear();
    answer = here;
  }
  if (!answer) return std::nullopt;
  return said(*answer);
}

// "I do not see it." says no where it was asked whether it is there.
bool is_unseen(const ReadContext& context, const AnswerPart& part) {
  constexpr auto kUnseen = std::to_array<std::string_view>({"i", "do", "not", "dont", "see"});
  constexpr auto kWhat = std::to_array<std::string_view>(
      {"it", "one", "any", "a", "an", "the", "them", "here", "there"});
  constexpr auto kSee = std::to_array<std::string_view>({"i do not see", "i dont see"});
  if (!asks_for_presence(context) || !has_phrase(part.tokens, kSee)) return false;
  const auto asked = plain_words(context.question);
  bool any = false;
  for (const Token& token : part.tokens) {
    if (!token.is_word() || among(kUnseen, token)) continue;
    const bool known =
        among(kWhat, token) ||
        std::any_of(asked.begin(), asked.end(), [&](const std::string& word) {
          return word != "picture" && word != "image" && is_same_noun(word, token.text);
        });
    if (!known) return false;
    any = true;
  }
  return any;
}

std::optional<Reading> refused_yesno(const ReadContext& context, const AnswerPart& part) {
  if (is_unseen(context, part)) return said(false);
  if (!is_refusal(part.tokens)) return std::nullopt;
  return Reading{.verdict = Verdict::kRefused};
}

constexpr ReadRule kYesNoRules[] = {
    {"yes or no first",
     "what the first or last sentence begins with: Yes, it is; yes and no are unclear", word_first},
    {"refused", "words that say that it cannot or will not answer", refused_yesno},
    {"there is", "there is (not) what the question asks for", there_is},
    {"it is", "it is, it does not", it_is},
    {"one word", "yes or no somewhere, as a word of its own", one_word},
};

}  // namespace

std::span<const ReadRule> yesno_rules() { return kYesNoRules; }

}  // namespace probe::ask
