// Words for tokens and units.
#include "compiler/syntax/token.h"

#include <array>
#include <string_view>

#include "compiler/syntax/lexer.h"

namespace probe::syntax {
namespace {

struct UnitText {
  Unit unit;
  std::string_view text;
};
constexpr auto kUnits = std::to_array<UnitText>({
#define PROBE_UNIT(id, text, scale, length, time, angle, mass, pixel) {Unit::id, text},
#include "compiler/syntax/units.def"
});

}  // namespace

std::string_view to_text(Unit unit) {
  for (const UnitText& entry : kUnits) {
    if (entry.unit == unit) return entry.text;
  }
  return "";
}

Unit unit_from_text(std::string_view text) {
  for (const UnitText& entry : kUnits) {
    if (entry.text == text) return entry.unit;
  }
  return Unit::kNone;
}

std::string all_units() {
  std::string out;
  for (const UnitText& entry : kUnits) {
    if (!out.empty()) out += ", ";
    out.append("`").append(entry.text).append("`");
  }
  return out;
}

std::string to_text(const TokenStream& stream, const SourceSet& sources) {
  const SourceFile& source = sources.file(stream.file);
  std::string out;
  for (const Token& token : stream.tokens) {
    out += source.text({stream.file, token.begin, token.end});
  }
  return out;
}

bool can_end_statement(TokenKind kind) {
  switch (kind) {
    case TokenKind::kIdent:
    case TokenKind::kNumber:
    case TokenKind::kString:
    case TokenKind::kRightParen:
    case TokenKind::kRightBracket:
    case TokenKind::kRightBrace:
      return true;
    default:
      return false;
  }
}

std::string_view describe(TokenKind kind) {
  switch (kind) {
    case TokenKind::kBlank:
      return "a blank";
    case TokenKind::kNewline:
      return "end of line";
    case TokenKind::kComment:
    case TokenKind::kDocComment:
      return "a comment";
    case TokenKind::kStray:
      return "stray text";
    case TokenKind::kIdent:
      return "a name";
    case TokenKind::kNumber:
      return "a number";
    case TokenKind::kString:
      return "a string";
    case TokenKind::kLeftParen:
      return "`(`";
    case TokenKind::kRightParen:
      return "`)`";
    case TokenKind::kLeftBracket:
      return "`[`";
    case TokenKind::kRightBracket:
      return "`]`";
    case TokenKind::kLeftBrace:
      return "`{`";
    case TokenKind::kRightBrace:
      return "`}`";
    case TokenKind::kComma:
      return "`,`";
    case TokenKind::kSemicolon:
      return "`;`";
    case TokenKind::kColon:
      return "`:`";
    case TokenKind::kDot:
      return "`.`";
    case TokenKind::kDotDot:
      return "`..`";
    case TokenKind::kAt:
      return "`@`";
    case TokenKind::kAssign:
      return "`=`";
    case TokenKind::kLess:
      return "`<`";
    case TokenKind::kLessEqual:
      return "`<=`";
    case TokenKind::kGreater:
      return "`>`";
    case TokenKind::kGreaterEqual:
      return "`>=`";
    case TokenKind::kEqual:
      return "`==`";
    case TokenKind::kNotEqual:
      return "`!=`";
    case TokenKind::kPlus:
      return "`+`";
    case TokenKind::kMinus:
      return "`-`";
    case TokenKind::kStar:
      return "`*`";
    case TokenKind::kSlash:
      return "`/`";
    case TokenKind::kPipe:
      return "`|`";
    case TokenKind::kAmpersand:
      return "`&`";
    case TokenKind::kEnd:
      return "end of file";
  }
  return "";
}

}  // namespace probe::syntax
