// The recursive descent parser's class; private to this folder. Its methods are spread over
// cursor.cpp (tokens), recovery.cpp (errors), leaves.cpp, parser.cpp (the file) and one
// parse_<construct>.cpp for each construct of the language.
//
// Errors: the first one in a statement is reported and sets failed_; from then on at() is false and
// take() does nothing, so every rule runs out without further reports, until the statement loop
// recovers.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/syntax/ast.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/parser.h"

namespace probe::syntax {

class Parser {
 public:
  Parser(const SourceFile& source, const TokenStream& stream, ErrorBudget& errors);
  File run();
  std::vector<TokenRole> take_roles() { return std::move(roles_); }
  // From now on the words that are looked for where a token begins at `offset` are kept.
  void watch(std::uint32_t offset) { watched_at_ = offset; }
  std::vector<std::string_view> take_watched() { return std::move(watched_); }

 private:
  // ---- cursor.cpp ----
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

  // ---- recovery.cpp ----
  // `noun` stands for the expected set in the message when the set is long; the help then lists it.
  std::string_view statement_advice() const;
  void fail_expected(std::string_view noun = "something else");
  bool fail_blank_before_unit();
  void fail(Code code, const Span& span, std::string message);
  Diagnostic* report(Code code, const Span& span, std::string message);
  void fail_too_deep(const Span& span);
  std::string found_text() const;
  void recover(std::uint32_t start);
  bool starts_declaration()
      const;  // first on its line, not right of the declaration before, and a declaration's word
  // Whether a word can begin a statement of a block.
  using Begins = std::function<bool(std::string_view)>;
  static bool any_name(std::string_view) { return true; }
  bool looks_like_unclosed_block(const Begins& begins) const;

  // statement() parses one statement, whose first word is one that `begins` knows.
  template <typename Statement>
  void block(const Begins& begins, Statement statement);
  bool begin_block();
  bool end_block(const Begins& begins, std::uint32_t open);
  void end_statement(std::uint32_t start);

  // A line of keywords.def: a first word, and what reads the rest.
  template <typename Node>
  struct Rule {
    std::string_view word;
    Node (Parser::*parse)();
  };
  // The block of a declaration, by the lines of keywords.def that name it. A word that none has is
  // read by `other`, or is an error that expects `noun`.
  template <typename Stmt>
  std::vector<Stmt> body(std::span<const Rule<Stmt>> rules, std::string_view noun,
                         Stmt (Parser::*other)() = nullptr,
                         bool (Parser::*takes)() const = nullptr);

  // ---- leaves.cpp ----
  Name name();
  std::vector<Name> names();
  Name thing();  // an object, or `fixture.part`, as one name
  std::vector<Name> braced_names();
  std::vector<Name> braced_things();
  Path path();
  Quantity quantity();
  Int integer();
  // A number, or the name of a binder in its place.
  Quantity bound_quantity();
  Int bound_integer();
  Text string();
  TemplateText template_text();
  Point point();
  Pose pose();
  std::vector<Pose> poses();
  std::optional<Name> optional_name_after(std::string_view word);

  template <typename Item>
  auto comma_list(Item item) {
    std::vector<decltype(item())> out;
    do {
      out.push_back(item());
    } while (accept(TokenKind::kComma));
    return out;
  }

  template <typename Item>
  auto braced(Item item) {
    expect(TokenKind::kLeftBrace);
    skip_newlines();
    auto out = comma_list(item);
    skip_newlines();
    expect(TokenKind::kRightBrace);
    return out;
  }

  // ---- parse_dataset.cpp, parse_attribute.cpp ----
  DeclNode dataset_decl();
  RelationsStmt dataset_relations();
  DeclNode attribute_decl();
  DeclNode facts_decl();
  QueryId query();
  QueryId query_and();
  QueryId query_not();
  QueryId add(Query node, std::initializer_list<QueryId> children);

  // ---- parse_object.cpp ----
  DeclNode object_decl();
  DeclNode extend_decl();
  std::vector<ObjectStmt> object_body();
  ObjectStmt object_mesh();
  ObjectStmt object_box();
  ObjectStmt object_density();
  ObjectStmt object_mass();
  ObjectStmt object_damping();
  ObjectStmt object_friction();
  ObjectStmt object_scale();
  ObjectStmt object_paint();
  ObjectStmt object_texture();
  TextureStmt texture(bool has_owner);
  ObjectStmt object_is();
  ObjectStmt object_maybe();
  ObjectStmt object_seen();
  ObjectStmt object_unseen();
  ObjectStmt object_rest();
  ObjectStmt object_region();
  ObjectStmt object_name();
  ObjectStmt object_phrase();
  ObjectStmt object_attribute();

