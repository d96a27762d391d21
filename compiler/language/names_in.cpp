// One function a node of the tree: a new statement is asked for here by the compiler.
#include "compiler/language/names_in.h"

#include <algorithm>

namespace probe::language {
namespace {

using namespace syntax;

constexpr Kinds kBodies = Kind::kRole | Kind::kObject | Kind::kFixture;

class Walker {
 public:
  explicit Walker(const File& file) : file_(file) {}

  std::vector<Place> run() {
    for (const Decl& decl : file_.decls) {
      decl_ = decl.span;
      derives_ = false;
      std::visit(*this, decl.node);
    }
    std::ranges::stable_sort(out_, {}, [](const Place& place) { return place.span.begin; });
    return std::move(out_);
  }

  // ---- declarations
  void operator()(const UseDecl&) {}
  void operator()(const DatasetDecl& node) {
    declare(node.name, Kind::kDataset, decl_);
    for (const RelationsStmt& stmt : node.body) {
      for (const Relation& relation : stmt.relations) {
        name(relation.subject, Kind::kObject);
        name(relation.object, Kind::kObject);
      }
    }
  }
  void operator()(const AttributeDecl& node) {
    declare(node.name, Kind::kAttribute, decl_);
    for (const Name& value : node.values) declare(value, Kind::kValue, value.span, node.name.text);
  }
  void operator()(const FactsDecl& node) {
    for (const Name& fact : node.names) declare(fact, Kind::kFact, fact.span);
  }
  void operator()(const ObjectDecl& node) {
    declare(node.name, Kind::kObject, decl_);
    name(node.like, Kind::kObject);
    owner_ = node.name.text;
    all(node.body);
  }
  void operator()(const ExtendDecl& node) {
    name(node.object, Kind::kObject);
    owner_ = node.object.text;
    all(node.body);
  }
  void operator()(const RobotDecl& node) {
    declare(node.name, Kind::kRobot, decl_);
    name(node.like, Kind::kRobot);
    owner_ = node.name.text;
    all(node.body);
  }
  void operator()(const CameraDecl& node) {
    declare(node.name, Kind::kCamera, decl_);
    name(node.like, Kind::kCamera);
    all(node.body);
  }
  void operator()(const LightDecl& node) {
    declare(node.name, Kind::kLight, decl_);
    all(node.body);
  }
  void operator()(const FixtureDecl& node) {
    declare(node.name, Kind::kFixture, decl_);
    name(node.like, Kind::kFixture);
    owner_ = node.name.text;
    all(node.body);
  }
  void operator()(const SceneDecl& node) {
    declare(node.name, Kind::kScene, decl_);
    name(node.like, Kind::kScene);
    owner_ = node.name.text;
    all(node.body);
  }
  void operator()(const LayoutDecl& node) {
    declare(node.name, Kind::kLayout, decl_);
    name(node.like, Kind::kLayout);
    owner_ = node.name.text;
    all(node.body);
  }
  void operator()(const TemplateDecl& node) {
    declare(node.name, Kind::kTemplate, decl_);
    name(node.frame, Kind::kFrame);
    text(node.text);
  }
  void operator()(const PredicateDecl& node) {
    declare(node.name, Kind::kPredicate, decl_);
    for (const Param& param : node.params) {
      variable(param.name, param.span, decl_);
      if (param.default_value) expr(*param.default_value);
    }
    expr(node.body);
  }
  void operator()(const MetricsDecl& node) {
    declare(node.name, Kind::kMetrics, decl_);
    name(node.like, Kind::kMetrics);
    for (const MetricStmt& stmt : node.body) {
      if (stmt.readout.kind != plan::Readout::kEnds)
        declare(stmt.name, Kind::kMetric, stmt.span, node.name.text);
      expr(stmt.readout.expr);
    }
  }
  void operator()(const RoleDecl& node) { declare(node.name, Kind::kRole, decl_); }
  void operator()(const TaskDecl& node) {
    declare(node.name, Kind::kTask, decl_);
    name(node.like, Kind::kTask);
    name(node.against, Kind::kTask);
    all(node.body);
  }
  void operator()(const VariantDecl& node) {
    declare(node.name, Kind::kTask, decl_);
    name(node.of, Kind::kTask);
    name(node.against, Kind::kTask);
    all(node.body);
  }
  void operator()(const VariantsDecl& node) {
    name(node.of, Kind::kTask);
    for (const VariantsMember& member : node.members) {
      declare(member.name, Kind::kTask, member.span);
      all(member.body);
    }
  }
  void operator()(const DeriveDecl& node) {
    derives_ = true;
    for (const Binder& binder : node.binders) {
      variable(binder.name, binder.span, decl_);
      std::visit(*this, binder.over);
    }
    text(node.name);
    if (node.where) cond(*node.where);
    all(node.body);
  }
  void operator()(const SetDecl& node) {
    declare(node.name, Kind::kSet, decl_);
    tasks(node.tasks);
  }
  void operator()(const QuestionsDecl& node) {
    declare(node.name, Kind::kQuestions, decl_);
    for (const QuestionStmt& stmt : node.body) {
      declare(stmt.name, Kind::kQuestion, stmt.span, node.name.text);
      if (stmt.binder) variable(*stmt.binder, stmt.binder->span, stmt.span);
      for (const QuestionPart& part : stmt.text.parts) {
        const auto* placeholder = std::get_if<Placeholder>(&part);
        if (placeholder == nullptr) continue;
        name(placeholder->what, Kind::kAttribute);
        thing(placeholder->of, kBodies | Kind::kVariable);
      }
      std::visit(*this, stmt.answer);
      if (stmt.where) cond(*stmt.where);
    }
  }
  void operator()(const SuiteDecl& node) {
    declare(node.name, Kind::kSuite, decl_);
    name(node.trained_on, Kind::kDataset);
    all(node.body);
  }
  void operator()(const SpaceDecl& node) {
    declare(node.name, Kind::kSpace, decl_);
    name(node.of, Kind::kTask);
    all(node.body);
  }

