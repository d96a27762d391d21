// Sets of tasks, and the conditions that choose from them.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {
namespace {

struct CondWord {
  std::string_view word;
  CondKind kind;
};
constexpr CondWord kConds[] = {{"axis", CondKind::kAxis},   {"uses", CondKind::kUses},
                               {"ood", CondKind::kOod},     {"has", CondKind::kHas},
                               {"scene", CondKind::kScene}, {"metrics", CondKind::kMetrics}};

}  // namespace

DeclNode Parser::set_decl() {
  advance();
  SetDecl out;
  out.name = name();
  expect(TokenKind::kAssign);
  out.tasks = task_set();
  return out;
}

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
    expect_word("of");
    const TaskSetId of = task_set_operand();
    return add(TaskSet{since(begin), TaskSetVariants{of}}, {of});
  }
  if (at_word("sample") && kind_ahead(1) == TokenKind::kNumber) {
    advance();
    TaskSetSample out;
    out.count = integer();
    sample_of(out);
    return add(TaskSet{since(begin), out}, {out.of});
  }
  const Name only = name();
  return add(TaskSet{since(begin), TaskSetName{only}}, {});
}

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

}  // namespace probe::syntax
