// How an answer to a choice is read: letters that stand as letters, then names.
#include <algorithm>
#include <array>
#include <cstdint>
#include <set>

#include "runtime/ask/reading/doubt_words.h"
#include "runtime/ask/reading/read_letters.h"
#include "runtime/ask/reading/read_rules.h"

namespace probe::ask {
namespace {

using Range = std::pair<std::size_t, std::size_t>;

Reading chosen(const ReadContext& context, std::size_t place) {
  return {.verdict = Verdict::kRead, .option = context.options[place].option};
}

constexpr auto kJoins = std::to_array<std::string_view>({"and", "or", "nor"});

// The letter's option if it was shown and its label, if any, is that option's.
Reading taken(const ReadContext& context, const AnswerPart& part, const LetterAt& at) {
  if (at.letter >= context.options.size()) return unclear();
  const auto labels = labels_of(part, at);
  const bool fits = labels.empty() || labels.contains(static_cast<std::uint32_t>(at.letter));
  return fits ? chosen(context, at.letter) : unclear();
}

// ---- rules about letters ----------------------------------------------------------------------

std::optional<Reading> letter_alone(const ReadContext& context, const AnswerPart& part) {
  if (!context.letters) return std::nullopt;
  const auto found = bare_letter(part.tokens, {0, part.tokens.size()});
  if (!found) return std::nullopt;
  return taken(context, part, *found);
}

// "A) carrot B) plate ...": options again, whichever comes first. "B. plate. A. carrot is not what
// is meant" repeats none.
std::optional<Reading> options_repeated(const ReadContext& context, const AnswerPart& part) {
  if (!context.letters) return std::nullopt;
  std::optional<std::size_t> first;
  bool is_first_denied = false;
  for (const LetterAt& at : letters_of(part.tokens, part.named)) {
    if (!at.is_marked) continue;
    if (!labels_of(part, at).contains(static_cast<std::uint32_t>(at.letter))) continue;
    constexpr std::size_t kFar = 40;  // tokens
    std::size_t end = at.end;
    while (end < part.tokens.size() && end < at.end + kFar && !part.tokens[end].is_end() &&
           !part.tokens[end].is_sign(';'))
      ++end;
    const bool denied = says_not(context, std::span(part.tokens).subspan(at.end, end - at.end));
    if (!first) is_first_denied = denied;
    if (!first) first = at.letter;
    if (at.letter != *first && (is_first_denied || !denied)) return unclear();
  }
  return std::nullopt;
}

// "B or C", "B, C", "B/C": another letter right behind.
bool is_joined(const AnswerPart& part, const LetterAt& first, const LetterAt& second) {
  if (first.letter == second.letter) return false;
  for (std::size_t at = first.end; at < second.begin; ++at) {
    const Token& token = part.tokens[at];
    if (token.is_word() && !is_one_of(token, kJoins)) return false;
    if (token.is_end()) return false;
  }
  return true;
}

// The letter that the text begins with, whatever explanation follows.
std::optional<Reading> letter_first(const ReadContext& context, const AnswerPart& part) {
  if (!context.letters) return std::nullopt;
  const auto letters = letters_of(part.tokens, part.named);
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
  const auto letters = letters_of(part.tokens, part.named);
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
  const auto letters = letters_of(part.tokens, part.named);
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
    if (!is_decoration(token) && !is_one_of(token, kAround)) return std::nullopt;
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
    {"options repeated",
     "two options with their letters, whichever comes first: unclear, unless all but the first are "
     "denied",
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