  // ---- objects, parts
  void operator()(const MeshStmt&) {}
  void operator()(const BoxSizeStmt&) {}
  void operator()(const BoxCornersStmt&) {}
  void operator()(const DensityStmt&) {}
  void operator()(const MassStmt&) {}
  void operator()(const ObjectDampingStmt&) {}
  void operator()(const FrictionStmt&) {}
  void operator()(const ScaleStmt&) {}
  void operator()(const PaintStmt&) {}
  void operator()(const TextureStmt&) {}
  void operator()(const IsStmt& stmt) { names(stmt.facts, Kind::kFact); }
  void operator()(const MaybeStmt& stmt) { names(stmt.facts, Kind::kFact); }
  void operator()(const SeenInStmt& stmt) { names(stmt.datasets, Kind::kDataset); }
  void operator()(const UnseenStmt&) {}
  void operator()(const RestStmt&) {}
  void operator()(const NameStmt&) {}
  void operator()(const PhraseStmt& stmt) {
    declare(stmt.name, Kind::kPhrase, stmt.span, owner_);
    query(stmt.means);
  }
  void operator()(const AttributeStmt& stmt) {
    name(stmt.attribute, Kind::kAttribute);
    for (const Name& value : stmt.values) name(value, Kind::kValue, stmt.attribute.text);
  }
  void operator()(const RegionStmt& stmt) {
    declare(stmt.name, Kind::kMember, stmt.span, owner_);
    if (stmt.of) name(*stmt.of, Kind::kMember | Kind::kFixture, owner_);
  }

  // ---- robots
  void operator()(const UrdfStmt&) {}
  void operator()(const TcpStmt& stmt) { name(stmt.link, Kind::kLink, owner_); }
  void operator()(const FingersStmt& stmt) {
    for (const Finger& finger : stmt.fingers) name(finger.link, Kind::kLink, owner_);
  }
  void operator()(const ControlStmt&) {}
  void operator()(const ReachStmt&) {}
  void operator()(const DriveStmt& stmt) { names(stmt.joints, Kind::kLink); }
  void operator()(const GripStmt&) {}

