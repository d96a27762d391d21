#include "compiler/syntax/parser.h"

#include <doctest/doctest.h>

#include <string>

#include "tests/compiler/syntax/parse_helper.h"

using namespace probe;
using namespace probe::syntax;

namespace {

// An expression fully parenthesised, to see how it was grouped.
std::string joined(std::initializer_list<std::string_view> parts) {
  std::string out;
  for (const std::string_view part : parts) out += part;
  return out;
}

std::string show(const Parsed& parsed, ExprId id);

struct Show {
  const Parsed& parsed;

  std::string operator()(const ExprNumber& node) const {
    return std::string(parsed.text(node.value.span));
  }
  std::string operator()(const ExprName& node) const { return std::string(node.name.text); }
  std::string operator()(const ExprPath& node) const {
    return joined({node.owner.text, ".", node.name.text});
  }
  std::string operator()(const ExprCall& node) const {
    std::string arguments;
    for (const Argument& argument : node.arguments) {
      if (!arguments.empty()) arguments += ", ";
      if (argument.name) arguments += joined({argument.name->text, ": "});
      arguments += show(parsed, argument.value);
    }
    return joined({node.callee.text, "(", arguments, ")"});
  }
  std::string operator()(const ExprVector& node) const {
    return joined({"<", show(parsed, node.parts[0]), " ", show(parsed, node.parts[1]), " ",
                   show(parsed, node.parts[2]), ">"});
  }
  std::string operator()(const ExprUnary& node) const {
    return joined({parsed.text(node.op_span), "[", show(parsed, node.operand), "]"});
  }
  std::string operator()(const ExprBinary& node) const {
    return joined({"(", show(parsed, node.left), " ", parsed.text(node.op_span), " ",
                   show(parsed, node.right), ")"});
  }
  std::string operator()(const ExprHold& node) const {
    return joined(
        {"[", show(parsed, node.operand), " for ", std::to_string(node.steps.value), "]"});
  }
  std::string operator()(const ExprBlock& node) const {
    std::string out(node.quantifier == Quantifier::kAny ? "any{" : "all{");
    for (const ExprId condition : node.conditions) out += joined({show(parsed, condition), ";"});
    return out += "}";
  }
  std::string operator()(const ExprQuantified& node) const {
    constexpr std::string_view kWords[] = {"any", "all", "no"};
    return joined({kWords[static_cast<std::size_t>(node.quantifier)], " ", node.variable.text,
                   " in ", parsed.text(parsed.file()[node.set].span), ": ",
                   show(parsed, node.body)});
  }
};

std::string show(const Parsed& parsed, ExprId id) {
  return std::visit(Show{parsed}, parsed.file()[id].node);
}

std::string grouped(const std::string& text) {
  const Parsed parsed("predicate p() = " + text);
  CHECK(parsed.messages() == "");
  return show(parsed, parsed.get<PredicateDecl>().body);
}

}  // namespace

TEST_CASE("a dataset holds relations") {
  const Parsed parsed(
      "dataset b \"Bridge\" {\n  relations carrot on plate,\n spoon on towel\n}\ndataset c \"C\"");
  CHECK(parsed.messages() == "");
  const auto& dataset = parsed.get<DatasetDecl>();
  CHECK(dataset.name.text == "b");
  CHECK(dataset.title.value == "Bridge");
  REQUIRE(dataset.body.size() == 1);
  REQUIRE(dataset.body[0].relations.size() == 2);
  CHECK(dataset.body[0].relations[1].object.text == "towel");
  CHECK(parsed.get<DatasetDecl>(1).body.empty());
}

TEST_CASE("attributes and facts list names over several lines") {
  const Parsed parsed("attribute color { orange,\n yellow }\nfacts {\n a, b\n}");
  CHECK(parsed.messages() == "");
  CHECK(parsed.get<AttributeDecl>().values.size() == 2);
  CHECK(parsed.get<FactsDecl>(1).names[1].text == "b");
}

