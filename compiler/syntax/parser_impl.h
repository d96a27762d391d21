// The recursive descent parser's class; private to this folder. Its methods are spread over
// cursor.cpp (tokens, errors, recovery, leaves), parse_world.cpp, parse_judge.cpp, parse_task.cpp
// and parser.cpp (the file).
//
// Errors: the first one in a statement is reported and sets failed_; from then on at() is false and
// take() does nothing, so every rule runs out without further reports, until the statement loop
// recovers.
#pragma once

#include <array>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/syntax/ast.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/parser.h"

namespace probe::syntax {

bool is_declaration_word(std::string_view word);

class Parser {
 public:
  Parser(const SourceFile& source, const TokenStream& stream, ErrorBudget& errors);
  File run();
  std::vector<TokenRole> take_roles() { return std::move(roles_); }

 private:
  // ---- cursor.cpp: tokens ----
  // What the grammar sees here: a `;` or a newline that counts is kSemicolon, anything after an
  // error kEnd.
  TokenKind kind() const;
  TokenKind raw_kind() const { return tokens_[pos_].kind; }
  bool is_new_line() const;  // a newline that ends a statement stands before the current token
  std::string_view text_at(std::uint32_t token) const;
  Span span_at(std::uint32_t token) const;
  Span here() const;  // of what kind() says
  std::uint32_t mark() const { return tokens_[pos_].begin; }
  void set_role(TokenRole role) { roles_[pos_] = role; }  // of the current token
  Span since(std::uint32_t begin) const;                  // from a mark to the last token taken
  std::uint32_t next_significant(std::uint32_t token) const;
  void advance();

  bool at(TokenKind wanted);
  bool at_word(std::string_view word);
  bool at_any_word(std::initializer_list<std::string_view> words);
  // Looks `ahead` tokens past the current one, over newlines; does not add to the expected set.
  TokenKind kind_ahead(int ahead) const;
  std::string_view text_ahead(int ahead) const;

  bool accept(TokenKind wanted);
  bool accept_word(std::string_view word);
  // Several with one blank between them: once the first is there, the others have to be.
  bool accept_words(std::string_view words);
  bool expect(TokenKind wanted);
  bool expect_word(std::string_view word);
  void skip_newlines();

  // ---- cursor.cpp: errors and recovery ----
  // `noun` stands for the expected set in the message when the set is long; the help then lists it.
  void fail_expected(std::string_view noun = "something else");
  bool fail_blank_before_unit();
  void fail(Code code, const Span& span, std::string message);
  Diagnostic* report(Code code, const Span& span, std::string message);
  void fail_too_deep(const Span& span);
  std::string found_text() const;
  void recover(std::uint32_t start);
  bool starts_declaration()
      const;  // first on its line, not right of the declaration before, and a declaration's word
  bool looks_like_unclosed_block(std::initializer_list<std::string_view> statements) const;

  // statement() parses one statement, whose first word is one of `statements` (empty: any name).
  template <typename Statement>
  void block(std::initializer_list<std::string_view> statements, Statement statement);
  bool begin_block();
  bool end_block(std::initializer_list<std::string_view> statements, std::uint32_t open);
  void end_statement(std::uint32_t start);

  // ---- cursor.cpp: leaves ----
  Name name();
  Name keyword_name(std::string_view what);
  std::vector<Name> names();
  std::vector<Name> braced_names();
  Path path();
  Quantity quantity();
  Int integer();
  Text string();
  TemplateText template_text();
  Point point();
  Pose pose();
  std::vector<Pose> poses();
  Role role();
  std::optional<Name> optional_name_after(std::string_view word);

  template <typename Item>
  auto comma_list(Item item) {
    std::vector<decltype(item())> out;
    do {
      out.push_back(item());
    } while (accept(TokenKind::kComma));
    return out;
  }

  // ---- parse_world.cpp ----
  DeclNode use_decl();
  DeclNode dataset_decl();
  DeclNode attribute_decl();
  DeclNode facts_decl();
  DeclNode object_decl();
  void object_statement(std::vector<ObjectStmt>& body);
  ObjectStmt box_statement();
  ObjectStmt phrase_statement();
  DeclNode robot_decl();
  void robot_statement(std::vector<RobotStmt>& body);
  DeclNode camera_decl();
  void camera_statement(std::vector<CameraStmt>& body);
  DeclNode light_decl();
  void light_statement(std::vector<LightStmt>& body);
  DeclNode scene_decl();
  void scene_statement(std::vector<SceneStmt>& body);
  DeclNode layout_decl();
  void layout_statement(std::vector<LayoutStmt>& body);
  LayoutStmt cells_statement();
  LayoutStmt place_statement();

  QueryId query();
  QueryId query_and();
  QueryId query_not();
  QueryId add(Query node, std::initializer_list<QueryId> children);

