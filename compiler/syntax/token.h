// Tokens with their trivia: the lossless form of a file. Formatter and editor support build on it;
// the typed tree (ast.h) is made from it. Every byte belongs to exactly one token, so joining all
// token texts gives the file back.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/syntax/ast.h"

namespace probe::syntax {

enum class TokenKind : std::uint8_t {
  // Trivia: what the grammar does not see. Whether a newline ends a statement is decided by the
  // parser.
  kBlank,       // spaces, tabs, carriage returns, a byte order mark at the start
  kNewline,     // one "\n" or "\r\n"
  kComment,     // "#" to the end of the line
  kDocComment,  // "##" to the end of the line
  kStray,       // bytes that cannot start a token; reported
  // What the grammar sees.
  kIdent,
  kNumber,  // without sign, with its unit
  kString,  // with its quotes; an unclosed one ends before the newline
  kLeftParen,
  kRightParen,
  kLeftBracket,
  kRightBracket,
  kLeftBrace,
  kRightBrace,
  kComma,
  kSemicolon,
  kColon,
  kDot,
  kDotDot,
  kAt,
  kAssign,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kEqual,
  kNotEqual,
  kPlus,
  kMinus,
  kStar,
  kSlash,
  kPipe,
  kAmpersand,
  kEnd,  // empty, last
};

inline bool is_trivia(TokenKind kind) { return kind <= TokenKind::kStray; }

struct Token {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  TokenKind kind = TokenKind::kEnd;
  Unit unit = Unit::kNone;      // of a number
  std::uint16_t unit_size = 0;  // bytes of the unit's text at the end of a number
};
static_assert(sizeof(Token) == 12);

// What the grammar took a token for, where its shape alone does not say. For layout.
enum class TokenRole : std::uint8_t {
  kPlain,
  kBlock,       // `{` around statements
  kTightBrace,  // `{` around names in an expression: `bodies - {a, b}`
  kTightParen,  // `(` behind the name it belongs to: a call, parameters, @allow
  kSign,        // `+` or `-` of what follows, not between two operands
};

struct TokenStream {
  FileId file;
  std::vector<Token> tokens;  // contiguous from byte 0 to the end of the file
  // One per token after parsing; empty before.
  std::vector<TokenRole> roles;
};

// The bytes of all tokens one after the other: the file.
std::string to_text(const TokenStream& stream, const SourceSet& sources);

}  // namespace probe::syntax
