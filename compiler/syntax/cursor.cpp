// The parser's hands: the current token, the newline rule, the expected set, recovery, and the
// leaves of the grammar.
#include <algorithm>
#include <charconv>

#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {
namespace {

// What stands behind `=` in a metric, and seldom in a set of tasks.
bool begins_readout(std::string_view word) {
  return std::ranges::any_of(plan::kReadoutTable, [word](const plan::ReadoutInfo& info) {
    return info.words.substr(0, info.words.find(' ')) == word;
  });
}

bool is_operator(TokenKind kind) {
  return kind >= TokenKind::kLess && kind <= TokenKind::kAmpersand;
}

std::string listed(const std::vector<std::string>& words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) out += i + 1 == words.size() ? " or " : ", ";
    out += words[i];
  }
  return out;
}

}  // namespace

bool is_declaration_word(std::string_view word) {
  static constexpr std::string_view kWords[] = {
#define PROBE_DECL(word) #word,
#include "compiler/syntax/keywords.def"
  };
  return std::find(std::begin(kWords), std::end(kWords), word) != std::end(kWords);
}

// ---- tokens
// ---------------------------------------------------------------------------------------------------------

Parser::Parser(const SourceFile& source, const TokenStream& stream, ErrorBudget& errors)
    : source_(source),
      tokens_(stream.tokens),
      errors_(errors),
      roles_(stream.tokens.size(), TokenRole::kPlain) {
  file_.id = stream.file;
  while (is_trivia(raw_kind())) {
    stray_before_ |= raw_kind() == TokenKind::kStray;
    ++pos_;
  }
}

bool Parser::is_new_line() const {
  if (!newline_before_ || !open_parens_.empty() || prev_ == kNoToken) return false;
  return can_end_statement(tokens_[prev_].kind) ||
         stray_before_;  // stray bytes stand for something that ended it
}

TokenKind Parser::kind() const {
  if (failed_) return TokenKind::kEnd;
  return is_new_line() ? TokenKind::kSemicolon : raw_kind();
}

std::string_view Parser::text_at(std::uint32_t token) const {
  return source_.text().substr(tokens_[token].begin, tokens_[token].end - tokens_[token].begin);
}

Span Parser::span_at(std::uint32_t token) const {
  return {file_.id, tokens_[token].begin, tokens_[token].end};
}

Span Parser::here() const {
  if (is_new_line() && raw_kind() != TokenKind::kEnd)
    return {file_.id, tokens_[prev_].end, tokens_[prev_].end};
  return span_at(pos_);
}

Span Parser::since(std::uint32_t begin) const {
  const std::uint32_t end = prev_ == kNoToken ? begin : tokens_[prev_].end;
  return {file_.id, begin, std::max(begin, end)};
}

std::uint32_t Parser::next_significant(std::uint32_t token) const {
  if (tokens_[token].kind == TokenKind::kEnd) return token;
  do {
    ++token;
  } while (is_trivia(tokens_[token].kind));
  return token;
}

void Parser::advance() {
  expected_count_ = 0;
  if (raw_kind() == TokenKind::kEnd) {
    newline_before_ = false;
    return;
  }
  prev_ = pos_;
  newline_before_ = on_new_line_ = stray_before_ = false;
  for (++pos_; is_trivia(raw_kind()); ++pos_) {
    newline_before_ |= raw_kind() == TokenKind::kNewline;
    stray_before_ |= raw_kind() == TokenKind::kStray;
  }
  on_new_line_ = newline_before_;
}

bool Parser::at(TokenKind wanted) {
  if (kind() == wanted && !failed_) return true;
  if (expected_count_ < kMaxExpected) expected_[expected_count_++] = {wanted, {}};
  return false;
}

bool Parser::at_word(std::string_view word) {
  if (kind() == TokenKind::kIdent && text_at(pos_) == word) return true;
  if (expected_count_ < kMaxExpected) expected_[expected_count_++] = {TokenKind::kIdent, word};
  return false;
}

bool Parser::at_any_word(std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(),
                     [this](std::string_view word) { return at_word(word); });
}

TokenKind Parser::kind_ahead(int ahead) const {
  std::uint32_t token = pos_;
  while (ahead-- > 0) token = next_significant(token);
  return tokens_[token].kind;
}

