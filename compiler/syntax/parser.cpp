// The file: declarations one after the other, with their documentation and @allows.
#include "compiler/syntax/parser.h"

#include <algorithm>

#include "compiler/syntax/parser_impl.h"
#include "compiler/syntax/words.h"

namespace probe::syntax {

File Parser::run() {
  while (true) {
    skip_newlines();
    if (raw_kind() == TokenKind::kEnd || errors_.is_spent()) break;
    declaration();
  }
  return std::move(file_);
}

// `##` lines between the declaration before and this token.
std::vector<std::string_view> Parser::docs_before() const {
  std::vector<std::string_view> docs;
  for (std::uint32_t token = pos_;
       token-- > 0 && (is_trivia(tokens_[token].kind) || token == prev_);) {
    if (token == prev_) break;
    if (tokens_[token].kind != TokenKind::kDocComment) continue;
    std::string_view text = text_at(token).substr(2);
    if (text.starts_with(' ')) text.remove_prefix(1);
    docs.push_back(text);
  }
  std::reverse(docs.begin(), docs.end());
  return docs;
}

Allow Parser::allow() {
  Allow out;
  const std::uint32_t begin = mark();
  expect(TokenKind::kAt);
  expect_word("allow");
  set_role(TokenRole::kTightParen);
  expect(TokenKind::kLeftParen);
  out.what = name();
  expect(TokenKind::kComma);
  out.reason = string();
  expect(TokenKind::kRightParen);
  out.span = since(begin);
  return out;
}

void Parser::declaration() {
  Decl decl;
  const std::uint32_t start = pos_;
  complete_ = true;
  block_lost_ = false;
  expected_count_ = 0;
  decl_column_ = mark() - source_.line_start(source_.line_of(mark()));
  decl.docs = docs_before();
  while (!failed_ && raw_kind() == TokenKind::kAt) {
    decl.allows.push_back(allow());
    skip_newlines();
    const std::vector<std::string_view> more = docs_before();
    decl.docs.insert(decl.docs.end(), more.begin(), more.end());
  }
  const std::uint32_t begin = mark();
  bool named = false;
  if (!failed_) {
    expected_count_ = 0;
    named = true;
    decl.node = declaration_node();
  }
  decl.span = since(begin);
  std::ranges::move(member_allows_, std::back_inserter(decl.allows));
  member_allows_.clear();
  const bool at_end = raw_kind() == TokenKind::kEnd;
  if (!failed_ && !at_end && !at(TokenKind::kSemicolon)) {
    fail_expected();
    // Two declarations on one line: the second is read as if the line had been broken.
    if (raw_kind() == TokenKind::kIdent && is_declaration_word(text_at(pos_))) {
      failed_ = false;
      open_parens_.clear();
    }
  }
  decl.complete = complete_;
  // A failed @allow or a word that starts no declaration leaves nothing to keep.
  const bool keeps = named && !std::holds_alternative<UseDecl>(decl.node);
  const bool good_use =
      named && !failed_ && std::holds_alternative<UseDecl>(decl.node) && begin != since(begin).end;
  if (keeps || good_use) file_.decls.push_back(std::move(decl));
  if (!failed_ || errors_.is_spent()) return;
  // What follows belongs to the lost declaration until a line begins with the next one.
  failed_ = false;
  open_parens_.clear();
  if (pos_ == start) advance();
  while (raw_kind() != TokenKind::kEnd && !starts_declaration()) advance();
}

DeclNode Parser::use_decl() {
  advance();
  return UseDecl{string()};
}

DeclNode Parser::declaration_node() {
  static constexpr Rule<DeclNode> kRules[] = {
#define PROBE_DECL(word, parse) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  for (const Rule<DeclNode>& rule : kRules) {
    if (at_word(rule.word)) {
      expected_count_ = 0;
      return (this->*rule.parse)();
    }
  }
  fail_expected("a declaration");
  return UseDecl{};
}

ParseResult parse(const SourceSet& sources, FileId id, Diagnostics& diagnostics) {
  const SourceFile& source = sources.file(id);
  ErrorBudget errors(diagnostics, kMaxSyntaxErrors);
  LexResult lexed = lex(source, id, errors);
  ParseResult result;
  result.tokens = std::move(lexed.stream);
  result.file.id = id;
  if (!lexed.unreadable && !errors.is_spent()) {
    Parser parser(source, result.tokens, errors);
    result.file = parser.run();
    result.tokens.roles = parser.take_roles();
  }
  result.ok = !errors.has_reported();
  return result;
}

std::vector<std::string_view> words_at(const SourceSet& sources, FileId id, std::uint32_t offset) {
  const SourceFile& source = sources.file(id);
  Diagnostics unsaid;
  ErrorBudget errors(unsaid, kMaxSyntaxErrors);
  const LexResult lexed = lex(source, id, errors);
  if (lexed.unreadable || errors.is_spent()) return {};
  Parser parser(source, lexed.stream, errors);
  parser.watch(offset);
  parser.run();
  return parser.take_watched();
}

}  // namespace probe::syntax