  // ---- cameras, lights
  void operator()(const MountStmt& stmt) {
    for (std::size_t i = 0; i < stmt.frame.parts.size(); ++i) {
      const Kind kind = i == 0 && stmt.frame.parts.size() > 1 ? Kind::kRobot : Kind::kLink;
      name(stmt.frame.parts[i], kind);
    }
  }
  void operator()(const ImageStmt&) {}
  void operator()(const LensStmt&) {}
  void operator()(const SensorStmt&) {}
  void operator()(const CameraJitterStmt&) {}
  void operator()(const AmbientStmt&) {}
  void operator()(const SunStmt&) {}
  void operator()(const LampStmt&) {}
  void operator()(const ShadingStmt&) {}
  void operator()(const LightColorStmt&) {}

  // ---- fixtures
  void operator()(const FixtureAtStmt&) {}
  void operator()(const FixtureJointStmt& stmt) { name(stmt.joint, Kind::kMember, owner_); }
  void operator()(const PartStmt& stmt) {
    declare(stmt.name, Kind::kMember, stmt.span, owner_);
    name(stmt.link, Kind::kLink, owner_);
    all(stmt.body);
  }

  void operator()(const ShownStmt& stmt) {
    name(stmt.link, Kind::kLink, owner_);
    name(stmt.joint, Kind::kMember, owner_);
  }

  // ---- scenes
  void operator()(const SceneRobotStmt& stmt) { name(stmt.robot, Kind::kRobot); }
  void operator()(const JointsStmt&) {}
  void operator()(const SurfaceStmt&) {}
  void operator()(const FixtureStmt&) {}
  void operator()(const SceneFixturesStmt& stmt) { names(stmt.fixtures, Kind::kFixture); }
  void operator()(const BackdropStmt&) {}
  void operator()(const SceneCameraStmt& stmt) {
    for (const SceneCamera& view : stmt.cameras) {
      name(view.camera, Kind::kCamera);
      if (view.as) declare(*view.as, Kind::kView, view.as->span, owner_);
    }
  }
  void operator()(const UseLightStmt& stmt) { name(stmt.light, Kind::kLight); }
  void operator()(const PhysicsStmt&) {}

  // ---- layouts
  void operator()(const CellsStmt& stmt) { declare(stmt.name, Kind::kCells, stmt.span, owner_); }
  void operator()(const PlaceAtStmt& stmt) { names(stmt.names, kBodies); }
  void operator()(const PlaceInStmt& stmt) {
    names(stmt.names, kBodies);
    name(stmt.cells, Kind::kCells, owner_);
  }
  void operator()(const PlaceOnStmt& stmt) {
    names(stmt.names, kBodies);
    thing(stmt.where, kBodies);
  }
  void operator()(const OrientByRestStmt&) {}
  void operator()(const OrientStmt& stmt) { name(stmt.what, kBodies); }
  void operator()(const StartsStmt&) {}
  void operator()(const JitterStmt&) {}
  void operator()(const JointsJitterStmt&) {}
  void operator()(const StartStmt& stmt) {
    name(stmt.fixture, Kind::kFixture);
    name(stmt.joint, Kind::kMember, stmt.fixture.text);
    bound(stmt.value.span, stmt.value.binder);
  }
  void operator()(const DropStmt&) {}
  void operator()(const ExpectEpisodesStmt&) {}

