// Bytes to tokens. Knows units and the shape of words, numbers and strings; knows no keyword and no
// grammar.
#pragma once

#include <cstdint>
#include <string_view>

#include "compiler/diag/diagnostic.h"
#include "compiler/source/source.h"
#include "compiler/syntax/token.h"

namespace probe::syntax {

// How many errors a file may still report. The last one is P0107 and closes the file.
class ErrorBudget {
 public:
  ErrorBudget(Diagnostics& diagnostics, std::uint32_t limit)
      : diagnostics_(diagnostics), left_(limit) {}

  // None once the budget is spent.
  Diagnostic* report(Code code, const Span& span, std::string message);
  bool is_spent() const { return left_ == 0; }
  bool has_reported() const { return reported_; }

 private:
  Diagnostics& diagnostics_;
  std::uint32_t left_;
  bool reported_ = false;
};

struct LexResult {
  TokenStream stream;
  // The text cannot be read at all (too large, not UTF-8): the stream is one stray token, nothing
  // should be parsed.
  bool unreadable = false;
};

LexResult lex(const SourceFile& source, FileId id, ErrorBudget& errors);

// kNone when `text` is no unit.
Unit unit_from_text(std::string_view text);

// "`m`, `cm`, ...": for helps.
std::string all_units();

inline bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline bool is_word(char c) { return is_letter(c) || is_digit(c) || c == '_'; }

// Whether a newline behind such a token can end a statement.
bool can_end_statement(TokenKind kind);

// The token kind as a message names it: "a name", "`,`".
std::string_view describe(TokenKind kind);

}  // namespace probe::syntax
