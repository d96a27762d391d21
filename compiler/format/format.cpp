// Prints laid out lines, and compares two texts by their statements.
#include "compiler/format/format.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "compiler/format/lines.h"
#include "compiler/syntax/lexer.h"

namespace probe::format {
namespace {

using syntax::TokenKind;
using syntax::TokenRole;

// The words of a text with one ";" wherever a statement ends and another begins.
std::vector<std::string_view> statements(const SourceFile& source,
                                         const syntax::TokenStream& stream) {
  std::vector<std::string_view> out;
  struct Bracket {
    bool is_block, is_allow;
  };
  std::vector<Bracket> brackets;
  TokenKind previous = TokenKind::kEnd;
  bool separated = false;
  for (std::size_t i = 0; i < stream.tokens.size(); ++i) {
    const syntax::Token& token = stream.tokens[i];
    if (token.kind == TokenKind::kEnd) break;
    const bool in_block = brackets.empty() || brackets.back().is_block;
    if (token.kind == TokenKind::kNewline || token.kind == TokenKind::kSemicolon) {
      separated = separated || (in_block && syntax::can_end_statement(previous));
      continue;
    }
    if (syntax::is_trivia(token.kind)) continue;
    const bool closes = is_closing(token.kind);
    if (separated && !closes && !out.empty()) out.emplace_back(";");
    separated = false;
    out.push_back(source.text().substr(token.begin, token.end - token.begin));
    previous = token.kind;
    if (is_opening(token.kind)) {
      const bool is_allow = out.size() >= 3 && out[out.size() - 3] == "@";
      brackets.push_back({stream.roles[i] == TokenRole::kBlock, is_allow});
    } else if (closes && !brackets.empty()) {
      // An @allow stands before its declaration with or without a separator.
      separated = brackets.back().is_allow;
      brackets.pop_back();
    }
  }
  return out;
}

}  // namespace

std::string format(const SourceFile& source, const syntax::TokenStream& stream) {
  std::vector<Line> lines = lay_out(source, stream);
  align(lines);
  std::string out;
  out.reserve(source.text().size() + source.text().size() / 8);
  for (const Line& line : lines) {
    if (line.blank_before) out += '\n';
    out.append(line.indent, ' ');
    for (const Piece& piece : line.pieces) {
      out.append(piece.blanks, ' ');
      out += piece.text;
    }
    if (!line.comment.empty()) {
      if (!line.pieces.empty()) out.append(line.comment_gap, ' ');
      out += line.comment;
    }
    out += '\n';
  }
  return out;
}

bool says_the_same(const SourceFile& a, const syntax::TokenStream& a_stream, const SourceFile& b,
                   const syntax::TokenStream& b_stream) {
  return statements(a, a_stream) == statements(b, b_stream);
}

Result<std::optional<std::string>> format_file(const SourceSet& sources, FileId id,
                                               Diagnostics& diagnostics) {
  const syntax::ParseResult parsed = syntax::parse(sources, id, diagnostics);
  if (!parsed.ok) return std::optional<std::string>();
  const SourceFile& source = sources.file(id);
  std::string text = format(source, parsed.tokens);
  SourceSet formatted;
  Diagnostics none;
  const FileId copy = formatted.add(source.name(), text);
  const syntax::ParseResult again = syntax::parse(formatted, copy, none);
  if (!again.ok || !says_the_same(source, parsed.tokens, formatted.file(copy), again.tokens)) {
    return Failure{Fault::kInternal,
                   "the formatted text would not say the same, so nothing is written",
                   source.name()};
  }
  return std::optional<std::string>(std::move(text));
}

}  // namespace probe::format