  // ---- parse_judge.cpp ----
  DeclNode template_decl();
  DeclNode predicate_decl();
  Param param();
  DeclNode metrics_decl();
  MetricStmt metric();
  Readout readout();
  ExprId expr();
  ExprId expr_and();
  ExprId expr_not();
  ExprId quantified(Quantifier quantifier, std::uint32_t begin);
  ExprId comparison();
  ExprId sum();
  ExprId product();
  ExprId unary();
  ExprId call_or_name();
  Argument argument();
  ExprId add(Expr node, std::initializer_list<ExprId> children);
  ExprId add_binary(BinaryOp op, const Span& op_span, ExprId left, ExprId right);
  SetExprId set_expr();
  SetExprId set_operand();
  SetExprId add(SetExpr node, std::initializer_list<SetExprId> children);

  // ---- parse_task.cpp ----
  DeclNode task_decl();
  DeclNode variant_decl();
  DeclNode variants_decl();
  std::vector<TaskStmt> task_body();
  void task_statement(std::vector<TaskStmt>& body);
  DeclNode derive_decl();
  Binder binder();
  DeclNode set_decl();
  DeclNode suite_decl();
  void suite_statement(std::vector<SuiteStmt>& body);
  TaskSetId task_set();
  TaskSetId task_set_without_where();
  TaskSetId task_set_operand();
  TaskSetId add(TaskSet node, std::initializer_list<TaskSetId> children);
  CondId cond();
  CondId cond_and();
  CondId cond_not();
  CondId add(Cond node, std::initializer_list<CondId> children);
  std::optional<SetOp> set_operator();

  // ---- parser.cpp ----
  void declaration();
  DeclNode declaration_node();
  std::vector<std::string_view> docs_before() const;
  Allow allow();

  template <typename Node, typename Id>
  Id add_node(std::vector<Node>& nodes, std::vector<std::uint16_t>& heights, Node node,
              std::initializer_list<Id> children);

  // Where an id goes when its rule failed: a node that is never looked at, because the declaration
  // is not complete.
  static constexpr std::size_t kMaxExpected = 40;

  const SourceFile& source_;
  const std::vector<Token>& tokens_;
  ErrorBudget& errors_;
  std::vector<TokenRole> roles_;
  File file_;

  std::uint32_t pos_ = 0;          // current significant token
  std::uint32_t prev_ = kNoToken;  // the one before
  bool newline_before_ = false;    // a newline stands between them
  bool on_new_line_ =
      false;  // the current token is the first of its line, even if that newline was skipped
  bool stray_before_ = false;               // bytes that have been reported stand between them
  std::vector<std::uint32_t> open_parens_;  // of the innermost block
  bool failed_ = false;
  bool complete_ = true;           // of the declaration being parsed
  bool block_lost_ = false;        // the closing brace was missing: its statement has no end either
  std::uint32_t decl_column_ = 0;  // bytes before the declaration's first word on its line
  std::uint32_t unclosed_string_ = kNoToken;  // the last one
  std::uint32_t too_deep_ = kNoToken;         // where nesting was given up last
  std::uint32_t nesting_ = 0;

  struct Expected {
    TokenKind kind;
    std::string_view word;  // of a kIdent; empty: any name
  };
  std::array<Expected, kMaxExpected> expected_;
  std::size_t expected_count_ = 0;

  std::vector<std::uint16_t> expr_heights_, set_expr_heights_, query_heights_, task_set_heights_,
      cond_heights_;

  static constexpr std::uint32_t kNoToken = 0xffffffffu;

  friend class NestingGuard;
};

// Counts one level of recursion; `ok` is false where the limit was hit, and the error is reported.
class NestingGuard {
 public:
  explicit NestingGuard(Parser& parser) : parser_(parser) {
    ok = ++parser_.nesting_ <= kMaxDepth;
    if (!ok) parser_.fail_too_deep(parser_.here());
  }
  ~NestingGuard() { --parser_.nesting_; }
  NestingGuard(const NestingGuard&) = delete;
  NestingGuard& operator=(const NestingGuard&) = delete;
  bool ok;

 private:
  Parser& parser_;
};

template <typename Statement>
void Parser::block(std::initializer_list<std::string_view> statements, Statement statement) {
  if (!begin_block()) return;
  const std::uint32_t open = prev_;
  std::vector<std::uint32_t> outer_parens;
  outer_parens.swap(open_parens_);
  while (!end_block(statements, open)) {
    const std::uint32_t start = pos_;
    statement();
    end_statement(start);
  }
  open_parens_.swap(outer_parens);
}

template <typename Node, typename Id>
Id Parser::add_node(std::vector<Node>& nodes, std::vector<std::uint16_t>& heights, Node node,
                    std::initializer_list<Id> children) {
  std::uint16_t height = 1;
  for (const Id child : children) {
    const bool known = child.value < heights.size();
    if (known && heights[child.value] >= height) {
      height = static_cast<std::uint16_t>(heights[child.value] + 1);
    }
  }
  if (height > kMaxDepth) {
    fail_too_deep(node.span);
    height = kMaxDepth;
  }
  nodes.push_back(std::move(node));
  heights.push_back(height);
  return Id{static_cast<std::uint32_t>(nodes.size() - 1)};
}

}  // namespace probe::syntax