TEST_CASE("every object statement is read with its span") {
  const Parsed parsed(R"(object a like b {
  mesh "m"; box 11.5cm x 3.2cm x -3.8cm; density 700kg/m3; friction 0.5
  is f, g; maybe h; seen in d, e; unseen
  rest roll 90deg yaw 1deg, yaw -90deg
  name "coke can" bare
  phrase p appearance "x" bare means not color red and (f or color blue)
  color silver, green
}
object c { box (-1cm, 0m, 1) .. (1cm, 2cm, 3cm) })");
  CHECK(parsed.messages() == "");
  const auto& object = parsed.get<ObjectDecl>();
  CHECK(object.like->text == "b");
  REQUIRE(object.body.size() == 12);
  CHECK(as<MeshStmt>(object.body[0]).path.value == "m");
  const auto& box = as<BoxSizeStmt>(object.body[1]);
  CHECK(box.x.digits == "11.5");
  CHECK(box.x.unit == Unit::kCentimetre);
  CHECK(box.z.negative);
  CHECK(parsed.text(box.z.span) == "-3.8cm");
  CHECK(parsed.text(box.span) == "box 11.5cm x 3.2cm x -3.8cm");
  CHECK(as<DensityStmt>(object.body[2]).value.unit == Unit::kKilogramPerCubicMetre);
  CHECK(as<FrictionStmt>(object.body[3]).value.unit == Unit::kNone);
  CHECK(as<IsStmt>(object.body[4]).facts.size() == 2);
  CHECK(as<MaybeStmt>(object.body[5]).facts.size() == 1);
  CHECK(as<SeenInStmt>(object.body[6]).datasets.size() == 2);
  CHECK(parsed.text(as<UnseenStmt>(object.body[7]).span) == "unseen");
  const auto& rest = as<RestStmt>(object.body[8]);
  REQUIRE(rest.poses.size() == 2);
  CHECK(rest.poses[0].angles[0].turn == Turn::kRoll);
  CHECK(rest.poses[0].angles[1].turn == Turn::kYaw);
  CHECK(as<NameStmt>(object.body[9]).bare);
  const auto& phrase = as<PhraseStmt>(object.body[10]);
  CHECK(phrase.axis.text == "appearance");
  const auto& both = std::get<QueryAnd>(parsed.file()[phrase.means].node);
  const auto& negated = std::get<QueryNot>(parsed.file()[both.left].node);
  CHECK(std::get<QueryValue>(parsed.file()[negated.operand].node).value.text == "red");
  CHECK(std::holds_alternative<QueryOr>(parsed.file()[both.right].node));
  CHECK(as<AttributeStmt>(object.body[11]).attribute.text == "color");
  CHECK(as<BoxCornersStmt>(parsed.get<ObjectDecl>(1).body[0]).low.coordinates.size() == 3);
}

TEST_CASE("words of the grammar may be names") {
  const Parsed parsed(
      "attribute scene { of, like }\nobject task { scene like; name \"task\" }\ntask set like task "
      "{ source task }\n"
      "set any = { all, no }\npredicate p(steps: object) = any > all");
  CHECK(parsed.messages() == "");
  CHECK(as<AttributeStmt>(parsed.get<ObjectDecl>(1).body[0]).attribute.text == "scene");
}

TEST_CASE("a robot has fingers, drives and a grip") {
  const Parsed parsed(R"(robot w {
  urdf "w.urdf"; tcp ee points -z
  fingers l opens +y, r opens -y
  control ee_delta_pose 5Hz
  reach 12cm .. 62cm
  drive waist, shoulder stiffness 1169.789Nm/rad damping 330Nms/rad limit 200Nm
  drive left stiffness 1000N/m damping 200Ns/m limit 50N
  grip 1.5cm .. 3.7cm friction 1 patch 4mm
  grip -1.5cm .. 3.7cm
})");
  CHECK(parsed.messages() == "");
  const auto& body = parsed.get<RobotDecl>().body;
  REQUIRE(body.size() == 9);
  const auto& fingers = as<FingersStmt>(body[2]).fingers;
  CHECK(!fingers[0].opens.negative);
  CHECK(fingers[1].opens.negative);
  CHECK(fingers[1].opens.axis.text == "y");
  const auto& tcp = as<TcpStmt>(body[1]);
  REQUIRE(tcp.points.has_value());
  CHECK(tcp.points->negative);
  CHECK(tcp.points->axis.text == "z");
  const auto& drive = as<DriveStmt>(body[5]);
  CHECK(drive.joints.size() == 2);
  REQUIRE(drive.stiffness.has_value());
  CHECK(drive.stiffness->unit == Unit::kNewtonMetrePerRadian);
  REQUIRE(drive.damping.has_value());
  CHECK(drive.damping->unit == Unit::kNewtonMetreSecondPerRadian);
  REQUIRE(drive.limit.has_value());
  CHECK(drive.limit->unit == Unit::kNewtonMetre);
  const auto& grip = as<GripStmt>(body[7]);
  CHECK(grip.patch->unit == Unit::kMillimetre);
  CHECK(!as<GripStmt>(body[8]).friction);
}

