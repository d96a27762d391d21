// Every statement that stands once has a key, by the column `repeat` of keywords.def; two of one
// key in a block are P0203.
#include "compiler/names/repeats.h"

#include <type_traits>

#include "compiler/syntax/lexer.h"
#include "compiler/syntax/words.h"
#include "runtime/base/check.h"

namespace probe::sema {
namespace {

using Key = std::string;  // empty: may stand repeatedly

// What a statement is about, where keywords.def has `Named`.
std::string_view name_in(const syntax::PhraseStmt& stmt) { return stmt.name.text; }
std::string_view name_in(const syntax::CellsStmt& stmt) { return stmt.name.text; }
std::string_view name_in(const syntax::RegionStmt& stmt) { return stmt.name.text; }
std::string_view name_in(const syntax::FixtureJointStmt& stmt) { return stmt.joint.text; }
std::string_view name_in(const syntax::PartStmt& stmt) { return stmt.name.text; }
std::string_view name_in(const syntax::ShownStmt& stmt) { return stmt.link.text; }
std::string_view name_in(const syntax::PoseStmt& stmt) { return stmt.object.text; }
std::string_view name_in(const syntax::MovesStmt& stmt) { return stmt.what.text; }
std::string_view name_in(const syntax::MetricStmt& stmt) { return stmt.name.text; }
std::string_view name_in(const syntax::ReferStmt& stmt) { return stmt.role.text; }
std::string_view name_in(const syntax::SpaceCameraStmt& stmt) { return stmt.view.text; }

struct KeyOf {
  const syntax::StatementWord& said;

  // One that stands still, and one list of those with joints.
  Key operator()(const syntax::FixtureStmt&) const { return "fixture \"...\""; }
  Key operator()(const syntax::SceneFixturesStmt&) const { return "fixture"; }
  Key operator()(const syntax::StartStmt& stmt) const {
    if (stmt.fixture.text.empty()) return "start none";
    return "start " + std::string(stmt.fixture.text) + "." + std::string(stmt.joint.text);
  }

  Key operator()(const syntax::TaskCameraStmt& stmt) const {
    return stmt.as ? "camera as " + std::string(stmt.as->text) : "camera";
  }
  Key operator()(const syntax::TextureStmt& stmt) const {
    return stmt.of ? "texture " + std::string(stmt.of->text) : "texture";
  }
  Key operator()(const syntax::RoleStmt& stmt) const { return Key(stmt.role.text); }
  template <typename Stmt>
  Key operator()(const Stmt& stmt) const {
    const Key word(said.word);
    if (said.repeat == syntax::Repeat::kMany) return {};
    if (said.repeat == syntax::Repeat::kOnce) return word;
    if constexpr (requires { name_in(stmt); }) return word + " " + std::string(name_in(stmt));
    PROBE_CHECK(false, "a statement that may be repeated for another name has one");
    return {};
  }
};

void report_repeat(Context& context, const Span& span, const Span& first, const std::string& what) {
  context.report(Code::P0203, span, what).label(first, "first said here");
}

// The word that a statement begins with.
std::string_view first_word(std::string_view text) {
  std::size_t end = 0;
  while (end < text.size() && syntax::is_word(text[end])) ++end;
  return text.substr(0, end);
}

template <typename Stmt>
void check_block(Context& context, syntax::Block block, const std::vector<Stmt>& body) {
  std::map<Key, Span> said;
  for (const Stmt& stmt : body) {
    const Span span = std::visit([](const auto& node) { return node.span; }, stmt);
    const std::string_view word = first_word(context.sources.text(span));
    const syntax::StatementWord* known = syntax::find_statement(block, word);
    // Other words are attributes of an object, each of which is given once.
    const Key key = known == nullptr ? Key(word) : std::visit(KeyOf{*known}, stmt);
    if (key.empty()) continue;
    const auto [first, is_new] = said.try_emplace(key, span);
    if (!is_new)
      report_repeat(context, span, first->second, "`" + key + "` is said twice in this block");
  }
}

// Which block of keywords.def a declaration has.
syntax::Block block_of(const syntax::ObjectDecl&) { return syntax::Block::kObject; }
syntax::Block block_of(const syntax::ExtendDecl&) { return syntax::Block::kObject; }
syntax::Block block_of(const syntax::RobotDecl&) { return syntax::Block::kRobot; }
syntax::Block block_of(const syntax::CameraDecl&) { return syntax::Block::kCamera; }
syntax::Block block_of(const syntax::LightDecl&) { return syntax::Block::kLight; }
syntax::Block block_of(const syntax::FixtureDecl&) { return syntax::Block::kFixture; }
syntax::Block block_of(const syntax::SceneDecl&) { return syntax::Block::kScene; }
syntax::Block block_of(const syntax::LayoutDecl&) { return syntax::Block::kLayout; }
syntax::Block block_of(const syntax::TaskDecl&) { return syntax::Block::kTask; }
syntax::Block block_of(const syntax::VariantDecl&) { return syntax::Block::kTask; }
syntax::Block block_of(const syntax::DeriveDecl&) { return syntax::Block::kTask; }
syntax::Block block_of(const syntax::SuiteDecl&) { return syntax::Block::kSuite; }
syntax::Block block_of(const syntax::SpaceDecl&) { return syntax::Block::kSpace; }

// A fact has one truth, and a thing is seen or is not.
void check_claims(Context& context, const std::vector<syntax::ObjectStmt>& body) {
  std::map<std::string_view, Span> is, maybe;
  std::optional<Span> seen, unseen;
  for (const syntax::ObjectStmt& stmt : body) {
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

// What a task changes in its scene is a block of its own.
void check_scenes(Context& context, const std::vector<syntax::TaskStmt>& body) {
  for (const syntax::TaskStmt& stmt : body) {
    if (const auto* scene = std::get_if<syntax::TaskSceneStmt>(&stmt))
      check_block(context, syntax::Block::kScene, scene->body);
  }
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
    if constexpr (std::is_same_v<Node, syntax::ObjectDecl> ||
                  std::is_same_v<Node, syntax::ExtendDecl>)
      check_claims(context, node.body);
    if constexpr (std::is_same_v<Node, syntax::RobotDecl>) {
      for (const syntax::RobotStmt& stmt : node.body) {
        if (const auto* control = std::get_if<syntax::ControlStmt>(&stmt))
          check_block(context, syntax::Block::kControl, control->body);
      }
    }
    if constexpr (std::is_same_v<Node, syntax::FixtureDecl>) {
      for (const syntax::FixtureBodyStmt& stmt : node.body) {
        if (const auto* part = std::get_if<syntax::PartStmt>(&stmt))
          check_block(context, syntax::Block::kPart, part->body);
      }
    }
    if constexpr (std::is_same_v<Node, syntax::VariantsDecl>) {
      for (const syntax::VariantsMember& member : node.members) {
        check_block(context, syntax::Block::kTask, member.body);
        check_scenes(context, member.body);
      }
    } else if constexpr (std::is_same_v<Node, syntax::MetricsDecl> ||
                         std::is_same_v<Node, syntax::QuestionsDecl> ||
                         std::is_same_v<Node, syntax::DatasetDecl>) {
      // Metrics and questions are checked where they are read; relations add up.
    } else if constexpr (requires { node.body.begin(); }) {
      check_block(context, block_of(node), node.body);
      if constexpr (requires { check_scenes(context, node.body); })
        check_scenes(context, node.body);
    }
  };
  for (const syntax::File* file : context.files) {
    for (const syntax::Decl& decl : file->decls) std::visit(check, decl.node);
  }
}

}  // namespace probe::sema
