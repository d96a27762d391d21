#include "runtime/ask/reading/read_letters.h"

#include <algorithm>
#include <array>

#include "runtime/ask/reading/doubt_words.h"

namespace probe::ask {
namespace {

// 0 for A; nothing where the token is no single letter.
std::optional<std::size_t> letter(const Token& token) {
  if (!token.is_word() || token.text.size() != 1 || token.text[0] < 'a' || token.text[0] > 'z')
    return std::nullopt;
  return static_cast<std::size_t>(token.text[0] - 'a');
}

constexpr auto kLetterNouns = std::to_array<std::string_view>(
    {"option", "letter", "choice", "answer", "object", "label", "item"});
// Before a letter they make it another one's name.
constexpr auto kOtherNouns = std::to_array<std::string_view>(
    {"vitamin", "picture", "image", "figure", "panel", "plan", "type", "class"});
// What cannot follow an article or stands behind a letter alone: verbs and words that join.
constexpr auto kNoNouns = std::to_array<std::string_view>(
    {"is",     "isnt",   "was",  "wasnt",  "because", "since",  "as",    "seems", "looks", "might",
     "may",    "can",    "cant", "cannot", "could",   "should", "would", "must",  "will",  "has",
     "does",   "doesnt", "fits", "fails",  "makes",   "lacks",  "and",   "or",    "nor",   "vs",
     "versus", "then",   "over", "rather", "instead", "but",    "not",   "if",    "beats"});

// The letter at token `at`, if it stands as one.
std::optional<LetterAt> letter_at(const Tokens& tokens, std::size_t at) {
  const auto which = letter(tokens[at]);
  if (!which) return std::nullopt;
  LetterAt found{*which, at, at + 1, false};
  const Token* before = at > 0 ? &tokens[at - 1] : nullptr;
  const Token* after = at + 1 < tokens.size() ? &tokens[at + 1] : nullptr;
  if (before != nullptr && is_one_of(*before, kOtherNouns)) return std::nullopt;
  const bool opens = before != nullptr && (before->is_sign('(') || before->is_sign('['));
  const bool closes = after != nullptr && (after->is_sign(')') || after->is_sign(']'));
  if (opens && closes) found.begin = at - 1;
  if (closes) ++found.end;
  const bool noun = found.begin > 0 && is_one_of(tokens[found.begin - 1], kLetterNouns) &&
                    (tokens[at].capital || closes);
  if (noun) --found.begin;
  const bool ends = after == nullptr || after->is_end();
  const bool sign = after != nullptr && (after->is_sign('.') || after->is_sign(':'));
  if (sign && !closes) ++found.end;
  found.is_marked = closes || noun;
  if (found.is_marked) return found;
  const bool begins = before == nullptr || before->kind == TokenKind::kBreak;
  if (begins && (sign || ends)) {
    found.is_marked = true;
    return found;
  }
  if (!tokens[at].capital) return std::nullopt;
  const bool is_article_or_pronoun = tokens[at].is("a") || tokens[at].is("i");
  if (!is_article_or_pronoun) return found;
  // What follows an article is a noun; a sign, an end, a verb or another letter ("A-B") is none.
  if (ends || after->kind == TokenKind::kSign || (after->capital && letter(*after))) return found;
  if (tokens[at].is("a") && is_one_of(*after, kNoNouns)) return found;
  return std::nullopt;
}

// Words that begin a clause of their own, and of them those that begin a reason.
constexpr auto kClauseWords = std::to_array<std::string_view>(
    {"because", "since", "while", "whereas", "though", "although", "but", "and", "so", "however"});
constexpr auto kReasons = std::to_array<std::string_view>({"because", "since", "as"});

bool is_clause_sign(const Token& token) {
  return token.is_end() || token.is_sign(',') || token.is_sign(';');
}

}  // namespace

bool is_decoration(const Token& token) {
  return token.kind != TokenKind::kWord && token.kind != TokenKind::kNumber;
}

std::vector<LetterAt> letters_of(const Tokens& tokens, std::span<const Named> named) {
  std::vector<LetterAt> found;
  std::size_t name = 0;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    while (name < named.size() && named[name].end <= at) ++name;
    const bool inside =
        name < named.size() && named[name].begin <= at && named[name].end - named[name].begin > 1;
    if (inside) continue;
    if (const auto one = letter_at(tokens, at)) found.push_back(*one);
  }
  return found;
}

std::set<std::uint32_t> labels_of(const AnswerPart& part, const LetterAt& at) {
  std::size_t from = at.end;
  while (from < part.tokens.size() && !part.tokens[from].is_end() &&
         (part.tokens[from].kind == TokenKind::kSign || is_article(part.tokens[from].text)))
    ++from;
  const auto behind = [&](std::size_t token) {
    return std::lower_bound(part.named.begin(), part.named.end(), token,
                            [](const Named& name, std::size_t t) { return name.begin < t; });
  };
  std::set<std::uint32_t> places;
  for (auto name = behind(from); name != part.named.end() && name->begin == from; ++name)
    places.insert(name->place);
  if (!part.tokens[at.begin].is_sign('(')) return places;
  for (auto name = behind(at.begin); name != part.named.begin();) {
    if ((--name)->end != at.begin) break;
    places.insert(name->place);
  }
  return places;
}

