// Every statement that stands once has a key; two of one key in a block are P0203.
#include "compiler/names/repeats.h"

#include <type_traits>

namespace probe::sema {
namespace {

using Key = std::string;  // empty: may stand repeatedly

struct KeyOf {
  // Objects.
  Key operator()(const syntax::MeshStmt&) const { return "mesh"; }
  Key operator()(const syntax::BoxSizeStmt&) const { return "box"; }
  Key operator()(const syntax::BoxCornersStmt&) const { return "box"; }
  Key operator()(const syntax::DensityStmt&) const { return "density"; }
  Key operator()(const syntax::FrictionStmt&) const { return "friction"; }
  Key operator()(const syntax::RestStmt&) const { return "rest"; }
  Key operator()(const syntax::NameStmt&) const { return "name"; }
  Key operator()(const syntax::PhraseStmt& stmt) const { return named("phrase", stmt.name); }
  Key operator()(const syntax::AttributeStmt& stmt) const { return Key(stmt.attribute.text); }
  // Robots, cameras, lights, scenes.
  Key operator()(const syntax::UrdfStmt&) const { return "urdf"; }
  Key operator()(const syntax::TcpStmt&) const { return "tcp"; }
  Key operator()(const syntax::FingersStmt&) const { return "fingers"; }
  Key operator()(const syntax::ControlStmt&) const { return "control"; }
  Key operator()(const syntax::ReachStmt&) const { return "reach"; }
  Key operator()(const syntax::GripStmt&) const { return "grip"; }
  Key operator()(const syntax::MountStmt&) const { return "mount"; }
  Key operator()(const syntax::ImageStmt&) const { return "image"; }
  Key operator()(const syntax::LensStmt&) const { return "lens"; }
  Key operator()(const syntax::AmbientStmt&) const { return "ambient"; }
  Key operator()(const syntax::SceneRobotStmt&) const { return "robot"; }
  Key operator()(const syntax::JointsStmt&) const { return "joints"; }
  Key operator()(const syntax::SurfaceStmt&) const { return "surface"; }
  Key operator()(const syntax::FixtureStmt&) const { return "fixture"; }
  Key operator()(const syntax::BackdropStmt&) const { return "backdrop"; }
  Key operator()(const syntax::SceneCameraStmt&) const { return "camera"; }
  Key operator()(const syntax::UseLightStmt&) const { return "light"; }
  Key operator()(const syntax::PhysicsStmt&) const { return "physics"; }
  // Layouts.
  Key operator()(const syntax::CellsStmt& stmt) const { return named("cells", stmt.name); }
  Key operator()(const syntax::JitterStmt&) const { return "jitter"; }
  Key operator()(const syntax::DropStmt&) const { return "drop"; }
  Key operator()(const syntax::ExpectEpisodesStmt&) const { return "expect"; }
  // Tasks and suites.
  Key operator()(const syntax::FieldStmt& stmt) const {
    static constexpr const char* kWords[] = {"scene",  "layout",  "source",
                                             "target", "metrics", "light"};
    return kWords[static_cast<std::size_t>(stmt.field)];
  }
  Key operator()(const syntax::TaskCameraStmt& stmt) const {
    return stmt.as ? named("camera as", *stmt.as) : "camera";
  }
  Key operator()(const syntax::DistractorsStmt&) const { return "distractors"; }
  Key operator()(const syntax::SayStmt&) const { return "say"; }
  Key operator()(const syntax::ReferStmt& stmt) const {
    return stmt.role == syntax::Role::kSource ? "refer source" : "refer target";
  }
  Key operator()(const syntax::PoseStmt& stmt) const { return named("pose", stmt.object); }
  Key operator()(const syntax::HorizonStmt&) const { return "horizon"; }
  Key operator()(const syntax::MetricStmt& stmt) const { return named("set", stmt.name); }
  Key operator()(const syntax::SuiteTasksStmt&) const { return "tasks"; }
  Key operator()(const syntax::PrefixStmt&) const { return "prefix"; }
  Key operator()(const syntax::ExpectTasksStmt&) const { return "expect"; }
  template <typename Other>
  Key operator()(const Other&) const {
    return {};
  }