  // ---- tasks
  void operator()(const FieldStmt& stmt) {
    switch (stmt.field) {
      case TaskField::kScene:
        return name(stmt.value, Kind::kScene);
      case TaskField::kMetrics:
        return name(stmt.value, Kind::kMetrics);
      case TaskField::kLight:
        return name(stmt.value, Kind::kLight);
      case TaskField::kSource:
      case TaskField::kTarget:
        return thing(stmt.value, Kind::kObject | Kind::kFixture);
    }
  }
  void operator()(const TaskSceneStmt& stmt) {
    name(stmt.scene, Kind::kScene);
    all(stmt.body);
  }
  void operator()(const TaskLayoutStmt& stmt) {
    name(stmt.layout, Kind::kLayout);
    for (const ClearPhrase& clear : stmt.clear) {
      name(clear.phrase, Kind::kPhrase);
      name(clear.role, Kind::kRole);
    }
  }
  void operator()(const TaskCameraStmt& stmt) {
    name(stmt.camera, Kind::kCamera);
    name(stmt.as, Kind::kView);
  }
  void operator()(const DistractorsStmt& stmt) {
    for (const Name& object : stmt.objects) thing(object, Kind::kObject | Kind::kFixture);
    if (stmt.count) bound(stmt.count->span, stmt.count->binder);
    if (stmt.seed) bound(stmt.seed->span, stmt.seed->binder);
  }
  void operator()(const RoleStmt& stmt) {
    name(stmt.role, Kind::kRole);
    for (const Name& object : stmt.objects) thing(object, Kind::kObject | Kind::kFixture);
  }
  void operator()(const SayStmt& stmt) {
    if (const auto* said = std::get_if<Name>(&stmt.what)) return name(*said, Kind::kTemplate);
    text(std::get<TemplateText>(stmt.what));
  }
  void operator()(const ThenStmt& stmt) {
    if (!stmt.what) return;
    if (const auto* said = std::get_if<Name>(&*stmt.what)) {
      name(*said, Kind::kTemplate);
    } else {
      text(std::get<TemplateText>(*stmt.what));
    }
    expr(stmt.when);
  }
  void operator()(const ReferStmt& stmt) {
    name(stmt.role, Kind::kRole);
    name(stmt.phrase, Kind::kPhrase, stmt.role.text);
  }
  void operator()(const PoseStmt& stmt) { name(stmt.object, kBodies); }
  void operator()(const HorizonStmt& stmt) {
    std::visit([this](const auto& much) { bound(much.span, much.binder); }, stmt.how_long);
  }
  void operator()(const IdleStmt& stmt) { bound(stmt.steps.span, stmt.steps.binder); }
  void operator()(const DelayStmt& stmt) {
    std::visit([this](const auto& much) { bound(much.span, much.binder); }, stmt.how_long);
  }
  void operator()(const MovesStmt& stmt) {
    name(stmt.what, kBodies);
    bound(stmt.speed.span, stmt.speed.binder);
  }
  void operator()(const SolutionStmt& stmt) { all(stmt.skills); }
  void operator()(const SkillStmt& stmt) {
    operand(stmt.what);
    if (stmt.to) operand(*stmt.to);
  }
  void operator()(const MetricStmt& stmt) {
    if (stmt.readout.kind != plan::Readout::kEnds) name(stmt.name, Kind::kMetric);
    expr(stmt.readout.expr);
  }

  // ---- what a derive goes over
  void operator()(const BinderPhrases& over) { name(over.role, Kind::kRole); }
  void operator()(const BinderTemplates& over) { name(over.frame, Kind::kFrame); }
  void operator()(const BinderObjects& over) {
    for (const Name& object : over.objects) thing(object, Kind::kObject | Kind::kFixture);
  }
  void operator()(const BinderDeclared& over) {
    constexpr Kind kOf[] = {Kind::kLight, Kind::kCamera, Kind::kScene, Kind::kRobot,
                            Kind::kFixture};
    names(over.names, kOf[static_cast<std::size_t>(over.of)]);
  }
  void operator()(const BinderNumbers&) {}
  void operator()(const BinderDistractors& over) {
    name(over.role, Kind::kRole);
    name(over.task, Kind::kVariable | Kind::kFixture | Kind::kTask);
  }
  void operator()(const BinderTasks& over) { tasks(over.tasks); }

  // ---- suites
  void operator()(const SuiteTasksStmt& stmt) { tasks(stmt.tasks); }
  void operator()(const SuiteSampleStmt& stmt) { tasks(stmt.of); }
  void operator()(const PrefixStmt&) {}
  void operator()(const SeedsStmt&) {}
  void operator()(const ExpectTasksStmt&) {}
  void operator()(const SuiteQuestionsStmt& stmt) { names(stmt.sets, Kind::kQuestions); }

  // ---- spaces
  void operator()(const SpaceLightStmt&) {}
  void operator()(const SpaceCameraStmt& stmt) { name(stmt.view, Kind::kView); }
  void operator()(const SpacePlaceStmt& stmt) {
    for (const SpacePlaceStmt::Disc& disc : stmt.discs)
      name(disc.what, Kind::kRole | Kind::kObject);
  }
  void operator()(const SpaceClutterStmt& stmt) { names(stmt.from, Kind::kObject); }
  void operator()(const SpaceWordsStmt& stmt) {
    for (const SpaceWordsStmt::Pool& pool : stmt.pools)
      name(pool.of, pool.is_templates ? Kind::kFrame : Kind::kRole);
  }
  void operator()(const SpaceSensorStmt&) {}
  void operator()(const SpaceDelayStmt&) {}