std::string_view Parser::text_ahead(int ahead) const {
  std::uint32_t token = pos_;
  while (ahead-- > 0) token = next_significant(token);
  return text_at(token);
}

bool Parser::accept(TokenKind wanted) {
  if (!at(wanted)) return false;
  if (wanted == TokenKind::kLeftParen || wanted == TokenKind::kLeftBracket)
    open_parens_.push_back(pos_);
  const bool closes = wanted == TokenKind::kRightParen || wanted == TokenKind::kRightBracket;
  advance();
  if (closes && !open_parens_.empty()) open_parens_.pop_back();
  return true;
}

bool Parser::accept_word(std::string_view word) {
  if (!at_word(word)) return false;
  advance();
  return true;
}

bool Parser::accept_words(std::string_view words) {
  const std::size_t first = std::min(words.find(' '), words.size());
  if (!accept_word(words.substr(0, first))) return false;
  for (words.remove_prefix(first); !words.empty();) {
    words.remove_prefix(1);
    const std::size_t end = std::min(words.find(' '), words.size());
    if (!expect_word(words.substr(0, end))) break;
    words.remove_prefix(end);
  }
  return true;
}

bool Parser::expect(TokenKind wanted) {
  if (accept(wanted)) return true;
  fail_expected();
  return false;
}

bool Parser::expect_word(std::string_view word) {
  if (accept_word(word)) return true;
  fail_expected();
  return false;
}

void Parser::skip_newlines() {
  if (failed_) return;
  while (true) {
    if (raw_kind() == TokenKind::kSemicolon) {
      advance();
    } else if (is_new_line()) {
      newline_before_ = false;
      expected_count_ = 0;
    } else {
      return;
    }
  }
}

// ---- errors and recovery
// --------------------------------------------------------------------------------------------

std::string Parser::found_text() const {
  if (raw_kind() == TokenKind::kEnd) return "end of file";
  if (is_new_line()) return "end of line";
  std::string_view text = text_at(pos_);
  constexpr std::size_t kLongest = 40;
  std::string shown(text.substr(0, kLongest));
  if (text.size() > kLongest) {
    while (!shown.empty() && (static_cast<unsigned char>(text[shown.size()]) & 0xc0u) == 0x80u)
      shown.pop_back();
    shown += "...";
  }
  return "`" + shown + "`";
}

Diagnostic* Parser::report(Code code, const Span& span, std::string message) {
  if (failed_) return nullptr;
  failed_ = true;
  complete_ = false;
  return errors_.report(code, span, std::move(message));
}

void Parser::fail(Code code, const Span& span, std::string message) {
  report(code, span, std::move(message));
}

void Parser::fail_too_deep(const Span& span) {
  too_deep_ = pos_;
  if (Diagnostic* error =
          report(Code::P0103, span,
                 "found more than " + std::to_string(kMaxDepth) + " levels in one another")) {
    error->help("give a part of it a name: a predicate or a set of its own");
  }
}

// A unit apart from its number is the likeliest slip of all.
bool Parser::fail_blank_before_unit() {
  const bool after_number = prev_ != kNoToken && tokens_[prev_].kind == TokenKind::kNumber &&
                            tokens_[prev_].unit == Unit::kNone && !on_new_line_;
  if (!after_number || raw_kind() != TokenKind::kIdent) return false;
  std::uint32_t last = pos_;
  const bool divides =
      tokens_[pos_ + 1].kind == TokenKind::kSlash && tokens_[pos_ + 2].kind == TokenKind::kIdent;
  if (divides &&
      unit_from_text(source_.text(join(span_at(pos_), span_at(pos_ + 2)))) != Unit::kNone)
    last = pos_ + 2;
  const Span unit_span = join(span_at(pos_), span_at(last));
  const std::string unit(source_.text(unit_span));
  if (unit_from_text(unit) == Unit::kNone) return false;
  const Span gap{file_.id, tokens_[prev_].end, tokens_[pos_].begin};
  const std::string whole = std::string(text_at(prev_)) + unit;
  Diagnostic* error = report(Code::P0301, unit_span, "found a blank before unit `" + unit + "`");
  if (error != nullptr)
    error->point("a unit touches its number").fix_by("write `" + whole + "`", gap, "");
  return true;
}

