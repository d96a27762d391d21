// One pass over the bytes; every byte ends up in exactly one token.
#include "compiler/syntax/lexer.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>

#include "compiler/syntax/parser.h"
#include "runtime/base/utf8.h"

namespace probe::syntax {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

// The first byte that is NUL or not UTF-8, if any.
std::optional<std::size_t> first_unreadable(std::string_view text) {
  const std::size_t at = std::min(text.find('\0'), find_bad_utf8(text));
  return at < text.size() ? std::optional(at) : std::nullopt;
}

class Lexer {
 public:
  Lexer(const SourceFile& source, FileId id, ErrorBudget& errors)
      : text_(source.text()), id_(id), errors_(errors) {
    tokens_.reserve(text_.size() / 4 + 16);
  }

  std::vector<Token> run() {
    if (text_.starts_with(kByteOrderMark)) push(TokenKind::kBlank, kByteOrderMark.size());
    while (at_ < text_.size()) next();
    push(TokenKind::kEnd, 0);
    return std::move(tokens_);
  }

 private:
  char peek(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  Span span(std::size_t begin, std::size_t end) const {
    return {id_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  }

  Token& push(TokenKind kind, std::size_t bytes) {
    Token token;
    token.begin = static_cast<std::uint32_t>(at_);
    token.end = static_cast<std::uint32_t>(at_ + bytes);
    token.kind = kind;
    at_ += bytes;
    return tokens_.emplace_back(token);
  }

  template <typename Predicate>
  std::size_t run_of(Predicate belongs, std::size_t from = 0) const {
    std::size_t end = at_ + from;
    while (end < text_.size() && belongs(text_[end])) ++end;
    return end - at_;
  }

  void next() {
    const char c = peek();
    if (is_letter(c)) {
      push(TokenKind::kIdent, run_of(is_word));
      return;
    }
    if (is_digit(c)) return number();
    switch (c) {
      case ' ':
      case '\t':
      case '\r':
        return blank();
      case '\n':
        push(TokenKind::kNewline, 1);
        return;
      case '#':
        return comment();
      case '"':
        return string();
      case '(':
        push(TokenKind::kLeftParen, 1);
        return;
      case ')':
        push(TokenKind::kRightParen, 1);
        return;
      case '[':
        push(TokenKind::kLeftBracket, 1);
        return;
      case ']':
        push(TokenKind::kRightBracket, 1);
        return;
      case '{':
        push(TokenKind::kLeftBrace, 1);
        return;
      case '}':
        push(TokenKind::kRightBrace, 1);
        return;
      case ',':
        push(TokenKind::kComma, 1);
        return;
      case ';':
        push(TokenKind::kSemicolon, 1);
        return;
      case ':':
        push(TokenKind::kColon, 1);
        return;
      case '@':
        push(TokenKind::kAt, 1);
        return;
      case '+':
        push(TokenKind::kPlus, 1);
        return;
      case '-':
        push(TokenKind::kMinus, 1);
        return;
      case '*':
        push(TokenKind::kStar, 1);
        return;
      case '/':
        push(TokenKind::kSlash, 1);
        return;
      case '|':
        push(TokenKind::kPipe, 1);
        return;
      case '&':
        push(TokenKind::kAmpersand, 1);
        return;
      case '.':
        return dot();
      case '=':
        return with_equal(TokenKind::kAssign, TokenKind::kEqual);
      case '<':
        return with_equal(TokenKind::kLess, TokenKind::kLessEqual);
      case '>':
        return with_equal(TokenKind::kGreater, TokenKind::kGreaterEqual);
      case '!':
        if (peek(1) == '=') {
          push(TokenKind::kNotEqual, 2);
          return;
        }
        return stray();
      default:
        return stray();
    }
  }

  void with_equal(TokenKind one, TokenKind two) {
    if (peek(1) == '=') {
      push(two, 2);
    } else {
      push(one, 1);
    }
  }

  void blank() {
    if (peek() == '\r' && peek(1) == '\n') {
      push(TokenKind::kNewline, 2);
      return;
    }
    std::size_t end = at_;
    while (end < text_.size()) {
      const char c = text_[end];
      const bool ends_line = c == '\r' && end + 1 < text_.size() && text_[end + 1] == '\n';
      if ((c != ' ' && c != '\t' && c != '\r') || ends_line) break;
      ++end;
    }
    push(TokenKind::kBlank, end - at_);
  }

  // Up to the line ending, which stays outside.
  std::size_t rest_of_line() const {
    const std::string_view rest = text_.substr(at_);
    std::size_t bytes = std::min(rest.find('\n'), rest.size());
    if (bytes < rest.size() && bytes > 0 && rest[bytes - 1] == '\r') --bytes;
    return bytes;
  }

  void comment() {
    const bool doc = peek(1) == '#' && peek(2) != '#';  // a row of # is a ruler, not documentation
    push(doc ? TokenKind::kDocComment : TokenKind::kComment, rest_of_line());
  }

  void dot() {
    if (peek(1) == '.') {
      push(TokenKind::kDotDot, 2);
      return;
    }
    const bool after_word = at_ > 0 && is_word(text_[at_ - 1]);
    if (is_digit(peek(1)) && !after_word) {
      const std::size_t bytes = run_of(is_word, 1);
      const std::string seen(text_.substr(at_, bytes));
      Diagnostic* error = errors_.report(Code::P0101, span(at_, at_ + bytes),
                                         "found `" + seen + "`, expected a digit before the point");
      if (error != nullptr) error->fix_by("write `0" + seen + "`", span(at_, at_), "0");
      const std::size_t begin = at_, first = tokens_.size();
      ++at_;
      number();  // of `.5x` two tokens
      tokens_[first].begin = static_cast<std::uint32_t>(begin);
      return;
    }
    push(TokenKind::kDot, 1);
  }

  void string() {
    // The line's end is looked for on the way: many strings on one long line must not each read the
    // whole of it.
    std::size_t end = at_ + 1;
    const auto at_line_end = [&](std::size_t i) {
      if (i >= text_.size() || text_[i] == '\n') return true;
      return text_[i] == '\r' && i + 1 < text_.size() && text_[i + 1] == '\n';
    };
    while (!at_line_end(end) && text_[end] != '"') {
      if (text_[end] == '\\' && !at_line_end(end + 1)) {
        const char escaped = text_[end + 1];
        if (escaped != '"' && escaped != '\\' && escaped != 'n') unknown_escape(end);
        ++end;
      }
      ++end;
    }
    const bool closed = !at_line_end(end);
    if (!closed) {
      Diagnostic* error = errors_.report(Code::P0105, span(at_, end),
                                         "found end of line, expected `\"` to close the string");
      if (error != nullptr)
        error->point("the string starts here")
            .help("a string stands on one line; `\\n` is a line break in it");
    }
    push(TokenKind::kString, (closed ? end + 1 : end) - at_);
  }

  void unknown_escape(std::size_t at) {
    // A whole character: the byte after the backslash may begin a longer one.
    std::size_t end = at + 2;
    while (end < text_.size() && is_utf8_tail(text_[end])) ++end;
    const std::string seen(text_.substr(at, end - at));
    Diagnostic* error = errors_.report(Code::P0105, span(at, end),
                                       "found `" + seen + "`, expected `\\\"`, `\\\\` or `\\n`");
    if (error != nullptr)
      error->fix_by("write `\\" + seen + "` for a backslash", span(at, at), "\\");
  }

  void number() {
    const std::size_t begin = at_;
    std::size_t end = begin + run_of(is_digit);
    const auto at = [&](std::size_t i) { return i < text_.size() ? text_[i] : '\0'; };
    const auto skip_digits = [&] {
      while (is_digit(at(end))) ++end;
    };
    if (at(end) == '.' && is_digit(at(end + 1))) {
      ++end;
      skip_digits();
    }
    if (at(end) == 'e' || at(end) == 'E') {
      const std::size_t sign = at(end + 1) == '+' || at(end + 1) == '-' ? 1 : 0;
      if (is_digit(at(end + 1 + sign))) {
        end += 1 + sign;
        skip_digits();
      }
    }
    std::size_t word_end = end;
    while (is_word(at(word_end))) ++word_end;
    if (word_end == end) {
      push(TokenKind::kNumber, end - begin);
      return;
    }
    // Compound units (`kg/m3`) first, then plain ones.
    if (at(word_end) == '/' && is_letter(at(word_end + 1))) {
      std::size_t compound_end = word_end + 1;
      while (is_word(at(compound_end))) ++compound_end;
      if (with_unit(begin, end, compound_end)) return;
    }
    if (with_unit(begin, end, word_end)) return;
    if (times_without_blanks(begin, end)) return;
    if (foreign_unit(begin, end)) return;
    // `kg/m4` is one unknown unit, not one that is divided.
    if (at(word_end) == '/' && is_letter(at(word_end + 1))) {
      ++word_end;
      while (is_word(at(word_end))) ++word_end;
    }
    const std::string seen(text_.substr(end, word_end - end));
    Diagnostic* error = errors_.report(Code::P0301, span(begin, word_end),
                                       "unknown unit `" + shortened(seen) + "`");
    if (error != nullptr) error->help("units are " + all_units());
    Token& token = push(TokenKind::kNumber, word_end - begin);
    token.unit = Unit::kUnknown;
    token.unit_size = static_cast<std::uint16_t>(std::min<std::size_t>(word_end - end, 0xffff));
  }

  bool with_unit(std::size_t begin, std::size_t end, std::size_t unit_end) {
    const Unit unit = unit_from_text(text_.substr(end, unit_end - end));
    if (unit == Unit::kNone) return false;
    Token& token = push(TokenKind::kNumber, unit_end - begin);
    token.unit = unit;
    token.unit_size = static_cast<std::uint16_t>(unit_end - end);
    return true;
  }

  // Units that others use, with what to write here instead: one report, with the converted value.
  bool foreign_unit(std::size_t begin, std::size_t end) {
    struct Foreign {
      std::string_view spelling;
      double factor;
      std::string_view ours;
    };
    static constexpr Foreign kForeign[] = {
        {"g/cm3", 1e3, "kg/m3"}, {"g/cm^3", 1e3, "kg/m3"}, {"kg/m^3", 1, "kg/m3"},
        {"inches", 2.54, "cm"},  {"inch", 2.54, "cm"},     {"in", 2.54, "cm"},
        {"ft", 30.48, "cm"},     {"feet", 30.48, "cm"},    {"um", 1e-3, "mm"},
        {"meters", 1, "m"},      {"meter", 1, "m"},        {"metres", 1, "m"},
        {"metre", 1, "m"},       {"CM", 1, "cm"},          {"MM", 1, "mm"},
        {"M", 1, "m"},           {"degrees", 1, "deg"},    {"degree", 1, "deg"},
        {"radians", 1, "rad"},   {"radian", 1, "rad"},     {"seconds", 1, "s"},
        {"second", 1, "s"},      {"secs", 1, "s"},         {"sec", 1, "s"},
        {"us", 1e-3, "ms"},      {"min", 60, "s"},         {"hz", 1, "Hz"},
        {"HZ", 1, "Hz"},         {"kHz", 1e3, "Hz"},       {"pixels", 1, "px"},
        {"pixel", 1, "px"},
    };
    const std::string_view rest = text_.substr(end);
    for (const Foreign& unit : kForeign) {
      const std::size_t size = unit.spelling.size();
      if (!rest.starts_with(unit.spelling) || (rest.size() > size && is_word(rest[size]))) continue;
      double value = 0;
      std::from_chars(text_.data() + begin, text_.data() + end, value);
      char digits[32];
      std::snprintf(digits, sizeof digits, "%.9g", value * unit.factor);
      const std::string ours = digits + std::string(unit.ours);
      const Span place = span(begin, end + size);
      Diagnostic* error =
          errors_.report(Code::P0301, place, "unknown unit `" + std::string(unit.spelling) + "`");
      if (error != nullptr) error->fix_by("write `" + ours + "`", place, ours);
      Token& token = push(TokenKind::kNumber, end + size - begin);
      token.unit = Unit::kUnknown;
      token.unit_size = static_cast<std::uint16_t>(size);
      return true;
    }
    return false;
  }

  // `2x2`, `3cmx3cm`: one report for the whole product, then its pieces as if they had been written
  // apart.
  bool times_without_blanks(std::size_t begin, std::size_t end) {
    const std::string_view rest = text_.substr(begin);
    const std::size_t size =
        std::min(rest.find_first_not_of("0123456789.abcdefghijklmnopqrstuvwxyzHN"), rest.size());
    const std::string_view whole = rest.substr(0, size);
    constexpr std::size_t kLongestProduct = 64;
    if (size > kLongestProduct) return false;
    struct Piece {
      std::size_t begin, digits_end, end;  // offsets in `whole`
    };
    std::vector<Piece> pieces;
    std::string spaced;
    for (std::size_t at = 0; at <= size;) {
      std::size_t stop = std::min(whole.find('x', at), size);
      if (stop + 2 <= size && whole[stop + 1] == '.') return false;
      if (whole.substr(0, stop).ends_with('p'))
        return false;  // px is a unit: leave such products alone
      const std::string_view piece = whole.substr(at, stop - at);
      const std::size_t digits = std::min(piece.find_first_not_of("0123456789."), piece.size());
      const bool last_open = piece.empty() && stop == size && !pieces.empty();
      if (!last_open) {
        const std::string_view number = piece.substr(0, digits);
        if (digits == 0 || number.find('.') != number.rfind('.') || number.ends_with('.'))
          return false;
        if (digits < piece.size() && unit_from_text(piece.substr(digits)) == Unit::kNone)
          return false;
        pieces.push_back({at, at + digits, stop});
        if (!spaced.empty()) spaced += " x ";
        spaced += piece;
      }
      at = stop + 1;
    }
    const bool ends_with_x = whole.ends_with('x');
    if (pieces.size() < 2 && !ends_with_x) return false;
    if (ends_with_x) spaced += " x";
    // The unit is named as it was read: the letters that touch the first number.
    std::size_t unit_end = end;
    while (unit_end < text_.size() && is_letter(text_[unit_end])) ++unit_end;
    Diagnostic* error =
        errors_.report(Code::P0301, span(begin, begin + size),
                       "unknown unit `" + std::string(text_.substr(end, unit_end - end)) + "`");
    if (error != nullptr) {
      error->point("a unit touches its number")
          .fix_by("write `" + spaced + "`", span(begin, begin + size), spaced);
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const Piece& piece = pieces[i];
      Token& token = push(TokenKind::kNumber, piece.end - piece.begin);
      token.unit = unit_from_text(whole.substr(piece.digits_end, piece.end - piece.digits_end));
      token.unit_size = static_cast<std::uint16_t>(piece.end - piece.digits_end);
      if (i + 1 < pieces.size() || ends_with_x) push(TokenKind::kIdent, 1);
    }
    return true;
  }

  static std::string shortened(const std::string& text) {
    constexpr std::size_t kLongest = 40;
    return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
  }

  // Characters no token starts with, taken together with the word they touch: one report.
  void stray() {
    std::size_t end = at_ + 1;
    while (end < text_.size()) {
      const auto byte = static_cast<unsigned char>(text_[end]);
      const bool belongs = byte >= 0x80 || is_word(text_[end]) ||
                           (byte < 0x20 && byte != '\n' && byte != '\r' && byte != '\t') ||
                           std::strchr("!$%'?\\^_`~\x7f", text_[end]) != nullptr;
      if (!belongs) break;
      ++end;
    }
    const std::string_view seen = text_.substr(at_, end - at_);
    std::size_t shown = std::min<std::size_t>(seen.size(), 40);
    while (shown < seen.size() && is_utf8_tail(seen[shown])) ++shown;
    Diagnostic* error = errors_.report(Code::P0101, span(at_, end),
                                       "found `" + std::string(seen.substr(0, shown)) +
                                           "`, expected a name, a number, a string or punctuation");
    if (error != nullptr) {
      const bool quote = seen.front() == '\'' || seen.starts_with("\xe2\x80\x9c") ||
                         seen.starts_with("\xe2\x80\x9d");
      if (quote) {
        error->help("strings are written with `\"`");
      } else if (static_cast<unsigned char>(seen.front()) >= 0x80 || seen.front() == '_') {
        error->help(
            "a name is made of the letters a to z, digits and `_`, and starts with a letter");
      } else if (seen.front() == '!') {
        error->help("negation is written `not`");
      }
    }
    push(TokenKind::kStray, end - at_);
  }

  std::string_view text_;
  FileId id_;
  ErrorBudget& errors_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
};

}  // namespace

Diagnostic* ErrorBudget::report(Code code, const Span& span, std::string message) {
  if (left_ == 0) return nullptr;
  reported_ = true;
  if (--left_ == 0) {
    diagnostics_
        .report(Code::P0107, span, "found too many syntax errors; the rest of the file is not read")
        .help("the earlier errors of this file come first");
    return nullptr;
  }
  return &diagnostics_.report(code, span, std::move(message));
}

LexResult lex(const SourceFile& source, FileId id, ErrorBudget& errors) {
  const std::string_view text = source.text();
  LexResult result;
  result.stream.file = id;
  const auto refuse = [&] {
    const auto size = static_cast<std::uint32_t>(text.size());
    result.stream.tokens = {Token{0, size, TokenKind::kStray}, Token{size, size, TokenKind::kEnd}};
    result.unreadable = true;
  };
  if (text.size() > kMaxSourceBytes) {
    errors.report(Code::P0104, Span{id, 0, 0},
                  "found more than " + std::to_string(kMaxSourceBytes >> 20u) +
                      " MiB, expected the text of a suite");
    refuse();
    return result;
  }
  if (const std::optional<std::size_t> bad = first_unreadable(text)) {
    const auto at = static_cast<std::uint32_t>(*bad);
    const auto byte = static_cast<unsigned char>(text[*bad]);
    constexpr char kHex[] = "0123456789abcdef";
    const std::string seen =
        byte == 0 ? "a NUL byte" : std::string("byte 0x") + kHex[byte >> 4u] + kHex[byte & 15u];
    Diagnostic* error =
        errors.report(Code::P0102, Span{id, at, at + 1}, "found " + seen + ", expected UTF-8 text");
    const bool wide = text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
    if (error != nullptr) {
      error->help(wide ? "this looks like UTF-16: save the file as UTF-8"
                       : "save the file as UTF-8; nothing of it was read");
    }
    refuse();
    return result;
  }
  result.stream.tokens = Lexer(source, id, errors).run();
  return result;
}

}  // namespace probe::syntax
