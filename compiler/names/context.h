// What every pass of the analysis shares: the declared names, the way to ask for one, and the way
// to read a quantity. Each helper reports its own mistake and answers "nothing", so that one
// mistake gives one message.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/model/model.h"
#include "compiler/syntax/ast.h"

namespace probe::sema {

// The names of one kind, in the order of declaration.
class NameTable {
 public:
  explicit NameTable(std::string kind) : kind_(std::move(kind)) {}

  // The index of the new name; nothing (and P0203) when it is taken.
  std::optional<std::uint32_t> declare(const syntax::Name& name, Diagnostics& diagnostics);
  // Nothing, and P0201 with the nearest spelling, when there is none.
  std::optional<std::uint32_t> find(const syntax::Name& name, Diagnostics& diagnostics) const;
  std::optional<std::uint32_t> peek(std::string_view text) const;

  const std::string& kind() const { return kind_; }
  const std::vector<syntax::Name>& names() const { return names_; }

 private:
  std::string kind_;
  std::vector<syntax::Name> names_;
  std::unordered_map<std::string_view, std::uint32_t> by_text_;
};

// P0201 for a name that is none of `candidates`.
Diagnostic& report_unknown(Diagnostics& diagnostics, std::string_view kind,
                           const syntax::Name& name,
                           const std::vector<std::string_view>& candidates);

// A declaration with what is needed to read it.
template <typename Node>
struct Declared {
  const syntax::File* file = nullptr;
  const syntax::Decl* decl = nullptr;
  const Node* node = nullptr;
};

// A name that `derive` binds, with what it stands for in one of its tasks.
struct Binding {
  std::string_view name, value;
};

// A task is declared in one of four ways; this is what they have in common.
struct DeclaredTask {
  const syntax::File* file = nullptr;
  const syntax::Decl* decl = nullptr;
  syntax::Name name;
  bool abstract = false;
  std::optional<syntax::Name> like;
  std::optional<syntax::Name> against;
  const std::vector<syntax::TaskStmt>* body = nullptr;
  bool derived = false;
  std::vector<Binding> bindings = {};
};

struct Symbols {
  NameTable datasets{"dataset"}, attributes{"attribute"}, facts{"fact"}, objects{"object"},
      robots{"robot"}, cameras{"camera"}, lights{"light"}, scenes{"scene"}, layouts{"layout"},
      templates{"template"}, predicates{"predicate"}, metrics{"metrics"}, tasks{"task"},
      sets{"set"}, suites{"suite"};

  // Parallel to the names.
  std::vector<Declared<syntax::DatasetDecl>> dataset_decls;
  std::vector<Declared<syntax::AttributeDecl>> attribute_decls;
  std::vector<Declared<syntax::ObjectDecl>> object_decls;
  std::vector<Declared<syntax::RobotDecl>> robot_decls;
  std::vector<Declared<syntax::CameraDecl>> camera_decls;
  std::vector<Declared<syntax::LightDecl>> light_decls;
  std::vector<Declared<syntax::SceneDecl>> scene_decls;
  std::vector<Declared<syntax::LayoutDecl>> layout_decls;
  std::vector<Declared<syntax::TemplateDecl>> template_decls;
  std::vector<Declared<syntax::PredicateDecl>> predicate_decls;
  std::vector<Declared<syntax::MetricsDecl>> metrics_decls;
  std::vector<DeclaredTask> task_decls;  // those of a `derive` behind all written ones
  std::vector<Declared<syntax::DeriveDecl>> derive_decls;
  std::deque<std::string> derived_names;  // what their names are views of
  std::vector<Declared<syntax::SetDecl>> set_decls;
  std::vector<Declared<syntax::SuiteDecl>> suite_decls;
};

struct Context {
  const SourceSet& sources;
  Diagnostics& diagnostics;
  std::string asset_root;
  Model& model;
  Symbols symbols;
  std::vector<const syntax::File*> files;  // a file after the files it uses
  std::map<std::size_t, Span> about = {};  // by diagnostic: the declaration it is about
  bool was_broken = false;  // the text had errors before: what lacks now may follow from them

  std::size_t levels = 0;  // open in one another, through predicates or sets: see Level

  std::size_t unread = 0;  // quantities of unknown units, which the lexer reported

  // Grows with every mistake: whether something was wrong between two calls.
  std::size_t mistakes() const { return diagnostics.error_count() + unread; }
  bool has_errors() const { return was_broken || diagnostics.has_errors(); }
  Diagnostic& report(Code code, const Span& span, std::string message) {
    return diagnostics.report(code, span, std::move(message));
  }
};

// While it lives, what is reported is about this declaration, wherever it points: an @allow there
// silences it.
class About {
 public:
  About(Context& context, const Span& decl)
      : context_(context), decl_(decl), first_(context.diagnostics.size()) {}
  ~About() {
    for (std::size_t i = first_; i < context_.diagnostics.size(); ++i)
      context_.about.insert({i, decl_});
  }
  About(const About&) = delete;
  About& operator=(const About&) = delete;

 private:
  Context& context_;
  Span decl_;
  std::size_t first_;
};

// The parser bounds the levels of one expression; names that stand for further expressions add up
// to at most this many, in whatever order they are declared.
inline constexpr std::size_t kMaxLevels = 1000;

// One level, while it lives.
class Level {
 public:
  explicit Level(Context& context) : context_(context) { ++context_.levels; }
  ~Level() { --context_.levels; }
  Level(const Level&) = delete;
  Level& operator=(const Level&) = delete;

 private:
  Context& context_;
};

// P0103 at the name behind which the levels are too many.
void report_levels(Diagnostics& diagnostics, const Span& name);

// Fills the symbols; P0203.
void collect_names(Context& context);

// ---- quantities
// -----------------------------------------------------------------------------------------------------

// `takes` finishes the message at the number: "`density` takes a density".
std::optional<Quantity> read_quantity(Context& context, const syntax::Quantity& written,
                                      const Dimension& wanted, std::string_view takes);
std::optional<double> read_si(Context& context, const syntax::Quantity& written,
                              const Dimension& wanted, std::string_view takes);
// As read_si, and P0304 unless the value is above zero.
std::optional<double> read_positive(Context& context, const syntax::Quantity& written,
                                    const Dimension& wanted, std::string_view takes);
// Every coordinate, of which there must be `least` to `most`.
std::optional<std::vector<Quantity>> read_point(Context& context, const syntax::Point& point,
                                                std::size_t least, std::size_t most,
                                                const Dimension& wanted, std::string_view takes);
std::optional<Turn> read_turn(Context& context, const syntax::Pose& pose);
std::optional<std::vector<Turn>> read_turns(Context& context,
                                            const std::vector<syntax::Pose>& poses);
Turn make_turn(const Quantity* roll, const Quantity* pitch, const Quantity* yaw);

// The order in which records that copy one another can be filled: a parent before its children. A
// circle is P0207 and its members lose their parent. `parents[i]` is an index or nothing; `names`
// and `spans` are for the message.
std::vector<std::uint32_t> parents_first(Context& context,
                                         std::vector<std::optional<std::uint32_t>>& parents,
                                         const std::vector<syntax::Name>& names);

inline Spelled spelled(const syntax::Name& name) { return {std::string(name.text), name.span}; }
inline Spelled spelled(const syntax::Text& text) { return {text.value, text.span}; }

}  // namespace probe::sema
