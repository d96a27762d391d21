// Tokens to lines. Lines of the author are kept where the grammar allows a break; a line that grows
// too wide is broken at the best place so far and laid out again from there, so the work stays
// linear. Every break made here lies where the next run finds a line end, which keeps the layout a
// fixed point.
#include <algorithm>
#include <optional>
#include <utility>

#include "compiler/format/format.h"
#include "compiler/format/lines.h"
#include "compiler/syntax/lexer.h"
#include "runtime/base/utf8.h"

namespace probe::format {
namespace {

using syntax::TokenKind;
using syntax::TokenRole;

// A token that the grammar sees, or a comment.
struct Item {
  std::string_view text;
  TokenKind kind = TokenKind::kEnd;
  TokenRole role = TokenRole::kPlain;
  std::uint32_t width = 0;
  std::uint32_t newlines = 0;  // between the item before and this one
  std::uint32_t blanks = 0;    // on its own line
  std::uint32_t column = 0;    // on its own line, from 0
};

bool is_comment(TokenKind kind) {
  return kind == TokenKind::kComment || kind == TokenKind::kDocComment;
}

std::vector<Item> items_of(const SourceFile& source, const syntax::TokenStream& stream) {
  std::vector<Item> items;
  items.reserve(stream.tokens.size() / 2 + 1);
  std::uint32_t newlines = 0, blanks = 0, column = 0;
  for (std::size_t i = 0; i < stream.tokens.size(); ++i) {
    const syntax::Token& token = stream.tokens[i];
    std::string_view text = source.text().substr(token.begin, token.end - token.begin);
    if (token.kind == TokenKind::kNewline) {
      ++newlines;
      blanks = column = 0;
      continue;
    }
    const std::uint32_t width = width_of(text);
    if (token.kind == TokenKind::kBlank || token.kind == TokenKind::kStray) {
      blanks += width;
      column += width;
      continue;
    }
    if (is_comment(token.kind)) text = text.substr(0, text.find_last_not_of(" \t\r\f\v") + 1);
    const TokenRole role = i < stream.roles.size() ? stream.roles[i] : TokenRole::kPlain;
    items.push_back({text, token.kind, role, width_of(text), newlines, blanks, column});
    column += width;
    newlines = blanks = 0;
  }
  return items;
}

struct Bracket {
  enum Kind { kBlock, kFlatBlock, kParen, kSet } kind = kBlock;
  bool tight = false;          // of a set
  bool is_allow = false;       // the `(` of @allow
  bool broken = false;         // a line ends right behind the opening bracket
  std::uint32_t indent = 0;    // of the line it stands on
  std::uint32_t hang = 0;      // column behind it
  std::size_t line = kNoLine;  // the line it stands on
};

class Layouter {
 public:
  explicit Layouter(std::vector<Item> items) : items_(std::move(items)) {}

  std::vector<Line> run() {
    while (state_.next < items_.size()) step();
    flush();
    return std::move(lines_);
  }

 private:
  // All that changes on the way, so that a line can be taken back to a better place to break it.
  struct State {
    std::size_t next = 0;  // item
    std::vector<Bracket> brackets;
    std::size_t previous = kNoItem;  // the last token printed
    std::uint32_t newlines = 0;      // since then, also around dropped `;`
    bool in_statement = false;
    bool separated = false;   // a `;` that counts stands before the next token
    bool must_break = false;  // a comment or an open block ends the line
    bool after_allow = false;
    bool is_long = false;  // the statement goes over several lines
  };
  struct Candidate {
    State state;
    std::size_t pieces = 0;  // of the line, before it
    int score = 0;
    bool is_separator = false;
  };
  static constexpr std::size_t kNoItem = static_cast<std::size_t>(-1);

  bool in_block() const {
    return state_.brackets.empty() || state_.brackets.back().kind == Bracket::kBlock ||
           state_.brackets.back().kind == Bracket::kFlatBlock;
  }
  bool in_flat_block() const {
    return std::any_of(state_.brackets.begin(), state_.brackets.end(),
                       [](const Bracket& b) { return b.kind == Bracket::kFlatBlock; });
  }
  std::uint32_t content_indent() const {
    for (auto it = state_.brackets.rbegin(); it != state_.brackets.rend(); ++it) {
      if (it->kind == Bracket::kBlock) return it->indent + kIndent;
    }
    return 0;
  }

  void step() {
    const Item& item = items_[state_.next];
    if (item.kind == TokenKind::kEnd) {
      ++state_.next;
    } else if (is_comment(item.kind)) {
      comment(item);
    } else if (item.kind == TokenKind::kSemicolon) {
      semicolon(item);
    } else {
      token(item);
    }
  }

