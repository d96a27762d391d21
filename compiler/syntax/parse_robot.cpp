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
  out.like = optional_name_after("like");
  out.body = body<RobotStmt>(kRules, "a statement of `robot`");
  return out;
}

RobotStmt Parser::robot_urdf() { return UrdfStmt{{}, string()}; }

SignedAxis Parser::signed_axis() {
  SignedAxis out;
  set_role(TokenRole::kSign);
  out.negative = accept(TokenKind::kMinus);
  if (!out.negative) expect(TokenKind::kPlus);
  out.axis = name();
  return out;
}

RobotStmt Parser::robot_tcp() {
  TcpStmt out;
  out.link = name();
  if (accept_word("points")) out.points = signed_axis();
  return out;
}

RobotStmt Parser::robot_fingers() {
  FingersStmt out;
  // A link may be called `none`, too.
  if (at_word("none") && text_ahead(1) != "opens") {
    accept_word("none");
    return out;
  }
  out.fingers = comma_list([this] {
    Finger finger;
    const std::uint32_t begin = mark();
    finger.link = name();
    expect_word("opens");
    finger.opens = signed_axis();
    finger.span = since(begin);
    return finger;
  });
  return out;
}

RobotStmt Parser::robot_control() {
  ControlStmt out;
  static constexpr Rule<ControlSetting> kRules[] = {
#define PROBE_IN_CONTROL(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  out.law = name();
  out.rate = quantity();
  if (at(TokenKind::kLeftBrace)) out.body = body<ControlSetting>(kRules, "a number of `control`");
  return out;
}

Point Parser::numbers() {
  if (at(TokenKind::kLeftParen)) return point();
  const Quantity one = quantity();
  return {one.span, {one}};
}

ControlSetting Parser::control_kp() { return ControlKpStmt{{}, numbers()}; }

ControlSetting Parser::control_damping() { return ControlDampingStmt{{}, numbers()}; }

ControlSetting Parser::control_output() { return ControlOutputStmt{{}, point()}; }

ControlSetting Parser::control_null() { return ControlNullStmt{{}, quantity()}; }

ControlSetting Parser::control_uncouple() { return ControlUncoupleStmt{}; }

ControlSetting Parser::control_ramp() { return ControlRampStmt{{}, quantity()}; }

ControlSetting Parser::control_home() { return ControlHomeStmt{{}, point()}; }

ControlSetting Parser::control_from() { return ControlFromStmt{{}, name()}; }

ControlSetting Parser::control_most() { return ControlMostStmt{{}, quantity()}; }

ControlSetting Parser::control_arm_path() { return ControlPathStmt{{}, true, point()}; }

ControlSetting Parser::control_grip_path() { return ControlPathStmt{{}, false, point()}; }

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
  if (accept_word("stiffness")) out.stiffness = quantity();
  if (accept_word("damping")) out.damping = quantity();
  if (accept_word("limit")) out.limit = quantity();
  if (accept_word("friction")) out.friction = quantity();
  if (accept_word("armature")) out.armature = quantity();
  return out;
}

RobotStmt Parser::robot_grip() {
  GripStmt out;
  out.closed = quantity();
  expect(TokenKind::kDotDot);
  out.open = quantity();
  if (accept_word("friction")) out.friction = quantity();
  if (accept_word("patch")) out.patch = quantity();
  if (accept_word("pace")) out.pace = quantity();
  if (accept_word("stiffness")) out.stiffness = quantity();
  if (accept_word("limit")) out.limit = quantity();
  return out;
}

}  // namespace probe::syntax
