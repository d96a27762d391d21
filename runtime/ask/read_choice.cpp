// How an answer to a choice is read: letters that stand as letters, then names.
#include <algorithm>
#include <array>
#include <cstdint>
#include <set>

#include "runtime/ask/read_rules.h"

namespace probe::ask {
namespace {

using Range = std::pair<std::size_t, std::size_t>;

Reading chosen(const ReadContext& context, std::size_t place) {
  return {.verdict = Verdict::kRead, .option = context.options[place].option};
}

// ---- letters ----------------------------------------------------------------------------------

// 0 for A; nothing where the token is no single letter.
std::optional<std::size_t> letter(const Token& token) {
  if (!token.is_word() || token.text.size() != 1 || token.text[0] < 'a' || token.text[0] > 'z')
    return std::nullopt;
  return static_cast<std::size_t>(token.text[0] - 'a');
}

bool is_word_of(const auto& table, const Token& token) {
  return token.is_word() && std::find(table.begin(), table.end(), token.text) != table.end();
}

constexpr auto kLetterNouns = std::to_array<std::string_view>(
    {"option", "letter", "choice", "answer", "object", "label", "item"});
constexpr auto kVerbs = std::to_array<std::string_view>({"is", "because", "since", "as", "seems"});
constexpr auto kJoins = std::to_array<std::string_view>({"and", "or", "nor"});

// One letter that stands as a letter, from `begin` to `end` with its brackets and the noun before.
struct LetterAt {
  std::size_t letter = 0, begin = 0, end = 0;
  bool is_marked = false;  // by a bracket, a sign behind it or a noun before it
};

// The letter at token `at`, if it stands as one. "A" and "I" before words are an article and a
// pronoun; small letters need a sign.
std::optional<LetterAt> letter_at(const Tokens& tokens, std::size_t at) {
  const auto which = letter(tokens[at]);
  if (!which) return std::nullopt;
  LetterAt found{*which, at, at + 1, false};
  const Token* before = at > 0 ? &tokens[at - 1] : nullptr;
  const Token* after = at + 1 < tokens.size() ? &tokens[at + 1] : nullptr;
  if (before != nullptr && before->is("vitamin")) return std::nullopt;
  const bool opens = before != nullptr && (before->is_sign('(') || before->is_sign('['));
  const bool closes = after != nullptr && (after->is_sign(')') || after->is_sign(']'));
  if (opens && closes) found.begin = at - 1;
  if (closes) ++found.end;
  const bool noun = found.begin > 0 && is_word_of(kLetterNouns, tokens[found.begin - 1]) &&
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
  if (tokens[at].is("a") && (is_word_of(kVerbs, *after) || is_word_of(kJoins, *after)))
    return found;
  return std::nullopt;
}

// In their order; letters inside names ("vitamin C") are none.
std::vector<LetterAt> letters_of(const AnswerPart& part) {
  std::vector<LetterAt> found;
  std::size_t name = 0;
  for (std::size_t at = 0; at < part.tokens.size(); ++at) {
    while (name < part.named.size() && part.named[name].end <= at) ++name;
    const bool inside = name < part.named.size() && part.named[name].begin <= at &&
                        part.named[name].end - part.named[name].begin > 1;
    if (inside) continue;
    if (const auto one = letter_at(part.tokens, at)) found.push_back(*one);
  }
  return found;
}

// The places that the words right behind a letter name, articles and signs between them left out;
// the words right before it, too, where it stands in brackets behind them.
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

// The letter's option if it was shown and its label, if any, is that option's.
Reading taken(const ReadContext& context, const AnswerPart& part, const LetterAt& at) {
  if (at.letter >= context.options.size()) return unclear();
  const auto labels = labels_of(part, at);
  const bool fits = labels.empty() || labels.contains(static_cast<std::uint32_t>(at.letter));
  return fits ? chosen(context, at.letter) : unclear();
}

// ---- rules about letters ----------------------------------------------------------------------

bool is_decoration(const Token& token) {
  return token.kind != TokenKind::kWord && token.kind != TokenKind::kNumber;
}

// Nothing but one letter and signs, of any case.
std::optional<LetterAt> bare_letter(const Tokens& tokens, Range range) {
  std::optional<LetterAt> found;
  for (std::size_t at = range.first; at < range.second; ++at) {
    if (is_decoration(tokens[at])) continue;
    const auto which = letter(tokens[at]);
    const bool noun = !found && is_word_of(kLetterNouns, tokens[at]);
    if (noun) continue;
    if (found || !which) return std::nullopt;
    found = LetterAt{*which, at, at + 1, true};
  }
  return found;
}

std::optional<Reading> letter_alone(const ReadContext& context, const AnswerPart& part) {
  if (!context.letters) return std::nullopt;
  const auto found = bare_letter(part.tokens, {0, part.tokens.size()});
  if (!found) return std::nullopt;
  return taken(context, part, *found);
}

// "A) carrot B) plate ...": the question's options again.
std::optional<Reading> options_repeated(const ReadContext& context, const AnswerPart& part) {
  if (!context.letters) return std::nullopt;
  std::set<std::size_t> labelled;
  bool begins = false;
  for (const LetterAt& at : letters_of(part)) {
    if (!at.is_marked) continue;
    if (!labels_of(part, at).contains(static_cast<std::uint32_t>(at.letter))) continue;
    if (labelled.empty()) begins = at.letter == 0;
    labelled.insert(at.letter);
  }
  if (begins && labelled.size() > 1) return unclear();
  return std::nullopt;
}

// "B or C", "B, C", "B/C": another letter right behind.
bool is_joined(const AnswerPart& part, const LetterAt& first, const LetterAt& second) {
  if (first.letter == second.letter) return false;
  for (std::size_t at = first.end; at < second.begin; ++at) {
    const Token& token = part.tokens[at];
    if (token.is_word() && !is_word_of(kJoins, token)) return false;
    if (token.is_end()) return false;
  }
  return true;
}

// The letter that the text begins with, whatever explanation follows.
std::optional<Reading> letter_first(const ReadContext& context, const AnswerPart& part) {
  if (!context.letters) return std::nullopt;
  const auto letters = letters_of(part);
  if (letters.empty()) return std::nullopt;
  const LetterAt& first = letters.front();
  for (std::size_t at = 0; at < first.begin; ++at) {
    if (!is_decoration(part.tokens[at])) return std::nullopt;
  }
  if (letters.size() > 1 && is_joined(part, first, letters[1])) return unclear();
  // Another letter alone on a line takes it back.
  for (const Range& line : lines_of(part.tokens)) {
    const auto other = bare_letter(part.tokens, line);
    if (other && other->letter != first.letter) return unclear();
  }
  return taken(context, part, first);
}

// The last line is a letter, with its label or without, behind lines of other words.
std::optional<Reading> letter_last(const ReadContext& context, const AnswerPart& part) {
  if (!context.letters) return std::nullopt;
  const auto lines = lines_of(part.tokens);
  if (lines.size() < 2) return std::nullopt;
  const auto letters = letters_of(part);
  const auto in_line = [&](const LetterAt& at) { return at.begin >= lines.back().first; };
  const auto last = std::find_if(letters.begin(), letters.end(), in_line);
  if (last == letters.end() || std::find_if(last + 1, letters.end(), in_line) != letters.end())
    return std::nullopt;
  for (std::size_t at = lines.back().first; at < last->begin; ++at) {
    if (!is_decoration(part.tokens[at])) return std::nullopt;
  }
  for (const Range& line : lines) {
    const auto other = bare_letter(part.tokens, line);
    if (other && other->letter != last->letter) return unclear();
  }
  return taken(context, part, *last);
}

std::optional<Reading> letter_in_sentence(const ReadContext& context, const AnswerPart& part) {
  if (!context.letters) return std::nullopt;
  const auto letters = letters_of(part);
  if (letters.empty()) return std::nullopt;
  for (const LetterAt& at : letters) {
    if (at.letter != letters[0].letter || is_denied(part.tokens, at.begin)) return unclear();
    const Reading reading = taken(context, part, at);
    if (reading.verdict != Verdict::kRead) return reading;
  }
  return chosen(context, letters[0].letter);
}

// ---- rules about names ------------------------------------------------------------------------

// What may stand around a name that is the whole answer.
constexpr auto kAround =
    std::to_array<std::string_view>({"a", "an", "the", "its", "it", "is", "this", "that"});

// The place that a range names and nothing else.
std::optional<std::uint32_t> bare_name(const AnswerPart& part, Range range) {
  std::optional<std::uint32_t> place;
  std::size_t at = range.first;
  while (at < range.second) {
    const auto name = std::find_if(part.named.begin(), part.named.end(),
                                   [&](const Named& n) { return n.begin == at; });
    if (name != part.named.end()) {
      const bool twice = std::any_of(name + 1, part.named.end(), [&](const Named& n) {
        return n.begin == at && n.place != name->place;
      });
      if (place || twice || name->is_echo) return std::nullopt;
      place = name->place;
      at = name->end;
      continue;
    }
    const Token& token = part.tokens[at];
    if (!is_decoration(token) && !is_word_of(kAround, token)) return std::nullopt;
    ++at;
  }
  return place;
}

// A copy of what was asked, whole or in part, answers nothing: neither the question's own phrase
// for an option nor its sentence, in which another option may be named.
std::optional<Reading> question_repeated(const ReadContext& context, const AnswerPart& part) {
  const bool only_echoes =
      !part.named.empty() && std::all_of(part.named.begin(), part.named.end(),
                                         [](const Named& name) { return name.is_echo; });
  if (only_echoes) return unclear();
  constexpr std::size_t kLeast = 3;  // words; fewer may be a name that the question has, too
  const auto said = plain_words(part.text);
  const bool copies = said.size() >= kLeast && stands_in(said, plain_words(context.question));
  if (copies && !bare_name(part, {0, part.tokens.size()})) return unclear();
  return std::nullopt;
}

std::optional<Reading> name_alone(const ReadContext& context, const AnswerPart& part) {
  if (part.named.size() > 2) return std::nullopt;  // what follows looks for each name
  const auto place = bare_name(part, {0, part.tokens.size()});
  if (!place) return std::nullopt;
  return chosen(context, *place);
}

// Sentences, also ended by a word that begins an explanation.
std::vector<Range> statements_of(const AnswerPart& part) {
  std::vector<Range> out;
  for (const Range& sentence : sentences_of(part.tokens)) {
    std::size_t end = sentence.first;
    while (end < sentence.second && !part.tokens[end].is("because") &&
           !part.tokens[end].is("since"))
      ++end;
    out.emplace_back(sentence.first, end);
  }
  return out;
}

// The first or the last sentence is one option's name alone, and no other sentence another's.
std::optional<Reading> name_as_sentence(const ReadContext& context, const AnswerPart& part) {
  constexpr std::size_t kMost = 1000;  // of names; beyond it nobody explains an answer
  if (part.named.empty() || part.named.size() > kMost) return std::nullopt;
  const auto statements = statements_of(part);
  std::optional<std::uint32_t> place;
  bool at_an_end = false;
  for (std::size_t i = 0; i < statements.size(); ++i) {
    const auto here = bare_name(part, statements[i]);
    if (!here) continue;
    if (place && *place != *here) return unclear();
    place = here;
    at_an_end = at_an_end || i == 0 || i + 1 == statements.size();
  }
  if (!place || !at_an_end) return std::nullopt;
  return chosen(context, *place);
}

std::optional<Reading> refused(const ReadContext&, const AnswerPart& part) {
  if (!is_refusal(part.tokens)) return std::nullopt;
  return Reading{.verdict = Verdict::kRefused};
}

std::optional<Reading> name_denied(const ReadContext&, const AnswerPart& part) {
  for (const Named& name : part.named) {
    if (is_denied(part.tokens, name.begin)) return unclear();
  }
  return std::nullopt;
}

std::optional<Reading> two_named(const ReadContext&, const AnswerPart& part) {
  for (const Named& name : part.named) {
    if (name.place != part.named[0].place) return unclear();
  }
  return std::nullopt;
}

std::optional<Reading> name_in_sentence(const ReadContext& context, const AnswerPart& part) {
  if (part.named.empty()) return std::nullopt;
  return chosen(context, part.named[0].place);
}

constexpr ReadRule kChoiceRules[] = {
    {"letter alone", "nothing but a letter: B, (B), **B**; one that was not shown is unclear",
     letter_alone},
    {"options repeated", "the options with their letters again, from A on: unclear",
     options_repeated},
    {"letter first",
     "the letter it begins with, whatever explanation follows; unclear with "
     "another option's words behind it or another letter joined to it",
     letter_first},
    {"letter last", "the letter that the last line begins with", letter_last},
    {"letter in a sentence",
     "the one letter in it that stands as a letter: I think it is (B); two "
     "letters or a denied one are unclear",
     letter_in_sentence},
    {"question repeated", "a copy of the question or of its own phrase for an option: unclear",
     question_repeated},
    {"name alone", "the words of one option and nothing else", name_alone},
    {"name as sentence", "the words of one option alone as the first or last sentence",
     name_as_sentence},
    {"refused", "words that say that it cannot or will not answer", refused},
    {"name denied", "an option behind not, no, instead of: unclear", name_denied},
    {"two named", "two options: unclear", two_named},
    {"name in a sentence", "the one option that it names", name_in_sentence},
};

}  // namespace

std::span<const ReadRule> choice_rules() { return kChoiceRules; }

}  // namespace probe::ask