void Parser::fail_expected(std::string_view noun) {
  if (failed_) return;
  if (stray_before_) {  // the stray bytes have been reported and are why the grammar stumbles
    failed_ = true;
    complete_ = false;
    return;
  }
  if (fail_blank_before_unit()) return;
  std::vector<std::string> wanted;
  std::vector<std::string_view> words;
  bool any_operator = false, closes_paren = false;
  std::vector<TokenKind> operators;
  for (std::size_t i = 0; i < expected_count_; ++i) {
    const TokenKind wanted_kind = expected_[i].kind;
    const bool known =
        std::find(operators.begin(), operators.end(), wanted_kind) != operators.end();
    if (is_operator(wanted_kind) && !known) operators.push_back(wanted_kind);
  }
  const bool several_operators = operators.size() > 2;
  for (std::size_t i = 0; i < expected_count_; ++i) {
    const Expected& item = expected_[i];
    closes_paren |= item.kind == TokenKind::kRightParen;
    std::string text;
    if (is_operator(item.kind) && several_operators) {
      if (std::exchange(any_operator, true)) continue;
      text = "an operator";
    } else if (item.kind == TokenKind::kSemicolon) {
      text = "end of line";
    } else if (!item.word.empty()) {
      words.push_back(item.word);
      text = "`" + std::string(item.word) + "`";
    } else {
      text = describe(item.kind);
    }
    if (std::find(wanted.begin(), wanted.end(), text) == wanted.end())
      wanted.push_back(std::move(text));
  }
  const std::string list = listed(wanted);
  constexpr std::size_t kMaxListed = 6;
  const bool is_short = wanted.size() <= kMaxListed;
  const bool is_name = kind() == TokenKind::kIdent;
  const Span span = here();
  std::string message = "found " + found_text() + ", expected ";
  if (is_short) {
    message += list;
  } else {
    message += noun;
  }
  std::optional<std::string_view> meant;
  if (is_name) meant = nearest(text_at(pos_), words);
  // `and` and `or` are words, so a line ends behind them; operators of punctuation carry it on.
  const bool after_word = is_new_line() && (text_at(prev_) == "and" || text_at(prev_) == "or");
  const bool in_paren =
      closes_paren && !open_parens_.empty() &&
      (on_new_line_ || raw_kind() == TokenKind::kRightBrace || raw_kind() == TokenKind::kEnd);
  const Span paren = in_paren ? span_at(open_parens_.back()) : Span{};
  Diagnostic* error = report(Code::P0101, span, std::move(message));
  if (error == nullptr) return;
  if (meant) error->point("did you mean `" + std::string(*meant) + "`?");
  if (in_paren) error->label(paren, "this `(` is not closed");
  if (after_word) error->help("an expression goes on over a line end only inside parentheses");
  if (!is_short) error->help("expected one of " + list);
}

// To the end of the statement that began at `start`, over whole blocks, but not over the `}` of the
// block around it.
void Parser::recover(std::uint32_t start) {
  failed_ = false;
  open_parens_.clear();
  if (pos_ == start && raw_kind() != TokenKind::kRightBrace && raw_kind() != TokenKind::kEnd) {
    if (raw_kind() == TokenKind::kLeftBrace) {
      // Falls through to the loop, which skips the block.
    } else {
      advance();
    }
  }
  std::uint32_t depth = 0;
  while (raw_kind() != TokenKind::kEnd) {
    if (depth == 0 && (kind() == TokenKind::kSemicolon || raw_kind() == TokenKind::kRightBrace))
      return;
    if (depth == 0 && starts_declaration()) return;
    if (raw_kind() == TokenKind::kLeftBrace) ++depth;
    if (raw_kind() == TokenKind::kRightBrace) --depth;
    advance();
  }
}

bool Parser::starts_declaration() const {
  if (raw_kind() != TokenKind::kIdent && raw_kind() != TokenKind::kAt) return false;
  if (prev_ != kNoToken && !on_new_line_) return false;
  const std::uint32_t begin = tokens_[pos_].begin;
  const std::uint32_t column = begin - source_.line_start(source_.line_of(begin));
  if (column > decl_column_) return false;
  return raw_kind() == TokenKind::kAt || is_declaration_word(text_at(pos_));
}