TEST_CASE("cameras and lights") {
  const Parsed parsed(R"(camera c like d {
  mount w.base at (0cm, -16cm, 36cm) look (1, 0.5, -1)
  image 640 x 480
  lens 1px, 2px, 3px, 4px
}
camera e { mount w at (0m, 0m, 0m) quat (-0.9, 0.07, -0.3, 0.1) }
light s { ambient 0.3; sun (0, 0, -1) power 2.2 shadow; sun (1, 1, -1) power 0.7 })");
  CHECK(parsed.messages() == "");
  const auto& mount = as<MountStmt>(parsed.get<CameraDecl>().body[0]);
  CHECK(mount.frame.parts[1].text == "base");
  CHECK(mount.kind == MountKind::kLook);
  CHECK(as<ImageStmt>(parsed.get<CameraDecl>().body[1]).height.value == 480);
  CHECK(as<LensStmt>(parsed.get<CameraDecl>().body[2]).values.size() == 4);
  const auto& quat = as<MountStmt>(parsed.get<CameraDecl>(1).body[0]);
  CHECK(quat.kind == MountKind::kQuat);
  CHECK(quat.direction.coordinates[0].negative);
  CHECK(as<SunStmt>(parsed.get<LightDecl>(2).body[1]).shadow);
  CHECK(!as<SunStmt>(parsed.get<LightDecl>(2).body[2]).shadow);
}

TEST_CASE("scenes with every statement") {
  const Parsed parsed(R"(scene s like t {
  robot w at (14.7cm, 2.8cm, 87cm) yaw 180deg
  joints (-0.018rad, 0.04rad, 3.7cm)
  surface 87cm area (-34cm, -20cm) .. (4cm, 20cm)
  fixture "sink" at (1cm, 2cm, 3cm)
  backdrop "room"
  camera c overlay "o.png"; camera d, e as wrist
  light l
  physics 500Hz friction 0.5 window step
})");
  CHECK(parsed.messages() == "");
  const auto& body = parsed.get<SceneDecl>().body;
  REQUIRE(body.size() == 9);
  REQUIRE(as<SceneRobotStmt>(body[0]).at.has_value());
  CHECK(as<SceneRobotStmt>(body[0]).at->coordinates.size() == 3);
  CHECK(as<JointsStmt>(body[1]).positions.coordinates[0].unit == Unit::kRadian);
  CHECK(as<BackdropStmt>(body[4]).mesh.value == "room");
  REQUIRE(as<SceneCameraStmt>(body[5]).cameras.size() == 1);
  CHECK(as<SceneCameraStmt>(body[5]).cameras[0].overlay->value == "o.png");
  const auto& cameras = as<SceneCameraStmt>(body[6]).cameras;
  REQUIRE(cameras.size() == 2);
  CHECK(!cameras[0].overlay);
  CHECK(!cameras[0].as);
  CHECK(cameras[1].camera.text == "e");
  CHECK(cameras[1].as->text == "wrist");
  CHECK(as<PhysicsStmt>(body[8]).window_step);
}

TEST_CASE("layouts with every statement") {
  const Parsed parsed(R"(layout l like m {
  cells c = grid 2 x 4 at (-16cm, 0cm) spread (5cm, 5cm), (10cm, 10cm)
  place source, target in distinct c
  place distractors in remaining c
  place target at (1cm, 2cm)
  orient by rest
  orient source yaw 0deg, yaw 45deg
  jitter 5mm; drop 50cm settle 0.5s; drop 1cm
  expect 24 episodes
})");
  CHECK(parsed.messages() == "");
  const auto& body = parsed.get<LayoutDecl>().body;
  REQUIRE(body.size() == 10);
  const auto& cells = as<CellsStmt>(body[0]);
  CHECK(cells.nx.value == 2);
  CHECK(cells.ny.value == 4);
  CHECK(cells.spreads.size() == 2);
  CHECK(as<PlaceInStmt>(body[1]).how == PlaceHow::kDistinct);
  CHECK(as<PlaceInStmt>(body[2]).how == PlaceHow::kRemaining);
  CHECK(as<PlaceAtStmt>(body[3]).names[0].text == "target");
  CHECK(std::holds_alternative<OrientByRestStmt>(body[4]));
  CHECK(as<OrientStmt>(body[5]).poses.size() == 2);
  CHECK(!as<DropStmt>(body[8]).settle);
  CHECK(as<ExpectEpisodesStmt>(body[9]).episodes.value == 24);
}

