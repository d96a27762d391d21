// Cameras.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

DeclNode Parser::camera_decl() {
  static constexpr Rule<CameraStmt> kRules[] = {
#define PROBE_IN_CAMERA(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  advance();
  CameraDecl out;
  out.name = name();
  out.like = optional_name_after("like");
  out.body = body<CameraStmt>(kRules, "a statement of `camera`");
  return out;
}

CameraStmt Parser::camera_mount() {
  MountStmt out;
  out.frame = path();
  expect_word("at");
  out.at = point();
  out.kind = accept_word("quat") ? MountKind::kQuat : MountKind::kLook;
  if (out.kind == MountKind::kLook) expect_word("look");
  out.direction = point();
  return out;
}

CameraStmt Parser::camera_image() {
  ImageStmt out;
  out.width = integer();
  expect_word("x");
  out.height = integer();
  if (accept_word("samples")) out.samples = integer();
  return out;
}

CameraStmt Parser::camera_lens() {
  return LensStmt{{}, comma_list([this] { return quantity(); })};
}

// In any order, each once.
CameraStmt Parser::camera_sensor() {
  SensorStmt out;
  const auto number = [&](std::string_view word, std::optional<Quantity>& to) {
    if (to || !accept_word(word)) return false;
    to = quantity();
    return true;
  };
  const auto patch = [&] {
    if (out.patch_low || !accept_word("patch")) return false;
    out.patch_low = point();
    expect(TokenKind::kDotDot);
    out.patch_high = point();
    return true;
  };
  const auto mirror = [&] { return !out.mirrored && (out.mirrored = accept_word("mirrored")); };
  if (accept_word("none")) return out;
  bool any = false;
  while (number("noise", out.noise) || number("blur", out.blur) ||
         number("exposure", out.exposure) || patch() || number("dropped", out.dropped) ||
         mirror()) {
    any = true;
  }
  if (!any) fail_expected();
  return out;
}

CameraStmt Parser::camera_jitter() {
  CameraJitterStmt out;
  out.place = quantity();
  out.turn = quantity();
  return out;
}

}  // namespace probe::syntax
