// The leaves of the grammar: names, numbers, strings, points, poses.
#include <algorithm>
#include <charconv>

#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

Name Parser::name() {
  if (!at(TokenKind::kIdent)) {
    fail_expected();
    return {here(), {}};
  }
  const Name out{span_at(pos_), text_at(pos_)};
  advance();
  return out;
}

Name Parser::thing() {
  const std::uint32_t begin = mark();
  Name out = name();
  // Not in the list of what was expected: a dot is not what is usually missing.
  if (out.text.empty() || kind() != TokenKind::kDot) return out;
  advance();
  const Name part = name();
  if (part.text.empty()) return part;
  out.span = since(begin);
  out.text = {out.text.data(),
              static_cast<std::size_t>(part.text.data() + part.text.size() - out.text.data())};
  return out;
}

std::vector<Name> Parser::names() {
  return comma_list([this] { return name(); });
}

std::vector<Name> Parser::braced_names() {
  return braced([this] { return name(); });
}

std::vector<Name> Parser::braced_things() {
  return braced([this] { return thing(); });
}

Path Parser::path() {
  Path out;
  const std::uint32_t begin = mark();
  do {
    out.parts.push_back(name());
  } while (accept(TokenKind::kDot));
  out.span = since(begin);
  return out;
}

Quantity Parser::quantity() {
  Quantity out;
  const std::uint32_t begin = mark();
  if (raw_kind() == TokenKind::kMinus || raw_kind() == TokenKind::kPlus) {
    out.negative = kind() == TokenKind::kMinus;
    set_role(TokenRole::kSign);
    accept(raw_kind());
  }
  if (!at(TokenKind::kNumber)) {
    fail_expected();
    out.span = here();
    return out;
  }
  const Token& token = tokens_[pos_];
  std::string_view text = text_at(pos_);
  out.digits = text.substr(0, text.size() - token.unit_size);
  out.unit = token.unit;
  advance();
  out.span = since(begin);
  // Said here and not where the statement stumbles over it, so that nobody misses the unit again.
  if (out.unit == Unit::kNone && !on_new_line_ && fail_blank_before_unit()) {
    out.unit = Unit::kUnknown;
  }
  return out;
}

Int Parser::integer() {
  Int out{here(), 0, {}};
  if (!at(TokenKind::kNumber)) {
    fail_expected();
    return out;
  }
  const std::string_view text = text_at(pos_);
  const bool whole = std::all_of(text.begin(), text.end(), is_digit);
  if (!whole) {
    if (tokens_[pos_].unit == Unit::kUnknown) {
      failed_ = true;  // has been reported
      complete_ = false;
    } else {
      fail(Code::P0101, here(), "found " + found_text() + ", expected a whole number without unit");
    }
    return out;
  }
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), out.value);
  if (parsed.ec != std::errc()) {
    fail(Code::P0106, here(), "found " + found_text() + ", expected at most 18446744073709551615");
    return out;
  }
  advance();
  return out;
}

Quantity Parser::bound_quantity() {
  if (!at(TokenKind::kIdent)) return quantity();
  const Name binder = name();
  Quantity out;
  out.span = binder.span;
  out.binder = binder.text;
  return out;
}

Int Parser::bound_integer() {
  if (!at(TokenKind::kIdent)) return integer();
  const Name binder = name();
  return {binder.span, 0, binder.text};
}

Text Parser::string() {
  Text out;
  out.span = here();
  if (!at(TokenKind::kString)) {
    fail_expected();
    return out;
  }
  const std::string_view text = text_at(pos_);
  // A closing quote that is escaped does not close: the lexer ended such a token at the line's end.
  std::size_t end = 1;
  while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
  end = std::min(end, text.size());
  if (end == text.size()) unclosed_string_ = pos_;
  out.raw = text.substr(1, end - 1);
  out.value.reserve(out.raw.size());
  for (std::size_t i = 0; i < out.raw.size(); ++i) {
    if (out.raw[i] == '\\' && i + 1 < out.raw.size()) {
      ++i;
      out.value += out.raw[i] == 'n' ? '\n' : out.raw[i];
    } else {
      out.value += out.raw[i];
    }
  }
  advance();
  return out;
}

Point Parser::point() {
  Point out;
  const std::uint32_t begin = mark();
  if (!accept(TokenKind::kLeftParen)) {
    fail_expected();
    out.span = here();
    return out;
  }
  out.coordinates = comma_list([this] { return quantity(); });
  expect(TokenKind::kRightParen);
  out.span = since(begin);
  return out;
}

Pose Parser::pose() {
  Pose out;
  const std::uint32_t begin = mark();
  do {
    Angle angle;
    const std::uint32_t angle_begin = mark();
    if (accept_word("roll")) {
      angle.turn = Turn::kRoll;
    } else if (accept_word("pitch")) {
      angle.turn = Turn::kPitch;
    } else if (accept_word("yaw")) {
      angle.turn = Turn::kYaw;
    } else {
      fail_expected();
      return out;
    }
    angle.value = quantity();
    angle.span = since(angle_begin);
    out.angles.push_back(std::move(angle));
  } while (at_any_word({"roll", "pitch", "yaw"}));
  out.span = since(begin);
  return out;
}

std::vector<Pose> Parser::poses() {
  return comma_list([this] { return pose(); });
}

std::optional<Name> Parser::optional_name_after(std::string_view word) {
  if (!accept_word(word)) return std::nullopt;
  return name();
}

}  // namespace probe::syntax