  // ---- answers
  void operator()(const AnswerOne& answer) { thing(answer.who, kBodies | Kind::kVariable); }
  void operator()(const AnswerPresent& answer) { thing(answer.who, kBodies | Kind::kVariable); }
  void operator()(const AnswerBeside& answer) {
    thing(answer.a, kBodies | Kind::kVariable);
    thing(answer.b, kBodies | Kind::kVariable);
  }
  void operator()(const AnswerCount& answer) {
    name(answer.attribute, Kind::kAttribute);
    thing(answer.who, kBodies | Kind::kVariable);
  }
  void operator()(const AnswerMentions& answer) {
    thing(answer.what, kBodies);
    thing(answer.to, kBodies);
  }
  void operator()(const AnswerTruth& answer) { expr(answer.expr, Kind::kMetric); }

 private:
  template <typename Items>
  void all(const Items& items) {
    for (const auto& item : items) std::visit(*this, item);
  }

  void add(const Name& written, Kinds kinds, std::string_view of) {
    if (!written.text.empty()) out_.push_back({written.span, written.text, kinds, false, of});
  }
  void name(const Name& written, Kinds kinds, std::string_view of = {}) {
    add(written, derives_ ? kinds | Kind::kVariable : kinds, of);
  }
  void name(const std::optional<Name>& written, Kinds kinds) {
    if (written) name(*written, kinds);
  }
  void names(const std::vector<Name>& written, Kinds kinds) {
    for (const Name& one : written) thing(one, kinds);
  }
  // `cabinet.top_drawer` is two names.
  void thing(const Name& written, Kinds kinds) {
    const std::size_t dot = written.text.find('.');
    if (dot == written.text.npos) return name(written, kinds);
    std::size_t owner = dot, member = dot + 1;
    while (owner > 0 && is_blank(written.text[owner - 1])) --owner;
    while (member < written.text.size() && is_blank(written.text[member])) ++member;
    const std::string_view who = written.text.substr(0, owner);
    const auto begin = written.span.begin;
    name({{written.span.file, begin, begin + static_cast<std::uint32_t>(owner)}, who}, kBodies | kinds);
    name({{written.span.file, begin + static_cast<std::uint32_t>(member), written.span.end},
          written.text.substr(member)},
         Kind::kMember, who);
  }
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  void operand(const SkillOperand& written) {
    name(written.owner, kBodies);
    if (written.name) name(*written.name, Kind::kMember, written.owner.text);
  }
  void declare(const Name& written, Kind kind, const Span& whole, std::string_view of = {}) {
    if (written.text.empty()) return;
    out_.push_back({written.span, written.text, kind, true, of, {}, whole});
  }
  void variable(const Name& written, const Span& whole, const Span& scope) {
    if (written.text.empty()) return;
    out_.push_back({written.span, written.text, Kind::kVariable, true, {}, scope, whole});
  }
  // A number that a binder stands for.
  void bound(const Span& span, std::string_view binder) {
    if (!binder.empty()) add({span, binder}, Kind::kVariable, {});
  }
  void text(const TemplateText& written) {
    for (const TemplatePart& part : written.parts) {
      const auto* slot = std::get_if<Slot>(&part);
      if (slot == nullptr) continue;
      thing(slot->name, kBodies);
      if (slot->category) name(*slot->category, Kind::kValue, "category");
    }
  }

  // Heights are bounded by the parser.
  void query(QueryId id) {
    if (id.value == QueryId::kNone) return;
    std::visit([this](const auto& node) { read(node); }, file_[id].node);
  }
  void read(const QueryFact& node) { name(node.fact, Kind::kFact | Kind::kPredicate); }
  void read(const QueryValue& node) {
    name(node.attribute, Kind::kAttribute | Kind::kPredicate);
    name(node.value, Kind::kValue | Kind::kObject, node.attribute.text);
  }
  void read(const QueryRelation& node) {
    name(node.relation, Kind::kPredicate);
    names(node.objects, Kind::kObject);
  }
  void read(const QueryNot& node) { query(node.operand); }
  void read(const QueryAnd& node) { query(node.left), query(node.right); }
  void read(const QueryOr& node) { query(node.left), query(node.right); }