  void semicolon(const Item& item) {
    const bool ends = in_block() && state_.previous != kNoItem &&
                      syntax::can_end_statement(items_[state_.previous].kind);
    state_.separated = state_.separated || ends;
    state_.newlines += item.newlines;
    ++state_.next;
  }

  void comment(const Item& item) {
    const std::uint32_t newlines = state_.newlines + item.newlines;
    if (newlines == 0 && !line_.pieces.empty()) {
      line_.comment = item.text;
      flush();
    } else {
      flush();
      mark_broken();
      const bool inside = state_.in_statement && !(in_block() && ends_statement(newlines));
      Line alone;
      alone.indent = content_indent();
      if (inside) alone.indent = continuation_indent(false).first;
      alone.comment = item.text;
      alone.blank_before = !inside && newlines > 1 && !at_block_start();
      lines_.push_back(std::move(alone));
    }
    state_.newlines = 0;
    // What a line end behind the token before would have done, it has done now.
    if (state_.in_statement && in_block() && (state_.separated || newlines > 0) && can_end()) {
      state_.separated = true;
    }
    comment_since_token_ = true;
    state_.must_break = true;
    ++state_.next;
  }

  bool can_end() const {
    return state_.previous != kNoItem && syntax::can_end_statement(items_[state_.previous].kind);
  }
  bool ends_statement(std::uint32_t newlines) const {
    return state_.separated || state_.after_allow || (newlines > 0 && can_end());
  }
  // Nothing but the opening brace, or nothing at all, stands before.
  bool at_block_start() const {
    const bool at_file_start = lines_.empty() && line_.pieces.empty();
    return at_file_start || (!state_.in_statement && !comment_since_token_);
  }

  void token(const Item& item) {
    const std::uint32_t newlines = state_.newlines + item.newlines;
    const bool breaks_in_source = newlines > 0 || state_.must_break;
    if (item.kind == TokenKind::kRightBrace && in_block() && !state_.brackets.empty()) {
      close_block(item);
      return;
    }
    const bool ends = state_.separated || state_.after_allow || (breaks_in_source && can_end());
    if (in_block() && (!state_.in_statement || ends)) {
      start_statement(item, newlines, breaks_in_source);
      return;
    }
    if (breaks_in_source) {
      continue_on_new_line(item);
      return;
    }
    if (line_.pieces.empty()) line_.indent = content_indent();
    offer_break(item);
    append(item, needs_blank(item) ? 1 : 0);
  }

  void close_block(const Item& item) {
    const Bracket bracket = state_.brackets.back();
    const bool empty = items_[state_.previous].role == TokenRole::kBlock && !comment_since_token_;
    if (bracket.kind == Bracket::kBlock && !empty) {
      flush();
      line_.indent = bracket.indent;
      state_.is_long = true;
    }
    state_.brackets.pop_back();
    state_.in_statement = true;
    append(item, line_.pieces.empty() || empty ? 0 : 1);
  }

  void start_statement(const Item& item, std::uint32_t newlines, bool breaks_in_source) {
    const bool flat = in_flat_block();
    const bool first = !state_.in_statement;
    const bool new_line =
        !flat && (breaks_in_source || state_.after_allow || state_.is_long || line_.pieces.empty());
    const bool blank =
        newlines > 1 && !at_block_start() && !(state_.after_allow && !comment_since_token_);
    if (new_line) {
      flush();
      line_.indent = content_indent();
      line_.blank_before = blank && !lines_.empty();
      line_.starts_statement = true;
      state_.is_long = false;
    } else if (!first) {
      if (!flat) offer(kSeparator, true);
      append_semicolon();
    }
    state_.in_statement = true;
    append(item, line_.pieces.empty() ? 0 : 1);
  }

  void continue_on_new_line(const Item& item) {
    const bool closes = is_closing(item.kind);
    mark_broken();
    const auto [indent, hangs_from] = continuation_indent(closes);
    flush();
    line_.indent = indent;
    line_.hangs_from = hangs_from;
    state_.is_long = true;
    append(item, 0);
  }

  // A line ends here: if the last token opened the innermost bracket, right behind it.
  void mark_broken() {
    const bool in_bracket = !state_.brackets.empty() && !in_block();
    if (in_bracket && is_opening(items_[state_.previous].kind))
      state_.brackets.back().broken = true;
  }

  std::pair<std::uint32_t, std::size_t> continuation_indent(bool closes) const {
    if (in_block()) return {content_indent() + kIndent, kNoLine};
    const Bracket& bracket = state_.brackets.back();
    if (closes) return {bracket.indent, kNoLine};
    if (bracket.broken) return {bracket.indent + kIndent, kNoLine};
    constexpr std::uint32_t kFarthestHang = 60;
    if (bracket.hang > kFarthestHang) return {content_indent() + 2 * kIndent, kNoLine};
    return {bracket.hang, bracket.line};
  }