// At a statement's place stands what can only be the next declaration. Where the word is a
// statement of this block too, the tokens behind it decide.
bool Parser::looks_like_unclosed_block(std::initializer_list<std::string_view> statements) const {
  if (!starts_declaration()) return false;
  if (raw_kind() == TokenKind::kAt) return true;
  const bool ambiguous = statements.size() == 0 || std::find(statements.begin(), statements.end(),
                                                             text_at(pos_)) != statements.end();
  if (!ambiguous) return true;
  const std::string_view after = text_ahead(2);
  if (text_at(pos_) == "set" && after == "=") return !begins_readout(text_ahead(3));
  return kind_ahead(2) == TokenKind::kLeftBrace || after == "like" || after == "of" ||
         after == "against";
}

bool Parser::begin_block() {
  if (raw_kind() == TokenKind::kLeftBrace) set_role(TokenRole::kBlock);
  if (accept(TokenKind::kLeftBrace)) return true;
  fail_expected();
  // The head of the declaration has been reported; its block is read all the same if it begins on
  // this line.
  std::uint32_t token = pos_;
  for (; tokens_[token].kind != TokenKind::kLeftBrace; ++token) {
    const TokenKind passed = tokens_[token].kind;
    if (passed == TokenKind::kNewline || passed == TokenKind::kRightBrace ||
        passed == TokenKind::kEnd)
      return false;
  }
  if (on_new_line_ || errors_.is_spent()) return false;
  failed_ = false;
  open_parens_.clear();
  while (pos_ != token) advance();
  advance();
  return true;
}

// Takes the `}`, or gives up on it.
bool Parser::end_block(std::initializer_list<std::string_view> statements, std::uint32_t open) {
  if (failed_) return true;
  skip_newlines();
  if (raw_kind() == TokenKind::kRightBrace) {
    advance();
    return true;
  }
  expected_count_ = 0;
  if (raw_kind() != TokenKind::kEnd && !looks_like_unclosed_block(statements)) return false;
  // A string that swallowed the rest of its line, or nesting that was given up, has swallowed the
  // `}`.
  const auto lies_in_block = [open](std::uint32_t token) {
    return token != kNoToken && token > open;
  };
  const bool swallowed = lies_in_block(unclosed_string_) || lies_in_block(too_deep_);
  if (swallowed || errors_.is_spent()) {
    failed_ = true;
    complete_ = false;
  } else {
    const std::string found = found_text();
    Diagnostic* error = report(Code::P0101, here(), "found " + found + ", expected `}`");
    if (error != nullptr) error->label(span_at(open), "this `{` is not closed");
  }
  block_lost_ = true;
  return true;
}

void Parser::end_statement(std::uint32_t start) {
  if (block_lost_) {
    failed_ = true;
    return;
  }
  const bool at_end = raw_kind() == TokenKind::kEnd;  // the block will say what it misses
  const bool ended = at_end || at(TokenKind::kSemicolon) || at(TokenKind::kRightBrace);
  if (!ended) fail_expected();
  if (!failed_) return;
  complete_ = false;
  if (errors_.is_spent()) return;  // stays failed: everything unwinds
  recover(start);
}

// ---- leaves
// ---------------------------------------------------------------------------------------------------------

Name Parser::name() {
  if (!at(TokenKind::kIdent)) {
    fail_expected();
    return {here(), {}};
  }
  const Name out{span_at(pos_), text_at(pos_)};
  advance();
  return out;
}

std::vector<Name> Parser::names() {
  return comma_list([this] { return name(); });
}

std::vector<Name> Parser::braced_names() {
  expect(TokenKind::kLeftBrace);
  skip_newlines();
  std::vector<Name> out = names();
  skip_newlines();
  expect(TokenKind::kRightBrace);
  return out;
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
  Int out{here(), 0};
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

Role Parser::role() {
  if (accept_word("source")) return Role::kSource;
  expect_word("target");
  return Role::kTarget;
}

std::optional<Name> Parser::optional_name_after(std::string_view word) {
  if (!accept_word(word)) return std::nullopt;
  return name();
}

}  // namespace probe::syntax