  static Key named(const char* word, const syntax::Name& name) {
    return std::string(word) + " " + std::string(name.text);
  }
};

void report_repeat(Context& context, const Span& span, const Span& first, const std::string& what) {
  context.report(Code::P0203, span, what).label(first, "first said here");
}

template <typename Stmt>
void check_block(Context& context, const std::vector<Stmt>& body) {
  std::map<Key, Span> said;
  for (const Stmt& stmt : body) {
    const Key key = std::visit(KeyOf{}, stmt);
    if (key.empty()) continue;
    const Span span = std::visit([](const auto& node) { return node.span; }, stmt);
    const auto [first, is_new] = said.try_emplace(key, span);
    if (!is_new)
      report_repeat(context, span, first->second, "`" + key + "` is said twice in this block");
  }
}

// A fact has one truth, and a thing is seen or is not.
void check_claims(Context& context, const syntax::ObjectDecl& object) {
  std::map<std::string_view, Span> is, maybe;
  std::optional<Span> seen, unseen;
  for (const syntax::ObjectStmt& stmt : object.body) {
    if (const auto* yes = std::get_if<syntax::IsStmt>(&stmt)) {
      for (const syntax::Name& fact : yes->facts) is.try_emplace(fact.text, fact.span);
    } else if (const auto* open = std::get_if<syntax::MaybeStmt>(&stmt)) {
      for (const syntax::Name& fact : open->facts) maybe.try_emplace(fact.text, fact.span);
    } else if (const auto* in = std::get_if<syntax::SeenInStmt>(&stmt)) {
      if (!seen) seen = in->span;
    } else if (const auto* never = std::get_if<syntax::UnseenStmt>(&stmt)) {
      if (unseen) report_repeat(context, never->span, *unseen, "`unseen` is said twice");
      if (!unseen) unseen = never->span;
    }
  }
  for (const auto& [fact, span] : maybe) {
    const auto known = is.find(fact);
    if (known != is.end())
      report_repeat(context, span, known->second,
                    "`" + std::string(fact) + "` is said to hold, and to hold maybe");
  }
  if (seen && unseen) report_repeat(context, *unseen, *seen, "an object is seen or `unseen`");
}

void check_parameters(Context& context, const syntax::PredicateDecl& predicate) {
  std::map<std::string_view, Span> known;
  for (const syntax::Param& param : predicate.params) {
    const auto [first, is_new] = known.try_emplace(param.name.text, param.name.span);
    if (!is_new)
      report_repeat(context, param.name.span, first->second,
                    "parameter `" + std::string(param.name.text) + "` is declared twice");
  }
}

}  // namespace

void check_repeats(Context& context) {
  const auto check = [&](const auto& node) {
    using Node = std::decay_t<decltype(node)>;
    if constexpr (std::is_same_v<Node, syntax::PredicateDecl>) check_parameters(context, node);
    if constexpr (std::is_same_v<Node, syntax::ObjectDecl>) check_claims(context, node);
    if constexpr (std::is_same_v<Node, syntax::VariantsDecl>) {
      for (const syntax::VariantsMember& member : node.members) check_block(context, member.body);
    } else if constexpr (std::is_same_v<Node, syntax::MetricsDecl> ||
                         std::is_same_v<Node, syntax::DatasetDecl>) {
      // Metrics are checked where they are read; relations add up.
    } else if constexpr (requires { node.body.begin(); }) {
      check_block(context, node.body);
    }
  };
  for (const syntax::File* file : context.files) {
    for (const syntax::Decl& decl : file->decls) std::visit(check, decl.node);
  }
}

}  // namespace probe::sema
