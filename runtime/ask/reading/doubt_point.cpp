// What makes a point doubtful that a rule read.
#include <algorithm>
#include <array>

#include "runtime/ask/reading/read_doubt.h"
#include "runtime/ask/reading/read_letters.h"

namespace probe::ask {
namespace {

// "top left: (1, 2)", "the upper left corner of the carrot": of a box, or of who knows what.
bool is_corner(const Tokens& tokens, std::size_t at) {
  constexpr auto kUpright = std::to_array<std::string_view>({"top", "upper", "bottom", "lower"});
  constexpr auto kSideways = std::to_array<std::string_view>({"left", "right"});
  constexpr auto kWholes = std::to_array<std::string_view>(
      {"of the picture", "of the image", "of the table", "of the frame", "of the scene"});
  if (at + 1 >= tokens.size() || !is_one_of(tokens[at], kUpright)) return false;
  std::size_t next = at + 1;
  if (tokens[next].is_sign('-')) ++next;
  if (next >= tokens.size() || !is_one_of(tokens[next], kSideways)) return false;
  ++next;
  if (next < tokens.size() && tokens[next].is("corner")) ++next;
  // "in the upper left of the picture" says where it lies.
  return std::none_of(kWholes.begin(), kWholes.end(),
                      [&](std::string_view whole) { return stands_phrase(tokens, next, whole); });
}

}  // namespace

bool is_point_doubtful(const ReadContext& context, const AnswerPart& part, const Reading& reading) {
  constexpr auto kOtherUnits = std::to_array<std::string_view>(
      {"normalized", "normalised", "scale", "scaled", "mm", "cm", "meters", "metres", "inches",
       "relative", "origin", "degrees", "size", "large", "dimensions"});
  constexpr auto kOtherFrames = std::to_array<std::string_view>(
      {"from the bottom", "from the lower", "from the right", "from the center", "bottom left of",
       "bottom left corner", "at the bottom left", "lower left corner", "of 1000"});
  if (has_one_of(part.tokens, kOtherUnits) || has_phrase(part.tokens, kOtherFrames) ||
      speaks_against(context, part, 0, part.tokens.size(), reading))
    return true;
  // Shares of the picture may be whole: (0.0, 1.0).
  const auto is_fraction = [](const Token& token) {
    return token.kind == TokenKind::kNumber && token.text.find('.') != std::string::npos;
  };
  if (reading.point && reading.point->x >= 0 && reading.point->x <= 1 && reading.point->y >= 0 &&
      reading.point->y <= 1 && std::ranges::any_of(part.tokens, is_fraction))
    return true;
  for (const std::string_view sign : {"~", ")/", "]/", ") /", "] /", "\u00b1", "\u2248"}) {
    if (part.text.find(sign) != part.text.npos) return true;
  }
  constexpr auto kSizes = std::to_array<std::string_view>({"w", "h", "width", "height"});
  const Tokens& tokens = part.tokens;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const Token& token = tokens[at];
    if (token.is("row") || token.is_sign('?') || is_corner(tokens, at)) return true;
    if (token.is_sign('%') || token.is("percent")) return true;
    const auto sign = [&](std::size_t i, char c) {
      return i < tokens.size() && tokens[i].is_sign(c);
    };
    if (is_one_of(token, kSizes) && (sign(at + 1, ':') || sign(at + 1, '='))) return true;
    if (token.is("y") && sign(at + 1, ',') && at + 2 < tokens.size() && tokens[at + 2].is("x"))
      return true;
    if (token.kind != TokenKind::kNumber) continue;
    if (is_denied(tokens, at)) return true;
    // "120-140", "120 to 140"
    const bool joined = sign(at + 1, '-') || (at + 1 < tokens.size() && tokens[at + 1].is("to"));
    if (joined && at + 2 < tokens.size() && tokens[at + 2].kind == TokenKind::kNumber) return true;
  }
  return false;
}

}  // namespace probe::ask