  // ---- parse_robot.cpp ----
  DeclNode robot_decl();
  RobotStmt robot_urdf();
  SignedAxis signed_axis();
  RobotStmt robot_tcp();
  RobotStmt robot_fingers();
  RobotStmt robot_control();
  RobotStmt robot_reach();
  RobotStmt robot_drive();
  RobotStmt robot_grip();
  ControlSetting control_kp();
  ControlSetting control_damping();
  ControlSetting control_output();
  ControlSetting control_null();
  ControlSetting control_uncouple();
  ControlSetting control_ramp();
  ControlSetting control_home();
  ControlSetting control_from();
  ControlSetting control_most();
  ControlSetting control_arm_path();
  ControlSetting control_grip_path();
  Point numbers();  // a point, or one number as a point of one

  // ---- parse_camera.cpp, parse_light.cpp ----
  DeclNode camera_decl();
  CameraStmt camera_mount();
  CameraStmt camera_image();
  CameraStmt camera_lens();
  CameraStmt camera_sensor();
  CameraStmt camera_jitter();
  DeclNode light_decl();
  LightStmt light_ambient();
  LightStmt light_sun();
  LightStmt light_color();
  LightStmt light_spot();
  LightStmt light_headlight();
  LightStmt light_shading();
  void lamp_strength(LampStmt& lamp);

  // ---- parse_fixture.cpp ----
  DeclNode fixture_decl();
  FixtureBodyStmt fixture_urdf();
  FixtureBodyStmt fixture_at();
  FixtureBodyStmt fixture_friction();
  FixtureBodyStmt fixture_joint();
  FixtureBodyStmt fixture_part();
  FixtureBodyStmt fixture_region();
  FixtureBodyStmt fixture_shown();
  RegionStmt region(bool has_owner);
  StartStmt joint_start(bool may_be_bound);

  // ---- parse_scene.cpp ----
  DeclNode scene_decl();
  std::vector<SceneStmt> scene_body();
  SceneStmt scene_robot();
  SceneStmt scene_joints();
  SceneStmt scene_surface();
  SceneStmt scene_fixture();
  SceneStmt scene_region();
  SceneStmt scene_backdrop();
  SceneStmt scene_texture();
  SceneStmt scene_camera();
  SceneStmt scene_light();
  SceneStmt scene_physics();

  // ---- parse_layout.cpp ----
  DeclNode layout_decl();
  LayoutStmt layout_cells();
  LayoutStmt layout_place();
  LayoutStmt layout_orient();
  LayoutStmt layout_starts();
  LayoutStmt layout_jitter();
  LayoutStmt layout_joints();
  LayoutStmt layout_start();
  LayoutStmt layout_drop();
  LayoutStmt layout_expect();

  // ---- parse_template.cpp, parse_predicate.cpp, parse_metrics.cpp ----
  DeclNode template_decl();
  // braces.h
  template <typename Slot, typename Part, typename Read>
  void braced_text(const Text& text, std::vector<Part>& parts, const char* noun, const char* help,
                   Read read);
  DeclNode predicate_decl();
  DeclNode relation_decl();
  PredicateDecl predicate_or_relation(bool is_relation);
  Param param();
  DeclNode metrics_decl();
  MetricStmt metric();
  MetricStmt ends();
  Readout readout();

  // ---- parse_expr.cpp ----
  ExprId expr();
  ExprId expr_and();
  ExprId expr_not();
  ExprId quantified(Quantifier quantifier, std::uint32_t begin);
  ExprId comparison();
  ExprId sum();
  ExprId product();
  ExprId unary();
  ExprId vector_behind(std::uint32_t begin, ExprId x);
  ExprId call_or_name();
  Argument argument();
  ExprId add(Expr node, std::initializer_list<ExprId> children);
  ExprId add_binary(BinaryOp op, const Span& op_span, ExprId left, ExprId right);

  // ---- parse_body_set.cpp ----
  SetExprId set_expr();
  SetExprId set_operand();
  SetExprId add(SetExpr node, std::initializer_list<SetExprId> children);
  std::optional<SetOp> set_operator();

