// Rules of the world: datasets, attributes, objects, robots, cameras, lights, scenes, layouts.
#include "compiler/syntax/parser_impl.h"

namespace probe::syntax {

DeclNode Parser::use_decl() {
  advance();
  return UseDecl{string()};
}

DeclNode Parser::dataset_decl() {
  advance();
  DatasetDecl out;
  out.name = name();
  out.title = string();
  if (!at(TokenKind::kLeftBrace)) return out;
  block({"relations"}, [&] {
    RelationsStmt stmt;
    const std::uint32_t begin = mark();
    expect_word("relations");
    stmt.relations = comma_list([this] {
      Relation relation;
      const std::uint32_t start = mark();
      relation.subject = name();
      relation.preposition = name();
      relation.object = name();
      relation.span = since(start);
      return relation;
    });
    stmt.span = since(begin);
    if (!failed_) out.body.push_back(std::move(stmt));
  });
  return out;
}

DeclNode Parser::attribute_decl() {
  advance();
  AttributeDecl out;
  out.name = name();
  out.values = braced_names();
  return out;
}

DeclNode Parser::facts_decl() {
  advance();
  return FactsDecl{braced_names()};
}

// ---- objects
// --------------------------------------------------------------------------------------------------------

DeclNode Parser::object_decl() {
  advance();
  ObjectDecl out;
  out.name = name();
  out.like = optional_name_after("like");
  block({}, [&] { object_statement(out.body); });
  return out;
}

void Parser::object_statement(std::vector<ObjectStmt>& body) {
  const std::uint32_t begin = mark();
  ObjectStmt stmt;
  if (accept_word("mesh")) {
    stmt = MeshStmt{{}, string()};
  } else if (accept_word("box")) {
    stmt = box_statement();
  } else if (accept_word("density")) {
    stmt = DensityStmt{{}, quantity()};
  } else if (accept_word("friction")) {
    stmt = FrictionStmt{{}, quantity()};
  } else if (accept_word("is")) {
    stmt = IsStmt{{}, names()};
  } else if (accept_word("maybe")) {
    stmt = MaybeStmt{{}, names()};
  } else if (accept_word("seen")) {
    expect_word("in");
    stmt = SeenInStmt{{}, names()};
  } else if (accept_word("unseen")) {
    stmt = UnseenStmt{};
  } else if (accept_word("rest")) {
    stmt = RestStmt{{}, poses()};
  } else if (accept_word("name")) {
    NameStmt named{{}, string(), false};
    named.bare = accept_word("bare");
    stmt = std::move(named);
  } else if (accept_word("phrase")) {
    stmt = phrase_statement();
  } else {
    expected_count_ = 0;  // any attribute may stand here: the list of words would mislead
    AttributeStmt attribute;
    attribute.attribute = name();
    attribute.values = names();
    stmt = std::move(attribute);
  }
  if (failed_) return;
  std::visit([&](auto& node) { node.span = since(begin); }, stmt);
  body.push_back(std::move(stmt));
}

ObjectStmt Parser::box_statement() {
  if (at(TokenKind::kLeftParen)) {
    BoxCornersStmt out;
    out.low = point();
    expect(TokenKind::kDotDot);
    out.high = point();
    return out;
  }
  BoxSizeStmt out;
  out.x = quantity();
  expect_word("x");
  out.y = quantity();
  expect_word("x");
  out.z = quantity();
  return out;
}

ObjectStmt Parser::phrase_statement() {
  PhraseStmt out;
  out.name = name();
  out.axis = name();
  out.text = string();
  out.bare = accept_word("bare");
  expect_word("means");
  out.means = query();
  return out;
}

QueryId Parser::add(Query node, std::initializer_list<QueryId> children) {
  return add_node(file_.queries, query_heights_, std::move(node), children);
}

QueryId Parser::query() {
  const std::uint32_t begin = mark();
  QueryId left = query_and();
  while (accept_word("or")) {
    const QueryId right = query_and();
    left = add(Query{since(begin), QueryOr{left, right}}, {left, right});
  }
  return left;
}

QueryId Parser::query_and() {
  const std::uint32_t begin = mark();
  QueryId left = query_not();
  while (accept_word("and")) {
    const QueryId right = query_not();
    left = add(Query{since(begin), QueryAnd{left, right}}, {left, right});
  }
  return left;
}

QueryId Parser::query_not() {
  const NestingGuard guard(*this);
  if (!guard.ok) return {};
  const std::uint32_t begin = mark();
  if (accept_word("not")) {
    const QueryId operand = query_not();
    return add(Query{since(begin), QueryNot{operand}}, {operand});
  }
  if (accept(TokenKind::kLeftParen)) {
    const QueryId inner = query();
    expect(TokenKind::kRightParen);
    return inner;
  }
  const Name first = name();
  const std::string_view next = kind() == TokenKind::kIdent ? text_at(pos_) : std::string_view();
  if (next.empty() || next == "and" || next == "or" || next == "not") {
    return add(Query{since(begin), QueryFact{first}}, {});
  }
  const Name value = name();
  return add(Query{since(begin), QueryValue{first, value}}, {});
}

// ---- robots, cameras, lights
// ----------------------------------------------------------------------------------------

DeclNode Parser::robot_decl() {
  advance();
  RobotDecl out;
  out.name = name();
  block({"urdf", "tcp", "fingers", "control", "reach", "drive", "grip"},
        [&] { robot_statement(out.body); });
  return out;
}

void Parser::robot_statement(std::vector<RobotStmt>& body) {
  const std::uint32_t begin = mark();
  RobotStmt stmt;
  if (accept_word("urdf")) {
    stmt = UrdfStmt{{}, string()};
  } else if (accept_word("tcp")) {
    stmt = TcpStmt{{}, name()};
  } else if (accept_word("fingers")) {
    stmt = FingersStmt{{}, comma_list([this] {
                         Finger finger;
                         const std::uint32_t start = mark();
                         finger.link = name();
                         expect_word("opens");
                         set_role(TokenRole::kSign);
                         finger.negative = accept(TokenKind::kMinus);
                         if (!finger.negative) expect(TokenKind::kPlus);
                         finger.axis = name();
                         finger.span = since(start);
                         return finger;
                       })};
  } else if (accept_word("control")) {
    ControlStmt control;
    control.law = name();
    control.rate = quantity();
    stmt = std::move(control);
  } else if (accept_word("reach")) {
    ReachStmt reach;
    reach.least = quantity();
    expect(TokenKind::kDotDot);
    reach.most = quantity();
    stmt = std::move(reach);
  } else if (accept_word("drive")) {
    DriveStmt drive;
    drive.joints = names();
    expect_word("stiffness");
    drive.stiffness = quantity();
    expect_word("damping");
    drive.damping = quantity();
    expect_word("limit");
    drive.limit = quantity();
    stmt = std::move(drive);
  } else if (accept_word("grip")) {
    GripStmt grip;
    grip.closed = quantity();
    expect(TokenKind::kDotDot);
    grip.open = quantity();
    if (accept_word("friction")) grip.friction = quantity();
    if (accept_word("patch")) grip.patch = quantity();
    stmt = std::move(grip);
  } else {
    fail_expected("a statement of `robot`");
  }
  if (failed_) return;
  std::visit([&](auto& node) { node.span = since(begin); }, stmt);
  body.push_back(std::move(stmt));
}

DeclNode Parser::camera_decl() {
  advance();
  CameraDecl out;
  out.name = name();
  out.like = optional_name_after("like");
  block({"mount", "image", "lens"}, [&] { camera_statement(out.body); });
  return out;
}

void Parser::camera_statement(std::vector<CameraStmt>& body) {
  const std::uint32_t begin = mark();
  CameraStmt stmt;
  if (accept_word("mount")) {
    MountStmt mount;
    mount.frame = path();
    expect_word("at");
    mount.at = point();
    mount.kind = accept_word("quat") ? MountKind::kQuat : MountKind::kLook;
    if (mount.kind == MountKind::kLook) expect_word("look");
    mount.direction = point();
    stmt = std::move(mount);
  } else if (accept_word("image")) {
    ImageStmt image;
    image.width = integer();
    expect_word("x");
    image.height = integer();
    if (accept_word("samples")) image.samples = integer();
    stmt = image;
  } else if (accept_word("lens")) {
    stmt = LensStmt{{}, comma_list([this] { return quantity(); })};
  } else {
    fail_expected("a statement of `camera`");
  }
  if (failed_) return;
  std::visit([&](auto& node) { node.span = since(begin); }, stmt);
  body.push_back(std::move(stmt));
}

DeclNode Parser::light_decl() {
  advance();
  LightDecl out;
  out.name = name();
  block({"ambient", "sun"}, [&] { light_statement(out.body); });
  return out;
}

void Parser::light_statement(std::vector<LightStmt>& body) {
  const std::uint32_t begin = mark();
  LightStmt stmt;
  if (accept_word("ambient")) {
    AmbientStmt ambient;
    ambient.value = quantity();
    if (accept_word("occlusion")) ambient.occlusion = integer();
    stmt = ambient;
  } else if (accept_word("sun")) {
    SunStmt sun;
    sun.direction = point();
    expect_word("power");
    sun.power = quantity();
    sun.shadow = accept_word("shadow");
    stmt = std::move(sun);
  } else {
    fail_expected("a statement of `light`");
  }
  if (failed_) return;
  std::visit([&](auto& node) { node.span = since(begin); }, stmt);
  body.push_back(std::move(stmt));
}

// ---- scenes and layouts
// ---------------------------------------------------------------------------------------------

DeclNode Parser::scene_decl() {
  advance();
  SceneDecl out;
  out.name = name();
  out.like = optional_name_after("like");
  block({"robot", "joints", "surface", "fixture", "backdrop", "camera", "light", "physics"},
        [&] { scene_statement(out.body); });
  return out;
}

void Parser::scene_statement(std::vector<SceneStmt>& body) {
  const std::uint32_t begin = mark();
  SceneStmt stmt;
  if (accept_word("robot")) {
    SceneRobotStmt robot;
    robot.robot = name();
    expect_word("at");
    robot.at = point();
    expect_word("yaw");
    robot.yaw = quantity();
    stmt = std::move(robot);
  } else if (accept_word("joints")) {
    stmt = JointsStmt{{}, point()};
  } else if (accept_word("surface")) {
    SurfaceStmt surface;
    surface.height = quantity();
    expect_word("area");
    surface.low = point();
    expect(TokenKind::kDotDot);
    surface.high = point();
    stmt = std::move(surface);
  } else if (accept_word("fixture")) {
    FixtureStmt fixture;
    fixture.mesh = string();
    expect_word("at");
    fixture.at = point();
    stmt = std::move(fixture);
  } else if (accept_word("backdrop")) {
    stmt = BackdropStmt{{}, string()};
  } else if (accept_word("camera")) {
    SceneCameraStmt seen;
    seen.cameras = comma_list([this] {
      SceneCamera camera;
      camera.camera = name();
      camera.as = optional_name_after("as");
      if (accept_word("overlay")) camera.overlay = string();
      return camera;
    });
    stmt = std::move(seen);
  } else if (accept_word("light")) {
    stmt = UseLightStmt{{}, name()};
  } else if (accept_word("physics")) {
    PhysicsStmt physics;
    physics.rate = quantity();
    expect_word("friction");
    physics.friction = quantity();
    physics.window_step = accept_word("window");
    if (physics.window_step) expect_word("step");
    stmt = std::move(physics);
  } else {
    fail_expected("a statement of `scene`");
  }
  if (failed_) return;
  std::visit([&](auto& node) { node.span = since(begin); }, stmt);
  body.push_back(std::move(stmt));
}

DeclNode Parser::layout_decl() {
  advance();
  LayoutDecl out;
  out.name = name();
  out.like = optional_name_after("like");
  block({"cells", "place", "orient", "jitter", "drop", "expect"},
        [&] { layout_statement(out.body); });
  return out;
}

void Parser::layout_statement(std::vector<LayoutStmt>& body) {
  const std::uint32_t begin = mark();
  LayoutStmt stmt;
  if (accept_word("cells")) {
    stmt = cells_statement();
  } else if (accept_word("place")) {
    stmt = place_statement();
  } else if (accept_word("orient")) {
    if (at_word("by") && text_ahead(1) == "rest") {
      advance();
      advance();
      stmt = OrientByRestStmt{};
    } else {
      OrientStmt orient;
      orient.what = name();
      orient.poses = poses();
      stmt = std::move(orient);
    }
  } else if (accept_word("jitter")) {
    stmt = JitterStmt{{}, quantity()};
  } else if (accept_word("drop")) {
    DropStmt drop;
    drop.height = quantity();
    if (accept_word("settle")) drop.settle = quantity();
    stmt = std::move(drop);
  } else if (accept_word("expect")) {
    ExpectEpisodesStmt expected;
    expected.episodes = integer();
    expect_word("episodes");
    stmt = expected;
  } else {
    fail_expected("a statement of `layout`");
  }
  if (failed_) return;
  std::visit([&](auto& node) { node.span = since(begin); }, stmt);
  body.push_back(std::move(stmt));
}

LayoutStmt Parser::cells_statement() {
  CellsStmt out;
  out.name = name();
  expect(TokenKind::kAssign);
  expect_word("grid");
  out.nx = integer();
  expect_word("x");
  out.ny = integer();
  expect_word("at");
  out.at = point();
  expect_word("spread");
  out.spreads = comma_list([this] { return point(); });
  return out;
}

LayoutStmt Parser::place_statement() {
  std::vector<Name> what = names();
  if (accept_word("at")) {
    PlaceAtStmt out;
    out.names = std::move(what);
    out.at = point();
    return out;
  }
  PlaceInStmt out;
  out.names = std::move(what);
  expect_word("in");
  if (accept_word("remaining")) {
    out.how = PlaceHow::kRemaining;
  } else {
    expect_word("distinct");
  }
  out.cells = name();
  return out;
}

}  // namespace probe::syntax
