// Columns. The author's intent is read from the source: where a word stands right below another of
// its kind and one of them was pushed there by blanks, the whole run of such lines is lined up.
#include <algorithm>
#include <cstddef>

#include "compiler/format/format.h"
#include "compiler/format/lines.h"

namespace probe::format {
namespace {

using syntax::TokenKind;

// Whether two neighbouring lines may share columns.
bool are_neighbours(const Line& upper, const Line& lower) {
  return upper.starts_statement && lower.starts_statement && !lower.blank_before &&
         upper.indent == lower.indent;
}

// Whether the k-th pieces of both lines play the same part.
bool match(const Line& a, const Line& b, std::size_t k) {
  if (k >= a.pieces.size() || k >= b.pieces.size()) return false;
  const Piece& left = a.pieces[k];
  const Piece& right = b.pieces[k];
  if (left.kind != right.kind) return false;
  if (left.kind == TokenKind::kAssign || left.kind == TokenKind::kLeftBrace) return true;
  if (a.pieces[0].text != b.pieces[0].text) return false;
  return left.kind != TokenKind::kIdent || left.text == right.text;
}

std::uint32_t column_of(const Line& line, std::size_t k) {
  std::uint32_t column = line.indent;
  for (std::size_t i = 0; i < k; ++i) column += line.pieces[i].blanks + line.pieces[i].width;
  return column;
}

struct Run {
  std::size_t begin = 0, end = 0;  // lines
};

// Pads the k-th pieces of a run to one column, unless a line would grow too wide.
void line_up(std::vector<Line>& lines, const Run& run, std::size_t k) {
  std::uint32_t column = 0;
  for (std::size_t i = run.begin; i < run.end; ++i) {
    column = std::max(column, column_of(lines[i], k) + 1);
  }
  for (std::size_t i = run.begin; i < run.end; ++i) {
    const std::uint32_t before = column_of(lines[i], k) + lines[i].pieces[k].blanks;
    const std::uint32_t grown = column - before;
    if (lines[i].width() + grown > kWidth) return;
    for (std::size_t j = i + 1; j < lines.size() && lines[j].hangs_from == i; ++j) {
      if (lines[j].width() + grown > kWidth) return;
    }
  }
  for (std::size_t i = run.begin; i < run.end; ++i) {
    const std::uint32_t before = column_of(lines[i], k) + lines[i].pieces[k].blanks;
    lines[i].pieces[k].blanks += column - before;
    for (std::size_t j = i + 1; j < lines.size() && lines[j].hangs_from == i; ++j) {
      lines[j].indent += column - before;
    }
  }
}

void align_pieces(std::vector<Line>& lines, std::size_t k) {
  std::size_t begin = 0;
  while (begin < lines.size()) {
    std::size_t end = begin + 1;
    bool wanted = false;
    while (end < lines.size() && are_neighbours(lines[end - 1], lines[end]) &&
           match(lines[end - 1], lines[end], k)) {
      const Piece& upper = lines[end - 1].pieces[k];
      const Piece& lower = lines[end].pieces[k];
      // A much longer neighbour that stands apart in the source stays apart.
      constexpr std::uint32_t kApart = 10;
      const std::uint32_t above = column_of(lines[end - 1], k), below = column_of(lines[end], k);
      const std::uint32_t difference = above < below ? below - above : above - below;
      if (upper.source_column != lower.source_column && difference > kApart) break;
      wanted |= upper.source_column == lower.source_column &&
                std::max(upper.source_blanks, lower.source_blanks) > 1 &&
                std::min(upper.source_blanks, lower.source_blanks) > 0;
      ++end;
    }
    if (wanted) line_up(lines, {begin, end}, k);
    begin = end;
  }
}

void align_comments(std::vector<Line>& lines) {
  std::size_t begin = 0;
  while (begin < lines.size()) {
    std::size_t end = begin;
    std::uint32_t widest = 0, longest = 0;
    while (end < lines.size() && !lines[end].pieces.empty() && !lines[end].comment.empty() &&
           (end == begin || !lines[end].blank_before)) {
      widest = std::max(widest, lines[end].width());
      longest = std::max(longest, width_of(lines[end].comment));
      ++end;
    }
    if (widest + 2 + longest <= kWidth) {
      for (std::size_t i = begin; i < end; ++i) {
        lines[i].comment_gap = widest + 2 - lines[i].width();
      }
    }
    begin = std::max(end, begin + 1);
  }
}

}  // namespace

void align(std::vector<Line>& lines) {
  // Beyond this many pieces a line is a list, not a table.
  constexpr std::size_t kMostPieces = 40;
  // Only columns that some line was padded at need a look.
  bool padded[kMostPieces] = {};
  for (const Line& line : lines) {
    const std::size_t count = std::min(line.pieces.size(), kMostPieces);
    for (std::size_t k = 1; k < count; ++k) padded[k] |= line.pieces[k].source_blanks > 1;
  }
  for (std::size_t k = 1; k < kMostPieces; ++k) {
    if (padded[k]) align_pieces(lines, k);
  }
  align_comments(lines);
}

}  // namespace probe::format
