// Letters that stand as letters in an answer to a choice, and what the rest of an answer says
// against what is taken from it.
#pragma once

#include <set>

#include "runtime/ask/reading/read_rules.h"

namespace probe::ask {

// One letter that stands as a letter, from `begin` to `end` with its brackets and the noun before.
struct LetterAt {
  std::size_t letter = 0, begin = 0, end = 0;  // 0 for A
  bool is_marked = false;                      // by a bracket, a sign behind it or a noun before it
};

// In their order; letters inside names ("vitamin C") are none. "A" and "I" before words are an
// article and a pronoun, unless the word can follow neither; small letters need a sign.
std::vector<LetterAt> letters_of(const Tokens& tokens, std::span<const Named> named);

// The places that the words right behind a letter name, articles and signs between them left out;
// the words right before it, too, where it stands in brackets behind them.
std::set<std::uint32_t> labels_of(const AnswerPart& part, const LetterAt& at);

// Nothing but one letter and signs, of any case.
std::optional<LetterAt> bare_letter(const Tokens& tokens,
                                    std::pair<std::size_t, std::size_t> range);

bool is_decoration(const Token& token);

// Whether the tokens [from, to) speak against `reading`: a denial, a doubt or what takes back, in
// a clause that is not a reason ("because ...") and is not about other options; another option's
// letter, but in a reason or where it is denied. Linear.
bool speaks_against(const ReadContext& context, const AnswerPart& part, std::size_t from,
                    std::size_t to, const Reading& reading);

// Whether words deny something of what they are about: by the table of doubts, or as "is where it
// goes" where nobody asked where.
bool says_not(const ReadContext& context, std::span<const Token> words);

// The words of the question and of its options, and whether one is among them or a plain one.
std::vector<std::string> known_words(const ReadContext& context);
bool is_known_word(const std::vector<std::string>& known, const Token& token);

// Whether all words of [from, to) are plain ones, the question's or an option's.
bool is_plain_speech(const ReadContext& context, const AnswerPart& part, std::size_t from,
                     std::size_t to);

// The end of the clause that `at` stands in: a sign or a word that begins another one.
std::size_t end_of_clause(const Tokens& tokens, std::size_t at);

}  // namespace probe::ask
