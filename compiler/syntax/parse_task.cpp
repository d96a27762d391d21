// Tasks and their variants.
#include <iterator>

#include "compiler/diag/diagnostic.h"
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

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
  block(any_name, [&] {
    VariantsMember member;
    const std::size_t first = member_allows_.size();
    while (!failed_ && raw_kind() == TokenKind::kAt) {
      member_allows_.push_back(allow());
      skip_newlines();
    }
    const std::uint32_t begin = mark();
    member.name = name();
    member.body = task_body();
    member.span = since(begin);
    for (std::size_t i = first; i < member_allows_.size(); ++i)
      member_allows_[i].member = member.span;
    if (!member.name.text.empty()) out.members.push_back(std::move(member));
  });
  return out;
}

template <TaskField field>
TaskStmt Parser::task_field() {
  constexpr bool kIsRole = field == TaskField::kSource || field == TaskField::kTarget;
  return FieldStmt{{}, field, kIsRole ? thing() : name()};
}

TaskStmt Parser::task_scene() {
  std::optional<Name> scene;
  if (!at(TokenKind::kLeftBrace)) scene = name();
  if (scene && !at(TokenKind::kLeftBrace)) return FieldStmt{{}, TaskField::kScene, *scene};
  return TaskSceneStmt{{}, scene, scene_body()};
}

std::vector<TaskStmt> Parser::task_body() {
  static constexpr Rule<TaskStmt> kRules[] = {
#define PROBE_IN_TASK(word, parse, repeat) {#word, &Parser::parse},
#include "compiler/syntax/keywords.def"
  };
  return body<TaskStmt>(kRules, "a statement of a task", &Parser::task_role, &Parser::begins_role);
}

TaskStmt Parser::task_layout() {
  TaskLayoutStmt out;
  out.layout = name();
  if (!accept_word("where")) return out;
  expect_word("clear");
  out.clear = comma_list([this] {
    ClearPhrase phrase;
    phrase.phrase = name();
    expect_word("of");
    phrase.role = name();
    return phrase;
  });
  return out;
}

TaskStmt Parser::task_camera() {
  TaskCameraStmt out;
  out.camera = name();
  out.as = optional_name_after("as");
  return out;
}

TaskStmt Parser::task_distractors() {
  DistractorsStmt out;
  if (at(TokenKind::kNumber) || (text_ahead(1) == "of" && kind_ahead(2) == TokenKind::kLeftParen)) {
    out.count = bound_integer();
    expect_word("of");
    expect(TokenKind::kLeftParen);
    out.objects = names();
    expect(TokenKind::kRightParen);
    expect_word("seed");
    out.seed = bound_integer();
    return out;
  }
  out.objects = comma_list([this] { return thing(); });
  const bool none = out.objects.size() == 1 && out.objects.front().text == "none";
  if (none) out.objects.clear();
  return out;
}

std::variant<Name, TemplateText> Parser::said() {
  if (at(TokenKind::kString)) return template_text();
  return name();
}

TaskStmt Parser::task_say() {
  SayStmt out;
  out.what = said();
  return out;
}

TaskStmt Parser::task_then() {
  ThenStmt out;
  if (accept_word("none")) return out;
  expect_word("say");
  out.what = said();
  expect_word("when");
  const std::uint32_t begin = mark();
  out.when = expr();
  out.when_span = since(begin);
  return out;
}

TaskStmt Parser::task_refer() {
  ReferStmt out;
  out.role = name();
  expect_word("as");
  out.phrase = name();
  return out;
}

TaskStmt Parser::task_pose() {
  PoseStmt out;
  out.object = name();
  out.poses = poses();
  return out;
}

TaskStmt Parser::task_horizon() {
  HorizonStmt out;
  out.how_long = steps_or_time();
  return out;
}

TaskStmt Parser::task_idle() {
  IdleStmt out;
  out.steps = bound_integer();
  expect_word("steps");
  return out;
}

TaskStmt Parser::task_delay() {
  DelayStmt out;
  out.how_long = steps_or_time();
  return out;
}

// A whole number of steps, or a time, whose unit touches its number.
std::variant<Int, Quantity> Parser::steps_or_time() {
  if (at(TokenKind::kMinus) && text_ahead(2) == "steps") {
    fail(Code::P0101, here(), "found " + found_text() + ", expected a number of steps, 0 or more");
    return Int{};
  }
  if (text_ahead(1) != "steps") return bound_quantity();
  const Int steps = bound_integer();
  expect_word("steps");
  return steps;
}

TaskStmt Parser::task_moves() {
  MovesStmt out;
  out.what = name();
  if (accept_word("none")) return out;
  if (accept_word("around")) {
    out.way = plan::Way::kRound;
    out.points.push_back(point());
  } else {
    expect_word("along");
    out.points = comma_list([this] { return point(); });
  }
  expect_word("at");
  out.speed = bound_quantity();
  if (out.way == plan::Way::kRound) return out;
  if (accept_word("once")) out.way = plan::Way::kOnce;
  if (out.way == plan::Way::kBack && accept_word("loop")) out.way = plan::Way::kLoop;
  return out;
}

DeclNode Parser::role_decl() {
  advance();
  RoleDecl out;
  out.name = name();
  if (accept(TokenKind::kColon)) {
    expect_word("set");
    out.is_set = true;
  }
  return out;
}

// Declared in this file, wherever.
bool Parser::is_own_role(std::string_view word) const {
  for (std::size_t i = 0; i + 1 < tokens_.size(); ++i) {
    if (text_at(static_cast<std::uint32_t>(i)) == "role" &&
        text_at(static_cast<std::uint32_t>(i + 1)) == word)
      return true;
  }
  return false;
}

// A word that is no statement's, with a name behind it. One that is nearly a statement's is that
// statement misspelt, unless this file declares a role of that name.
bool Parser::begins_role() const {
  if (kind() != TokenKind::kIdent || kind_ahead(1) != TokenKind::kIdent) return false;
  static constexpr std::string_view kWords[] = {
#define PROBE_IN_TASK(word, parse, repeat) #word,
#include "compiler/syntax/keywords.def"
  };
  const std::vector<std::string_view> words(std::begin(kWords), std::end(kWords));
  return !nearest(text_at(pos_), words) || is_own_role(text_at(pos_));
}

// Which roles there are is known when all files are read.
TaskStmt Parser::task_role() {
  expected_count_ = 0;
  RoleStmt out;
  out.role = name();
  out.objects = comma_list([this] { return thing(); });
  if (out.objects.size() == 1 && out.objects.front().text == "none") out.objects.clear();
  return out;
}

TaskStmt Parser::task_metric() { return metric(); }

}  // namespace probe::syntax
