// Robots.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

DeclNode Parser::robot_decl() {
  static constexpr Rule<RobotStmt> kRules[] = {
#define PROBE_IN_ROBOT(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  advance();
  RobotDecl out;
  out.name = name();
  out.body = body<RobotStmt>(kRules, "a statement of `robot`");
  return out;
}

RobotStmt Parser::robot_urdf() { return UrdfStmt{{}, string()}; }

RobotStmt Parser::robot_tcp() { return TcpStmt{{}, name()}; }

RobotStmt Parser::robot_fingers() {
  FingersStmt out;
  out.fingers = comma_list([this] {
    Finger finger;
    const std::uint32_t begin = mark();
    finger.link = name();
    expect_word("opens");
    set_role(TokenRole::kSign);
    finger.negative = accept(TokenKind::kMinus);
    if (!finger.negative) expect(TokenKind::kPlus);
    finger.axis = name();
    finger.span = since(begin);
    return finger;
  });
  return out;
}

RobotStmt Parser::robot_control() {
  ControlStmt out;
  out.law = name();
  out.rate = quantity();
  return out;
}

RobotStmt Parser::robot_reach() {
  ReachStmt out;
  out.least = quantity();
  expect(TokenKind::kDotDot);
  out.most = quantity();
  return out;
}

RobotStmt Parser::robot_drive() {
  DriveStmt out;
  out.joints = names();
  expect_word("stiffness");
  out.stiffness = quantity();
  expect_word("damping");
  out.damping = quantity();
  expect_word("limit");
  out.limit = quantity();
  return out;
}

RobotStmt Parser::robot_grip() {
  GripStmt out;
  out.closed = quantity();
  expect(TokenKind::kDotDot);
  out.open = quantity();
  if (accept_word("friction")) out.friction = quantity();
  if (accept_word("patch")) out.patch = quantity();
  return out;
}

}  // namespace probe::syntax
