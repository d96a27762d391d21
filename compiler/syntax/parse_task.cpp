// Rules of tasks, variants, derivations, sets of tasks and suites.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {
namespace {

struct FieldWord {
  std::string_view word;
  TaskField field;
};
constexpr FieldWord kFields[] = {{"scene", TaskField::kScene},     {"layout", TaskField::kLayout},
                                 {"source", TaskField::kSource},   {"target", TaskField::kTarget},
                                 {"metrics", TaskField::kMetrics}, {"light", TaskField::kLight}};

struct CondWord {
  std::string_view word;
  CondKind kind;
};
constexpr CondWord kConds[] = {{"axis", CondKind::kAxis},   {"uses", CondKind::kUses},
                               {"ood", CondKind::kOod},     {"has", CondKind::kHas},
                               {"scene", CondKind::kScene}, {"metrics", CondKind::kMetrics}};

}  // namespace

DeclNode Parser::task_decl() {
  TaskDecl out;
  out.abstract = accept_word("abstract");
  expect_word("task");
  out.name = name();
  out.like = optional_name_after("like");
  out.against = optional_name_after("against");
  out.body = task_body();
  return out;
}

DeclNode Parser::variant_decl() {
  advance();
  VariantDecl out;
  out.name = name();
  expect_word("of");
  out.of = name();
  out.against = optional_name_after("against");
  out.body = task_body();
  return out;
}

DeclNode Parser::variants_decl() {
  advance();
  VariantsDecl out;
  expect_word("of");
  out.of = name();
  block({}, [&] {
    VariantsMember member;
    const std::uint32_t begin = mark();
    member.name = name();
    member.body = task_body();
    member.span = since(begin);
    if (!member.name.text.empty()) out.members.push_back(std::move(member));
  });
  return out;
}

std::vector<TaskStmt> Parser::task_body() {
  std::vector<TaskStmt> body;
  block({"scene", "layout", "source", "target", "metrics", "light", "camera", "distractors", "say",
         "refer", "pose", "horizon", "set"},
        [&] { task_statement(body); });
  return body;
}

void Parser::task_statement(std::vector<TaskStmt>& body) {
  const std::uint32_t begin = mark();
  TaskStmt stmt;
  const auto field = [&]() -> bool {
    for (const FieldWord& entry : kFields) {
      if (!accept_word(entry.word)) continue;
      stmt = FieldStmt{{}, entry.field, name()};
      return true;
    }
    return false;
  };
  if (field()) {
  } else if (accept_word("camera")) {
    TaskCameraStmt camera;
    camera.camera = name();
    camera.as = optional_name_after("as");
    stmt = camera;
  } else if (accept_word("distractors")) {
    DistractorsStmt distractors;
    distractors.objects = names();
    const bool none = distractors.objects.size() == 1 && distractors.objects.front().text == "none";
    if (none) distractors.objects.clear();
    stmt = std::move(distractors);
  } else if (accept_word("say")) {
    SayStmt say;
    if (at(TokenKind::kString)) {
      say.what = template_text();
    } else {
      say.what = name();
    }
    stmt = std::move(say);
  } else if (accept_word("refer")) {
    ReferStmt refer;
    refer.role = role();
    expect_word("as");
    refer.phrase = name();
    stmt = refer;
  } else if (accept_word("pose")) {
    PoseStmt posed;
    posed.object = name();
    posed.poses = poses();
    stmt = std::move(posed);
  } else if (accept_word("horizon")) {
    HorizonStmt horizon;
    horizon.steps = integer();
    expect_word("steps");
    stmt = horizon;
  } else if (accept_word("set")) {
    stmt = metric();
  } else {
    fail_expected("a statement of a task");
  }
  if (failed_) return;
  std::visit([&](auto& node) { node.span = since(begin); }, stmt);
  body.push_back(std::move(stmt));
}

DeclNode Parser::derive_decl() {
  advance();
  DeriveDecl out;
  out.name = template_text();
  expect_word("for");
  out.binders = comma_list([this] { return binder(); });
  if (accept_word("where")) out.where = cond();
  out.body = task_body();
  return out;
}

Binder Parser::binder() {
  Binder out;
  const std::uint32_t begin = mark();
  out.name = name();
  expect_word("in");
  const bool clear = at_word("clear") && text_ahead(1) == "phrases" && text_ahead(3) == "of";
  if (clear ||
      (at_word("phrases") && kind_ahead(1) == TokenKind::kIdent && text_ahead(2) == "of")) {
    advance();
    if (clear) advance();
    BinderPhrases phrases;
    phrases.clear = clear;
    phrases.axis = name();
    expect_word("of");
    phrases.role = role();
    out.over = phrases;
  } else if (at_word("templates") && text_ahead(1) == "of") {
    advance();
    advance();
    out.over = BinderTemplates{name()};
  } else if (at_word("distractors") && text_ahead(1) == "of") {
    advance();
    advance();
    out.over = BinderDistractors{name()};
  } else if (at_word("objects") && kind_ahead(1) == TokenKind::kLeftParen) {
    advance();
    advance();
    out.over = BinderObjects{names()};
    expect(TokenKind::kRightParen);
  } else {
    out.over = BinderTasks{task_set_without_where()};
  }
  out.span = since(begin);
  return out;
}

