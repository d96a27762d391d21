// The parser's hands: the current token, the newline rule, and what is expected here.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

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
  if (tokens_[pos_].begin == watched_at_ && kind() == TokenKind::kIdent) watched_.push_back(word);
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

}  // namespace probe::syntax