TEST_CASE("slots of a template know their place in the text") {
  const Parsed parsed(
      "template t frame put \"put {the source: drink} on\\n{avoid the plate}\"\ntemplate u \"x\"");
  CHECK(parsed.messages() == "");
  const auto& parts = parsed.get<TemplateDecl>().text.parts;
  CHECK(parsed.get<TemplateDecl>().frame->text == "put");
  REQUIRE(parts.size() == 4);
  CHECK(std::get<std::string>(parts[0]) == "put ");
  const auto& slot = std::get<Slot>(parts[1]);
  CHECK(parsed.text(slot.span) == "{the source: drink}");
  CHECK(slot.the);
  CHECK(parsed.text(slot.name.span) == "source");
  CHECK(parsed.text(slot.category->span) == "drink");
  CHECK(std::get<std::string>(parts[2]) == " on\n");
  CHECK(std::get<Slot>(parts[3]).avoid);
  CHECK(std::get<Slot>(parts[3]).name.text == "plate");
}

TEST_CASE("a malformed slot is one report inside the string") {
  CHECK(Parsed("template t \"put {source\"").messages() ==
        "1:17 P0406 found `{` without its `}`\n");
  CHECK(Parsed("template t \"put source}\"").messages() ==
        "1:23 P0406 found `}` without its `{`\n");
  CHECK(Parsed("template t \"put {}\"").messages() ==
        "1:17 P0406 found `}` in a slot, expected a name\n");
  CHECK(Parsed("template t \"put {a b}\"").messages() ==
        "1:17 P0406 found `b` in a slot, expected `}`\n");
}

TEST_CASE("operators bind in the order of the grammar") {
  CHECK(grouped("a + b * c - -d < e / 2 and f or not g and h") ==
        "(((((a + (b * c)) - -[d]) < (e / 2)) and f) or (not[g] and h))");
  CHECK(grouped("once not always a") == "once[not[always[a]]]");
  CHECK(grouped("(a or b) and c") == "((a or b) and c)");
  CHECK(grouped("f((1cm, -2cm, x + y)) > (a)") == "(f(<1cm -[2cm] (x + y)>) > a)");
  CHECK(grouped("f(a, slack: 1cm, b() + 2) for 5 steps") == "[f(a, slack: 1cm, (b() + 2)) for 5]");
  CHECK(grouped("not a > 1 for 2 steps") == "not[[(a > 1) for 2]]");
}

TEST_CASE("a quantifier reaches as far as one condition") {
  CHECK(grouped("all p in {c.top, c . middle} | whole c.door: open(p)") ==
        "all p in {c.top, c . middle} | whole c.door: open(p)");
  CHECK(grouped("no x in bodies - {a, b} - links: touching(a, x) and c") ==
        "(no x in bodies - {a, b} - links: touching(a, x) and c)");
  CHECK(grouped("all {\n a > 1\n any f in (g | h): f\n}") == "all{(a > 1);any f in g | h: f;}");
}

TEST_CASE("a block of conditions inside parentheses still ends conditions at newlines") {
  CHECK(grouped("(any {\n a\n b\n} and\n c)") == "(any{a;b;} and c)");
}

TEST_CASE("predicates have typed parameters with defaults and may begin on the next line") {
  const Parsed parsed(
      "predicate p(a: body, c: angle = 60deg,\n  n: number = -1) =\n  a >\n c and n");
  CHECK(parsed.messages() == "");
  const auto& predicate = parsed.get<PredicateDecl>();
  REQUIRE(predicate.params.size() == 3);
  CHECK(predicate.params[1].type == ParamType::kAngle);
  CHECK(show(parsed, *predicate.params[1].default_value) == "60deg");
  CHECK(show(parsed, predicate.body) == "((a > c) and n)");
}

