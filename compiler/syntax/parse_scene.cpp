// Scenes.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

std::vector<SceneStmt> Parser::scene_body() {
  static constexpr Rule<SceneStmt> kRules[] = {
#define PROBE_IN_SCENE(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  return body<SceneStmt>(kRules, "a statement of `scene`");
}

DeclNode Parser::scene_decl() {
  advance();
  SceneDecl out;
  out.name = name();
  out.like = optional_name_after("like");
  out.body = scene_body();
  return out;
}

SceneStmt Parser::scene_robot() {
  SceneRobotStmt out;
  const bool is_place = at_word("at") && kind_ahead(1) == TokenKind::kLeftParen;
  if (!is_place) out.robot = name();
  if (!accept_word("at")) return out;
  out.at = point();
  expect_word("yaw");
  out.yaw = quantity();
  return out;
}

SceneStmt Parser::scene_joints() { return JointsStmt{{}, point()}; }

SceneStmt Parser::scene_surface() {
  SurfaceStmt out;
  out.height = quantity();
  expect_word("area");
  out.low = point();
  expect(TokenKind::kDotDot);
  out.high = point();
  return out;
}

SceneStmt Parser::scene_fixture() {
  if (at(TokenKind::kIdent)) return SceneFixturesStmt{{}, names()};
  FixtureStmt out;
  out.mesh = string();
  expect_word("at");
  out.at = point();
  return out;
}

SceneStmt Parser::scene_region() { return region(true); }

SceneStmt Parser::scene_backdrop() {
  BackdropStmt out{{}, string()};
  out.stands = accept_word("stands");
  return out;
}

SceneStmt Parser::scene_texture() { return texture(true); }

SceneStmt Parser::scene_camera() {
  SceneCameraStmt out;
  out.cameras = comma_list([this] {
    SceneCamera camera;
    camera.camera = name();
    camera.as = optional_name_after("as");
    if (accept_word("overlay")) camera.overlay = string();
    return camera;
  });
  return out;
}

SceneStmt Parser::scene_light() { return UseLightStmt{{}, name()}; }

SceneStmt Parser::scene_physics() {
  PhysicsStmt out;
  out.rate = quantity();
  expect_word("friction");
  out.friction = quantity();
  if (accept_word("air")) out.air = quantity();
  if (accept_word("viscosity")) out.viscosity = quantity();
  out.window_step = accept_word("window");
  if (out.window_step) expect_word("step");
  return out;
}

}  // namespace probe::syntax