DeclNode Parser::set_decl() {
  advance();
  SetDecl out;
  out.name = name();
  expect(TokenKind::kAssign);
  out.tasks = task_set();
  return out;
}

// ---- sets of tasks
// --------------------------------------------------------------------------------------------------

TaskSetId Parser::add(TaskSet node, std::initializer_list<TaskSetId> children) {
  return add_node(file_.task_sets, task_set_heights_, std::move(node), children);
}

TaskSetId Parser::task_set() {
  const std::uint32_t begin = mark();
  const TaskSetId set = task_set_without_where();
  if (!accept_word("where")) return set;
  const CondId condition = cond();
  if (failed_) return {};
  return add(TaskSet{since(begin), TaskSetWhere{set, condition}}, {set});
}

TaskSetId Parser::task_set_without_where() {
  const std::uint32_t begin = mark();
  TaskSetId left = task_set_operand();
  while (const std::optional<SetOp> op = set_operator()) {
    const TaskSetId right = task_set_operand();
    if (failed_) return {};
    left = add(TaskSet{since(begin), TaskSetBinary{*op, left, right}}, {left, right});
  }
  return left;
}

TaskSetId Parser::task_set_operand() {
  const NestingGuard guard(*this);
  if (!guard.ok) return {};
  const std::uint32_t begin = mark();
  if (accept(TokenKind::kLeftParen)) {
    const TaskSetId inner = task_set();
    expect(TokenKind::kRightParen);
    return inner;
  }
  if (at(TokenKind::kLeftBrace)) {
    TaskSetNames out{braced_names()};
    return add(TaskSet{since(begin), std::move(out)}, {});
  }
  if (at_word("variants") && text_ahead(1) == "of") {
    advance();
    advance();
    const TaskSetId of = task_set_operand();
    return add(TaskSet{since(begin), TaskSetVariants{of}}, {of});
  }
  if (at_word("sample") && kind_ahead(1) == TokenKind::kNumber) {
    advance();
    TaskSetSample out;
    out.count = integer();
    expect_word("of");
    out.of = task_set_operand();
    expect_word("seed");
    out.seed = integer();
    return add(TaskSet{since(begin), out}, {out.of});
  }
  const Name only = name();
  return add(TaskSet{since(begin), TaskSetName{only}}, {});
}

// ---- conditions on tasks
// --------------------------------------------------------------------------------------------

CondId Parser::add(Cond node, std::initializer_list<CondId> children) {
  return add_node(file_.conds, cond_heights_, std::move(node), children);
}

CondId Parser::cond() {
  const std::uint32_t begin = mark();
  CondId left = cond_and();
  while (accept_word("or")) {
    const CondId right = cond_and();
    if (failed_) return {};
    left = add(Cond{since(begin), CondOr{left, right}}, {left, right});
  }
  return left;
}

CondId Parser::cond_and() {
  const std::uint32_t begin = mark();
  CondId left = cond_not();
  while (accept_word("and")) {
    const CondId right = cond_not();
    if (failed_) return {};
    left = add(Cond{since(begin), CondAnd{left, right}}, {left, right});
  }
  return left;
}

CondId Parser::cond_not() {
  const NestingGuard guard(*this);
  if (!guard.ok) return {};
  const std::uint32_t begin = mark();
  if (accept_word("not")) {
    const CondId operand = cond_not();
    if (failed_) return {};
    return add(Cond{since(begin), CondNot{operand}}, {operand});
  }
  if (accept(TokenKind::kLeftParen)) {
    const CondId inner = cond();
    expect(TokenKind::kRightParen);
    return inner;
  }
  for (const CondWord& entry : kConds) {
    if (!accept_word(entry.word)) continue;
    CondTest test{entry.kind, path()};
    return add(Cond{since(begin), std::move(test)}, {});
  }
  fail_expected();
  return {};
}

// ---- suites
// ---------------------------------------------------------------------------------------------------------

DeclNode Parser::suite_decl() {
  advance();
  SuiteDecl out;
  out.name = name();
  if (accept_word("trained")) {
    expect_word("on");
    out.trained_on = name();
  }
  block({"tasks", "prefix", "seeds", "expect"}, [&] { suite_statement(out.body); });
  return out;
}

void Parser::suite_statement(std::vector<SuiteStmt>& body) {
  const std::uint32_t begin = mark();
  SuiteStmt stmt;
  if (accept_word("tasks")) {
    stmt = SuiteTasksStmt{{}, task_set()};
  } else if (accept_word("prefix")) {
    stmt = PrefixStmt{{}, string()};
  } else if (accept_word("seeds")) {
    stmt = SeedsStmt{{}, comma_list([this] { return integer(); })};
  } else if (accept_word("expect")) {
    ExpectTasksStmt expected;
    expected.tasks = integer();
    expect_word("tasks");
    expect(TokenKind::kComma);
    expected.episodes = integer();
    expect_word("episodes");
    stmt = expected;
  } else {
    fail_expected("a statement of `suite`");
  }
  if (failed_) return;
  std::visit([&](auto& node) { node.span = since(begin); }, stmt);
  body.push_back(std::move(stmt));
}

}  // namespace probe::syntax