TEST_CASE("metrics say how their signal is read out") {
  const Parsed parsed(
      "metrics m like n {\n a = at end x\n b = once (y)\n c = count z; d = max w\n e = min w; f = "
      "first z; g = final w\n h = always x\n}");
  CHECK(parsed.messages() == "");
  const auto& body = parsed.get<MetricsDecl>().body;
  REQUIRE(body.size() == 8);
  CHECK(body[0].readout.kind == plan::Readout::kAtEnd);
  CHECK(parsed.text(body[0].readout.kind_span) == "at end");
  CHECK(body[1].readout.kind == plan::Readout::kOnce);
  CHECK(body[4].readout.kind == plan::Readout::kMin);
  CHECK(body[7].readout.kind == plan::Readout::kAlways);
}

TEST_CASE("tasks and variants with every statement") {
  const Parsed parsed(R"(abstract task a like b against c {
  scene s; layout l; source x; target y; metrics m; light i; camera k as wrist
  distractors p, q; distractors none
  say put; say "put {source}"
  refer source as by_color; refer target as r
  pose x yaw 0deg, yaw 45deg
  horizon 60 steps
  set success = once y
}
variant v of a against b { source z }
variants of a {
  v1 { say s }
  v2 { target t }
})");
  CHECK(parsed.messages() == "");
  const auto& task = parsed.get<TaskDecl>();
  CHECK(task.abstract);
  CHECK(task.against->text == "c");
  REQUIRE(task.body.size() == 16);
  CHECK(as<TaskCameraStmt>(task.body[6]).camera.text == "k");
  CHECK(as<TaskCameraStmt>(task.body[6]).as->text == "wrist");
  CHECK(as<DistractorsStmt>(task.body[7]).objects.size() == 2);
  CHECK(as<DistractorsStmt>(task.body[8]).objects.empty());
  CHECK(std::get<Name>(as<SayStmt>(task.body[9]).what).text == "put");
  CHECK(std::get<TemplateText>(as<SayStmt>(task.body[10]).what).parts.size() == 2);
  CHECK(as<ReferStmt>(task.body[12]).role.text == "target");
  CHECK(as<Int>(as<HorizonStmt>(task.body[14]).how_long).value == 60);
  CHECK(as<MetricStmt>(task.body[15]).name.text == "success");
  CHECK(parsed.get<VariantDecl>(1).of.text == "a");
  const auto& members = parsed.get<VariantsDecl>(2).members;
  REQUIRE(members.size() == 2);
  CHECK(parsed.text(members[1].span) == "v2 { target t }");
}

TEST_CASE("derive binds tasks and phrases and keeps its where") {
  const Parsed parsed(
      "derive \"{t}_x_{p}\" for t in core - {a}, p in phrases appearance of source where scene "
      "table { refer source as p }");
  CHECK(parsed.messages() == "");
  const auto& derive = parsed.get<DeriveDecl>();
  REQUIRE(derive.binders.size() == 2);
  CHECK(std::holds_alternative<BinderTasks>(derive.binders[0].over));
  CHECK(std::get<BinderPhrases>(derive.binders[1].over).axis.text == "appearance");
  REQUIRE(derive.where);
  CHECK(std::get<CondTest>(parsed.file()[*derive.where].node).kind == CondKind::kScene);
  CHECK(derive.body.size() == 1);
}

TEST_CASE("derive binds templates, objects and distractors, and sets of those names stay sets") {
  const Parsed parsed(
      "derive \"x\" for t in core, w in templates of put, o in objects (a, b), d in distractors of "
      "t, p in clear phrases appearance of target { say w }\n"
      "derive \"y\" for t in objects { say w }\n"
      "derive \"z\" for t in templates, s in distractors, u in clear { say w }");
  CHECK(parsed.messages() == "");
  const auto& binders = parsed.get<DeriveDecl>().binders;
  REQUIRE(binders.size() == 5);
  CHECK(std::get<BinderTemplates>(binders[1].over).frame.text == "put");
  CHECK(std::get<BinderObjects>(binders[2].over).objects.size() == 2);
  CHECK(std::get<BinderDistractors>(binders[3].over).task.text == "t");
  CHECK(std::get<BinderPhrases>(binders[4].over).clear);
  CHECK(std::holds_alternative<BinderTasks>(parsed.get<DeriveDecl>(1).binders[0].over));
  for (const Binder& binder : parsed.get<DeriveDecl>(2).binders)
    CHECK(std::holds_alternative<BinderTasks>(binder.over));
}

