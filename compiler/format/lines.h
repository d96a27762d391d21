// Lines between layout and print; private to this folder. A line is pieces with at most one blank
// between them, until align() widens the gaps that the author lined up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "compiler/syntax/token.h"

namespace probe::format {

inline constexpr std::size_t kNoLine = static_cast<std::size_t>(-1);

struct Piece {
  std::string_view text;
  syntax::TokenKind kind = syntax::TokenKind::kEnd;
  std::uint32_t width = 0;          // characters
  std::uint32_t blanks = 0;         // before it, in the result
  std::uint32_t source_blanks = 0;  // before it, in the source; 0 at the start of a source line
  std::uint32_t source_column = 0;
};

struct Line {
  std::uint32_t indent = 0;
  std::vector<Piece> pieces;  // empty: a comment alone
  std::string_view comment;   // behind the pieces
  std::uint32_t comment_gap = 2;
  bool blank_before = false;
  bool starts_statement = false;
  // The line whose open bracket this one hangs from: it moves with that bracket.
  std::size_t hangs_from = kNoLine;

  std::uint32_t width() const {
    std::uint32_t sum = indent;
    for (const Piece& piece : pieces) sum += piece.blanks + piece.width;
    return sum;
  }
};

inline bool is_opening(syntax::TokenKind kind) {
  return kind == syntax::TokenKind::kLeftParen || kind == syntax::TokenKind::kLeftBracket ||
         kind == syntax::TokenKind::kLeftBrace;
}
inline bool is_closing(syntax::TokenKind kind) {
  return kind == syntax::TokenKind::kRightParen || kind == syntax::TokenKind::kRightBracket ||
         kind == syntax::TokenKind::kRightBrace;
}

std::uint32_t width_of(std::string_view text);

// Tokens to lines.
std::vector<Line> lay_out(const SourceFile& source, const syntax::TokenStream& stream);

// Columns that the author lined up in neighbouring lines are lined up exactly; so are comments
// behind neighbouring lines.
void align(std::vector<Line>& lines);

}  // namespace probe::format