  bool needs_blank(const Item& item) const {
    if (line_.pieces.empty()) return false;
    const Item& before = items_[state_.previous];
    switch (item.kind) {
      case TokenKind::kComma:
      case TokenKind::kColon:
      case TokenKind::kDot:
      case TokenKind::kRightParen:
      case TokenKind::kRightBracket:
        return false;
      case TokenKind::kRightBrace:
        return !state_.brackets.back().tight;
      default:
        break;
    }
    switch (before.kind) {
      case TokenKind::kLeftParen:
      case TokenKind::kLeftBracket:
      case TokenKind::kDot:
      case TokenKind::kAt:
        return false;
      case TokenKind::kLeftBrace:
        return before.role != TokenRole::kTightBrace;
      default:
        break;
    }
    return before.role != TokenRole::kSign && item.role != TokenRole::kTightParen;
  }

  // ---- breaking long lines ----
  static constexpr int kSeparator = 0, kList = 5, kSet = 6, kAssign = 7, kCompare = 8,
                       kOperator = 9;

  // Notes that the line may be broken before `item`, if the grammar goes on over such a line end.
  void offer_break(const Item& item) {
    const Item& before = items_[state_.previous];
    const bool in_paren =
        !state_.brackets.empty() && state_.brackets.back().kind == Bracket::kParen;
    if (before.role == TokenRole::kSign) return;
    switch (before.kind) {
      case TokenKind::kComma:
        return offer(kList, false);
      case TokenKind::kPipe:
      case TokenKind::kAmpersand:
        return offer(kSet, false);
      case TokenKind::kAssign:
      case TokenKind::kColon:
        return offer(kAssign, false);
      case TokenKind::kLess:
      case TokenKind::kLessEqual:
      case TokenKind::kGreater:
      case TokenKind::kGreaterEqual:
      case TokenKind::kEqual:
      case TokenKind::kNotEqual:
        return offer(kCompare, false);
      case TokenKind::kPlus:
      case TokenKind::kMinus:
      case TokenKind::kStar:
      case TokenKind::kSlash:
        return offer(kOperator, false);
      default:
        break;
    }
    if (in_paren && (item.text == "and" || item.text == "or" || item.text == "where")) {
      offer(kList, false);
    }
  }

  void offer(int cost, bool is_separator) {
    if (line_.pieces.empty() || in_flat_block()) return;
    // A break near the start of a line gains little.
    constexpr std::uint32_t kNearStart = 40;
    const bool near_start = !is_separator && width_ < line_.indent + kNearStart;
    const int score = static_cast<int>(state_.brackets.size()) * 10 + cost + (near_start ? 25 : 0);
    if (best_ && best_->score < score) return;
    best_ = Candidate{state_, line_.pieces.size(), score, is_separator};
    best_->state.must_break = true;
  }

  // Takes the line back to the best place so far; the next step breaks there.
  bool take_back() {
    if (!best_) return false;
    line_.pieces.resize(best_->pieces);
    width_ = line_.width();
    state_ = std::move(best_->state);
    best_.reset();
    return true;
  }

  // Whether the block opened by item `at`, which the author wrote on one line, fits on this one
  // with what follows it.
  bool fits_flat(std::size_t at) const {
    std::uint32_t width = width_ + 1;
    std::size_t depth = 0;
    for (std::size_t i = at; i < items_.size(); ++i) {
      const Item& item = items_[i];
      if (depth == 0 && i > at) {
        if (item.newlines > 0 || is_comment(item.kind) || item.kind == TokenKind::kSemicolon ||
            item.kind == TokenKind::kEnd || item.kind == TokenKind::kRightBrace)
          break;
      }
      if (item.kind == TokenKind::kLeftBrace) ++depth;
      if (item.kind == TokenKind::kRightBrace) --depth;
      width += item.width + (i > at && has_blank_in_source_layout(items_[i - 1], item) ? 1 : 0);
      if (width > kWidth) return false;
    }
    return true;
  }
  static bool has_blank_in_source_layout(const Item& before, const Item& item) {
    if (item.kind == TokenKind::kComma || item.kind == TokenKind::kColon ||
        item.kind == TokenKind::kSemicolon || item.kind == TokenKind::kDot ||
        item.kind == TokenKind::kRightParen || item.kind == TokenKind::kRightBracket)
      return false;
    if (before.kind == TokenKind::kLeftParen || before.kind == TokenKind::kLeftBracket ||
        before.kind == TokenKind::kDot || before.kind == TokenKind::kAt)
      return false;
    return before.role != TokenRole::kSign && before.role != TokenRole::kTightBrace &&
           item.role != TokenRole::kTightParen;
  }