TEST_CASE("sets of tasks group from the left and take a where") {
  const Parsed parsed(
      "set s = tasks - { a,\n b } & variants of core where axis language.action or not has "
      "distractors\n"
      "set t = sample 12 of (a | b where uses x) seed 7");
  CHECK(parsed.messages() == "");
  const auto& where = std::get<TaskSetWhere>(parsed.file()[parsed.get<SetDecl>().tasks].node);
  const auto& outer = std::get<TaskSetBinary>(parsed.file()[where.set].node);
  CHECK(outer.op == SetOp::kIntersection);
  CHECK(std::holds_alternative<TaskSetVariants>(parsed.file()[outer.right].node));
  CHECK(std::holds_alternative<CondOr>(parsed.file()[where.condition].node));
  const auto& sample = std::get<TaskSetSample>(parsed.file()[parsed.get<SetDecl>(1).tasks].node);
  CHECK(sample.count.value == 12);
  CHECK(sample.seed.value == 7);
}

TEST_CASE("suites, allows and documentation") {
  const Parsed parsed(R"(use "catalog.probe"
## The suite.
##  Two lines.
@allow(confounded, "why")
@allow(unused, "so")
suite s trained on b {
  tasks core | x
  prefix "widowx_"
  seeds 42, 7
  expect 50 tasks, 1200 episodes
}
)");
  CHECK(parsed.messages() == "");
  CHECK(parsed.get<UseDecl>().path.value == "catalog.probe");
  const Decl& decl = parsed.decl(1);
  REQUIRE(decl.docs.size() == 2);
  CHECK(decl.docs[0] == "The suite.");
  CHECK(decl.docs[1] == " Two lines.");
  REQUIRE(decl.allows.size() == 2);
  CHECK(decl.allows[0].reason.value == "why");
  CHECK(parsed.text(decl.allows[0].span) == "@allow(confounded, \"why\")");
  const auto& suite = parsed.get<SuiteDecl>(1);
  CHECK(suite.trained_on->text == "b");
  REQUIRE(suite.body.size() == 4);
  CHECK(as<SeedsStmt>(suite.body[2]).seeds[1].value == 7);
  CHECK(as<ExpectTasksStmt>(suite.body[3]).episodes.value == 1200);
}

TEST_CASE("a newline ends a statement only after a word, number, string or closing bracket") {
  const Parsed parsed("set a =\n b |\n c\nset d = (e\n - f\n)\nset g = { h\n }; set i = j");
  CHECK(parsed.messages() == "");
  CHECK(parsed.file().decls.size() == 4);
}

TEST_CASE("line ends do not count inside the parentheses of what a derive binds") {
  const Parsed parsed(
      "derive \"x\" for o in objects (\n a\n , b\n), c in cameras (d\n, e\n) { }");
  CHECK(parsed.messages() == "");
  CHECK(parsed.get<DeriveDecl>().binders.size() == 2);
}

TEST_CASE("two words that are one stand on one line") {
  for (const std::string text :
       {"set a = variants\nof b", "derive \"x\" for w in templates\nof f { }",
        "derive \"x\" for p in clear\nphrases color of source { }",
        "derive \"x\" for o in objects\n(a, b) { }", "layout l { orient by\nrest }"}) {
    CHECK_MESSAGE(Parsed(text).messages().find("P0101 found end of line, expected") !=
                      std::string::npos,
                  text);
  }
}

TEST_CASE("windows line endings and a byte order mark change nothing") {
  const Parsed parsed("\xef\xbb\xbfset a = b\r\nobject c {\r\n  color red\r\n}\r\n");
  CHECK(parsed.messages() == "");
  CHECK(parsed.file().decls.size() == 2);
}

TEST_CASE("an empty file and one of comments only have no declarations") {
  CHECK(Parsed("").file().decls.empty());
  CHECK(Parsed("\n\n# x\n;;\n").file().decls.empty());
}