std::optional<LetterAt> bare_letter(const Tokens& tokens,
                                    std::pair<std::size_t, std::size_t> range) {
  std::optional<LetterAt> found;
  for (std::size_t at = range.first; at < range.second; ++at) {
    if (is_decoration(tokens[at])) continue;
    const auto which = letter(tokens[at]);
    const bool noun = !found && is_one_of(tokens[at], kLetterNouns);
    if (noun) continue;
    if (found || !which) return std::nullopt;
    found = LetterAt{*which, at, at + 1, true};
  }
  return found;
}

std::size_t end_of_clause(const Tokens& tokens, std::size_t at) {
  while (at < tokens.size() && !is_clause_sign(tokens[at]) && !is_one_of(tokens[at], kClauseWords))
    ++at;
  return at;
}

bool says_not(const ReadContext& context, std::span<const Token> words) {
  constexpr auto kWhere = std::to_array<std::string_view>({"where it"});
  if (has_against(words, kSaysNot)) return true;
  if (!has_phrase(words, kWhere)) return false;
  const auto asked = plain_words(context.question);
  return std::find(asked.begin(), asked.end(), "where") == asked.end();
}

bool speaks_against(const ReadContext& context, const AnswerPart& part, std::size_t from,
                    std::size_t to, const Reading& reading) {
  const Tokens& tokens = part.tokens;
  const auto letters = context.letters && context.form == plan::QuestionForm::kChoice
                           ? letters_of(tokens, part.named)
                           : std::vector<LetterAt>{};
  constexpr auto kOthers = std::to_array<std::string_view>({"others", "other", "rest"});
  std::size_t name = 0, next_letter = 0;
  for (std::size_t at = from; at < to;) {
    if (is_clause_sign(tokens[at])) {
      ++at;
      continue;
    }
    while (next_letter < letters.size() && letters[next_letter].begin < at) ++next_letter;
    std::size_t end = end_of_clause(tokens, at + 1);
    // "C. orange juice is not meant": the sign of a letter parts it not from its words.
    if (next_letter < letters.size() && letters[next_letter].begin <= at &&
        letters[next_letter].end == end + 1 && !labels_of(part, letters[next_letter]).empty())
      end = end_of_clause(tokens, end + 1);
    end = std::min(end, to);
    const auto clause = std::span(tokens).subspan(at, end - at);
    bool is_other =
        std::ranges::any_of(clause, [&](const Token& token) { return is_one_of(token, kOthers); });
    bool other_letter = false, same_letter = false;
    while (name < part.named.size() && part.named[name].begin < at) ++name;
    for (; name < part.named.size() && part.named[name].begin < end; ++name)
      is_other = is_other || context.options[part.named[name].place].option != reading.option;
    for (; next_letter < letters.size() && letters[next_letter].begin < end; ++next_letter) {
      const std::size_t place = letters[next_letter].letter;
      const bool same =
          place < context.options.size() && context.options[place].option == reading.option;
      (same ? same_letter : other_letter) = true;
    }
    const bool is_reason = is_one_of(tokens[at], kReasons);
    const bool denies = says_not(context, clause);
    // Phrases reach over the words that begin a clause ("anything but").
    const bool turns = has_against(clause, kTakesBack);
    const bool about_other = reading.option && (is_other || other_letter) && !same_letter;
    if (!is_reason && (turns || (denies && !about_other))) return true;
    if (other_letter && !is_reason && !denies) return true;
    at = end;
  }
  return false;
}

std::vector<std::string> known_words(const ReadContext& context) {
  std::vector<std::string> known = plain_words(context.question);
  for (const ShownOption& option : context.options) {
    for (std::string& word : plain_words(option.name)) known.push_back(std::move(word));
    for (const std::string& phrase : option.words) {
      for (std::string& word : plain_words(phrase)) known.push_back(std::move(word));
    }
  }
  return known;
}

bool is_known_word(const std::vector<std::string>& known, const Token& token) {
  return is_plain_word(token.text) ||
         std::any_of(known.begin(), known.end(),
                     [&](const std::string& word) { return is_same_noun(word, token.text); });
}

bool is_plain_speech(const ReadContext& context, const AnswerPart& part, std::size_t from,
                     std::size_t to) {
  const std::vector<std::string> known = known_words(context);
  std::size_t name = 0;
  for (std::size_t at = from; at < to; ++at) {
    const Token& token = part.tokens[at];
    if (!token.is_word()) continue;
    while (name < part.named.size() && part.named[name].end <= at) ++name;
    if (name < part.named.size() && part.named[name].begin <= at) continue;
    if (!letter(token) && !is_known_word(known, token) && !is_harmless(part.tokens, at))
      return false;
  }
  return true;
}

}  // namespace probe::ask