  bool is_flat_in_source(std::size_t at) {
    // The end of every block is found once, when the first one is asked for.
    if (flat_.empty()) find_flat_blocks();
    return flat_[at];
  }
  void find_flat_blocks() {
    flat_.assign(items_.size(), false);
    std::vector<std::size_t> open;
    std::vector<std::size_t> lines_at;
    std::size_t lines = 0;
    for (std::size_t i = 0; i < items_.size(); ++i) {
      lines += items_[i].newlines + (is_comment(items_[i].kind) ? 1 : 0);
      if (items_[i].kind == TokenKind::kLeftBrace) {
        open.push_back(i);
        lines_at.push_back(lines);
      } else if (items_[i].kind == TokenKind::kRightBrace && !open.empty()) {
        flat_[open.back()] = lines_at.back() == lines || open.back() + 1 == i;
        open.pop_back();
        lines_at.pop_back();
      }
    }
  }

  // ---- lines ----
  void append_semicolon() {
    line_.pieces.push_back({";", TokenKind::kSemicolon, 1, 0, 0, 0});
    ++width_;
  }

  void append(const Item& item, std::uint32_t blanks) {
    const std::size_t index = state_.next;
    const bool opens_block = item.role == TokenRole::kBlock;
    bool flat = false;
    if (opens_block) {
      flat = in_flat_block() || is_flat_in_source(index);
      const bool empty =
          index + 1 < items_.size() && items_[index + 1].kind == TokenKind::kRightBrace;
      if (flat && !empty && !in_flat_block() && !fits_flat(index)) {
        if (best_ && best_->is_separator && take_back()) return;
        flat = false;
      }
    }
    if (line_.pieces.empty()) width_ = line_.indent;
    const std::uint32_t width = width_ + blanks + item.width;
    const bool too_wide = width > kWidth && !line_.pieces.empty();
    if (too_wide && take_back()) return;
    const bool same_source_line = item.newlines == 0 && !line_.pieces.empty();
    line_.pieces.push_back({item.text, item.kind, item.width, blanks,
                            same_source_line ? item.blanks : 0, item.column});
    width_ = width;
    if (is_opening(item.kind)) {
      Bracket bracket;
      bracket.indent = line_.indent;
      bracket.line = lines_.size();
      bracket.tight = item.role == TokenRole::kTightBrace;
      bracket.hang = width + (item.kind == TokenKind::kLeftBrace && !bracket.tight ? 1 : 0);
      bracket.kind = item.kind != TokenKind::kLeftBrace ? Bracket::kParen
                     : !opens_block                     ? Bracket::kSet
                     : flat                             ? Bracket::kFlatBlock
                                                        : Bracket::kBlock;
      // Above a declaration, or above a member of `variants of`.
      const bool is_above = state_.brackets.empty() ||
                            state_.brackets.back().kind == Bracket::kBlock ||
                            state_.brackets.back().kind == Bracket::kFlatBlock;
      bracket.is_allow = item.role == TokenRole::kTightParen && is_above &&
                         line_.pieces.size() >= 3 &&
                         line_.pieces[line_.pieces.size() - 3].kind == TokenKind::kAt;
      state_.brackets.push_back(bracket);
    }
    state_.after_allow = false;
    if (is_closing(item.kind) && !opens_block && item.kind != TokenKind::kRightBrace) {
      state_.after_allow = state_.brackets.back().is_allow;
      state_.brackets.pop_back();
    } else if (item.kind == TokenKind::kRightBrace && !state_.brackets.empty() &&
               state_.brackets.back().kind == Bracket::kSet) {
      state_.brackets.pop_back();
    }
    state_.previous = index;
    state_.newlines = 0;
    state_.separated = false;
    state_.must_break = opens_block && !flat;
    if (opens_block) state_.in_statement = false;
    comment_since_token_ = false;
    state_.next = index + 1;
  }

  void flush() {
    if (!line_.pieces.empty()) lines_.push_back(std::move(line_));
    line_ = Line();
    best_.reset();
  }

  std::vector<Item> items_;
  std::vector<bool> flat_;
  std::vector<Line> lines_;
  Line line_;
  std::uint32_t width_ = 0;  // of line_
  State state_;
  std::optional<Candidate> best_;
  bool comment_since_token_ = false;
};

}  // namespace

std::uint32_t width_of(std::string_view text) {
  std::uint32_t width = 0;
  for (const char c : text) width += is_utf8_tail(c) ? 0 : 1;
  return width;
}

std::vector<Line> lay_out(const SourceFile& source, const syntax::TokenStream& stream) {
  return Layouter(items_of(source, stream)).run();
}

}  // namespace probe::format
