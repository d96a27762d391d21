// What a syntax error says, and where the parser goes on after it.
#include <algorithm>

#include "compiler/syntax/parser_impl.h"
#include "compiler/syntax/words.h"
#include "runtime/base/utf8.h"

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

std::string Parser::found_text() const {
  if (raw_kind() == TokenKind::kEnd) return "end of file";
  if (is_new_line()) return "end of line";
  std::string_view text = text_at(pos_);
  constexpr std::size_t kLongest = 40;
  std::string shown(text.substr(0, kLongest));
  if (text.size() > kLongest) {
    while (!shown.empty() && is_utf8_tail(text[shown.size()])) shown.pop_back();
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

// What was likely meant where a task's statement goes on: several things in a role of one, and words
// without quotes.
std::string_view Parser::statement_advice() const {
  if (prev_ == kNoToken) return {};
  std::uint32_t before = prev_;
  while (before > 0 && is_trivia(tokens_[--before].kind)) {
  }
  const std::string_view word = text_at(before);
  const bool wants_block =
      expected_count_ > 0 && expected_[expected_count_ - 1].kind == TokenKind::kLeftBrace;
  if (wants_block && word == "like") return "a copy has a block, too, if only an empty one: `{ }`";
  if (on_new_line_) return {};
  if (raw_kind() == TokenKind::kComma && (word == "source" || word == "target"))
    return "one thing fills it; `role goods: set` declares a role that several fill: `goods a, b`";
  if (raw_kind() == TokenKind::kIdent && word == "say")
    return "words stand in quotes: `say \"put {the source} on {the target}\"`";
  return {};
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
  if (const std::string_view advice = statement_advice(); !advice.empty())
    error->help(std::string(advice));
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
bool Parser::looks_like_unclosed_block(const Begins& begins) const {
  if (!starts_declaration()) return false;
  if (raw_kind() == TokenKind::kAt) return true;
  if (!begins(text_at(pos_))) return true;
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
bool Parser::end_block(const Begins& begins, std::uint32_t open) {
  if (failed_) return true;
  skip_newlines();
  if (raw_kind() == TokenKind::kRightBrace) {
    advance();
    return true;
  }
  expected_count_ = 0;
  if (raw_kind() != TokenKind::kEnd && !looks_like_unclosed_block(begins)) return false;
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

}  // namespace probe::syntax
