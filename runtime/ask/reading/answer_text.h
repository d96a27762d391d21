// The text of an answer as words and signs: what rules of reading look at. Knows no questions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/nouns.h"

namespace probe::ask {

// What is left of an answer without its thoughts: blocks between <think> and </think> or other
// marks of thoughts (a table: [THINK], <|START_THINKING|>, <|channel|>analysis ..), from one that
// does not end to the end, and up to an end that had no beginning, because some servers' templates
// write the beginning themselves. Linear.
std::string without_thoughts(std::string_view raw);

// Without a terminal's control sequences ("\x1b[31m" makes red), whose letters are no words.
std::string without_colours(std::string_view text);

// One form for what looks the same: compatible characters (full-width letters, spaces of any
// width) and curly quotes are the plain ones, what nobody sees is left out, controls and
// bytes that are no UTF-8 are blanks. Line breaks and cases stay. Linear.
std::string plain_form(std::string_view text);

enum class TokenKind : std::uint8_t {
  kWord,    // letters and digits; apostrophes inside are left out: "rabbit's" is "rabbits"
  kNumber,  // digits, with a fraction where one follows; without a sign
  kSign,    // one character
  kBreak,   // the end of a line
};

struct Token {
  TokenKind kind = TokenKind::kSign;
  std::string text = {};           // folded
  bool capital = false;            // began with a capital letter
  bool spaced = false;             // a blank stood before it
  std::size_t begin = 0, end = 0;  // bytes of the text

  bool is(std::string_view what) const { return text == what; }
  bool is_word() const { return kind == TokenKind::kWord; }
  bool is_sign(char what) const {
    return kind == TokenKind::kSign && text.size() == 1 && text[0] == what;
  }
  // Ends a sentence or a line.
  bool is_end() const {
    return kind == TokenKind::kBreak || is_sign('.') || is_sign('!') || is_sign('?');
  }
};
using Tokens = std::vector<Token>;

// Of a text in plain form. Marks of emphasis, quotes, code and formulas, commands of LaTeX and tags
// of HTML that only format are left out; underscores, and hyphens between letters, part words.
Tokens tokens_of(std::string_view text);

bool is_one_of(const Token& token, std::span<const std::string_view> words);
bool has_one_of(std::span<const Token> tokens, std::span<const std::string_view> words);

// Whether the words of a phrase, with blanks between them, stand from `at` on with no sign or break
// in between.
bool stands_phrase(std::span<const Token> tokens, std::size_t at, std::string_view phrase);
// Whether one of `phrases` stands anywhere.
bool has_phrase(std::span<const Token> tokens, std::span<const std::string_view> phrases);

// Whether the text says that it will not or cannot answer, by a table of phrases.
bool is_refusal(std::span<const Token> tokens);

}  // namespace probe::ask