  // `also`: what a name that is the whole expression may be beside a body.
  void expr(ExprId id, Kinds also = {}) {
    if (id.value == ExprId::kNone) return;
    const Expr& at = file_[id];
    if (const auto* one = std::get_if<ExprName>(&at.node)) {
      return name(one->name, kBodies | Kind::kVariable | Kind::kMeasure | also);
    }
    std::visit([&](const auto& node) { read(at.span, node); }, at.node);
  }
  void read(const Span&, const ExprNumber&) {}
  void read(const Span&, const ExprName&) {}
  void read(const Span&, const ExprPath& node) {
    name(node.owner, kBodies | Kind::kVariable);
    name(node.name, Kind::kMember, node.owner.text);
  }
  void read(const Span&, const ExprCall& node) {
    name(node.callee, Kind::kMeasure | Kind::kPredicate);
    for (const Argument& argument : node.arguments) expr(argument.value);
  }
  void read(const Span&, const ExprVector& node) {
    for (const ExprId part : node.parts) expr(part);
  }
  void read(const Span&, const ExprUnary& node) { expr(node.operand); }
  void read(const Span&, const ExprBinary& node) { expr(node.left), expr(node.right); }
  void read(const Span&, const ExprHold& node) {
    expr(node.operand);
    bound(node.steps.span, node.steps.binder);
  }
  void read(const Span&, const ExprBlock& node) {
    for (const ExprId condition : node.conditions) expr(condition);
  }
  void read(const Span& span, const ExprQuantified& node) {
    variable(node.variable, node.variable.span, span);
    set(node.set);
    expr(node.body);
  }

  void set(SetExprId id) {
    if (id.value == SetExprId::kNone) return;
    std::visit([this](const auto& node) { read(node); }, file_[id].node);
  }
  void read(const SetNames& node) { names(node.names, kBodies | Kind::kVariable); }
  void read(const SetName& node) { name(node.name, Kind::kRole | Kind::kVariable); }
  void read(const SetWhole& node) { thing(node.name, kBodies | Kind::kVariable); }
  void read(const SetBinary& node) { set(node.left), set(node.right); }

  void tasks(TaskSetId id) {
    if (id.value == TaskSetId::kNone) return;
    std::visit([this](const auto& node) { read(node); }, file_[id].node);
  }
  void read(const TaskSetNames& node) {
    for (const Name& one : node.names) name(one, Kind::kTask);
  }
  void read(const TaskSetName& node) { name(node.name, Kind::kSet); }
  void read(const TaskSetVariants& node) { tasks(node.of); }
  void read(const TaskSetSample& node) { tasks(node.of); }
  void read(const TaskSetBinary& node) { tasks(node.left), tasks(node.right); }
  void read(const TaskSetWhere& node) {
    tasks(node.set);
    cond(node.condition);
  }

  void cond(CondId id) {
    if (id.value == CondId::kNone) return;
    std::visit([this](const auto& node) { read(node); }, file_[id].node);
  }
  void read(const CondTest& node) {
    constexpr Kinds kOf[] = {Kinds(), Kinds(), Kinds(), Kinds(), Kind::kScene, Kind::kMetrics};
    const Kinds kinds = kOf[static_cast<std::size_t>(node.kind)];
    if (!kinds.is_none() && !node.path.parts.empty()) name(node.path.parts.front(), kinds);
  }
  void read(const CondNot& node) { cond(node.operand); }
  void read(const CondAnd& node) { cond(node.left), cond(node.right); }
  void read(const CondOr& node) { cond(node.left), cond(node.right); }

  const File& file_;
  std::vector<Place> out_;
  Span decl_;
  std::string_view owner_;
  bool derives_ = false;
};

}  // namespace

std::vector<Place> names_in(const File& file) { return Walker(file).run(); }

}  // namespace probe::language