  // ---- parse_task.cpp ----
  DeclNode task_decl();
  DeclNode variant_decl();
  DeclNode variants_decl();
  std::vector<TaskStmt> task_body();
  template <TaskField field>
  TaskStmt task_field();
  TaskStmt task_layout();
  TaskStmt task_scene();
  TaskStmt task_camera();
  TaskStmt task_distractors();
  TaskStmt task_say();
  std::variant<Name, TemplateText> said();
  TaskStmt task_then();
  TaskStmt task_refer();
  TaskStmt task_pose();
  TaskStmt task_start();
  TaskStmt task_solution();
  SkillOperand skill_operand();
  template <plan::Skill kind>
  SkillNode skill();
  SkillNode skill_of(plan::Skill kind);
  TaskStmt task_horizon();
  TaskStmt task_idle();
  TaskStmt task_delay();
  std::variant<Int, Quantity> steps_or_time();
  TaskStmt task_moves();
  TaskStmt task_metric();
  TaskStmt task_role();
  DeclNode role_decl();
  bool is_own_role(std::string_view word) const;
  bool begins_role() const;

  // ---- parse_derive.cpp ----
  DeclNode derive_decl();
  Binder binder();
  std::optional<BinderDeclared::Of> declared_pool();
  BinderNumbers binder_numbers();

  // ---- parse_set.cpp ----
  DeclNode set_decl();
  TaskSetId task_set();
  TaskSetId task_set_without_where();
  TaskSetId task_set_operand();
  // `of SET seed K [with baselines]`, behind how many of what are drawn.
  template <typename Sample>
  void sample_of(Sample& out) {
    expect_word("of");
    out.of = task_set_operand();
    expect_word("seed");
    out.seed = integer();
    if (!accept_word("with")) return;
    expect_word("baselines");
    out.with_baselines = true;
  }
  TaskSetId add(TaskSet node, std::initializer_list<TaskSetId> children);
  CondId cond();
  CondId cond_and();
  CondId cond_not();
  CondId add(Cond node, std::initializer_list<CondId> children);

  // ---- parse_questions.cpp ----
  DeclNode questions_decl();
  template <plan::QuestionForm form>
  QuestionStmt question();
  QuestionText question_text();
  ObjectPool object_pool();
  Answer answer(plan::QuestionForm form);
  void open_call();
  Answer picture_answer();
  Answer yesno_answer();

  // ---- parse_suite.cpp ----
  DeclNode suite_decl();
  SuiteStmt suite_tasks();
  SuiteStmt suite_sample();
  SuiteStmt suite_prefix();
  SuiteStmt suite_seeds();
  SuiteStmt suite_expect();
  SuiteStmt suite_questions();

  // ---- parse_space.cpp ----
  DeclNode space_decl();
  SpaceStmt space_light();
  SpaceStmt space_camera();
  SpaceStmt space_place();
  SpaceStmt space_clutter();
  SpaceStmt space_words();
  SpaceStmt space_sensor();
  SpaceStmt space_delay();
  SpaceRange space_range();
  // Pairs of a word and a range behind commas, each word once.
  void space_ranges(std::initializer_list<std::pair<std::string_view, std::optional<SpaceRange>*>>,
                    std::optional<Quantity>* direction = nullptr);

  // ---- parser.cpp ----
  void declaration();
  DeclNode use_decl();
  DeclNode declaration_node();
  std::vector<std::string_view> docs_before() const;
  Allow allow();
  std::vector<Allow> member_allows_;  // of the declaration that is being read

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

  std::uint32_t watched_at_ = kNoToken;  // an offset
  std::vector<std::string_view> watched_;

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
void Parser::block(const Begins& begins, Statement statement) {
  if (!begin_block()) return;
  const std::uint32_t open = prev_;
  std::vector<std::uint32_t> outer_parens;
  outer_parens.swap(open_parens_);
  while (!end_block(begins, open)) {
    const std::uint32_t start = pos_;
    statement();
    end_statement(start);
  }
  open_parens_.swap(outer_parens);
}

template <typename Stmt>
std::vector<Stmt> Parser::body(std::span<const Rule<Stmt>> rules, std::string_view noun,
                               Stmt (Parser::*other)(), bool (Parser::*takes)() const) {
  std::vector<Stmt> out;
  const auto begins = [&](std::string_view word) {
    return (other != nullptr && takes == nullptr) ||
           std::ranges::find(rules, word, &Rule<Stmt>::word) != rules.end();
  };
  block(begins, [&] {
    const std::uint32_t begin = mark();
    const auto rule = std::ranges::find_if(
        rules, [this](const Rule<Stmt>& known) { return accept_word(known.word); });
    Stmt stmt;
    if (rule != rules.end()) {
      stmt = (this->*rule->parse)();
    } else if (other != nullptr && (takes == nullptr || (this->*takes)())) {
      stmt = (this->*other)();
    } else {
      fail_expected(noun);
    }
    if (failed_) return;
    if constexpr (requires { stmt.span; }) {
      stmt.span = since(begin);
    } else {
      std::visit([&](auto& node) { node.span = since(begin); }, stmt);
    }
    out.push_back(std::move(stmt));
  });
  return out;
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
