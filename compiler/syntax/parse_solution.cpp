// How a task can be solved.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

template <plan::Skill kind>
SkillNode Parser::skill() {
  return skill_of(kind);
}

TaskStmt Parser::task_solution() {
  static constexpr Rule<SkillNode> kRules[] = {
#define PROBE_IN_SOLUTION(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  SolutionStmt out;
  if (accept_word("none")) return out;
  const std::uint32_t begin = mark();
  const bool is_empty =
      kind_ahead(1) == TokenKind::kRightBrace;  // of skills with mistakes one is said
  out.skills = body<SkillNode>(kRules, "a skill");
  if (!failed_ && is_empty)
    fail(Code::P0101, since(begin),
         "a solution without skills; `solution none` leaves it to the expert to find one");
  return out;
}

SkillOperand Parser::skill_operand() {
  SkillOperand out;
  const std::uint32_t begin = mark();
  out.owner = name();
  if (accept(TokenKind::kDot)) out.name = name();
  out.span = since(begin);
  return out;
}

SkillNode Parser::skill_of(plan::Skill kind) {
  SkillStmt out;
  out.skill = kind;
  out.what = skill_operand();
  const auto choose = [&](std::initializer_list<plan::SkillRelation> relations) {
    for (const plan::SkillRelation relation : relations) {
      if (!accept_word(to_text(relation))) continue;
      out.relation = relation;
      return true;
    }
    fail_expected();
    return false;
  };
  using enum plan::SkillRelation;
  switch (plan::info_of(kind).takes) {
    case plan::SkillTakes::kObject:
    case plan::SkillTakes::kPart:
      break;
    case plan::SkillTakes::kObjectPlace:
      if (choose({kOn, kIn, kBeside})) out.to = skill_operand();
      break;
    case plan::SkillTakes::kPartAmount:
      if (choose({kTo, kBy})) out.amount = quantity();
      break;
  }
  return out;
}

}  // namespace probe::syntax
