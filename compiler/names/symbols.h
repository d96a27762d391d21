// Who is called what: every declaration of the files by kind, with what is needed to read it.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/model/model.h"
#include "compiler/names/name_table.h"

namespace probe::sema {

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
  std::optional<syntax::Quantity> number = {};
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
      robots{"robot"}, cameras{"camera"}, lights{"light"}, fixtures{"fixture"}, scenes{"scene"},
      layouts{"layout"}, templates{"template"}, predicates{"predicate"}, metrics{"metrics"},
      tasks{"task"}, sets{"set"}, suites{"suite"}, spaces{"space"},
      question_sets{"set of questions"}, roles{"role"};  // beside source and target

  // Parallel to the names.
  std::vector<Declared<syntax::DatasetDecl>> dataset_decls;
  std::vector<Declared<syntax::AttributeDecl>> attribute_decls;
  std::vector<Declared<syntax::ObjectDecl>> object_decls;
  std::vector<Declared<syntax::ExtendDecl>> extend_decls;  // whose name another declared
  std::vector<Declared<syntax::RobotDecl>> robot_decls;
  std::vector<Declared<syntax::CameraDecl>> camera_decls;
  std::vector<Declared<syntax::LightDecl>> light_decls;
  std::vector<Declared<syntax::FixtureDecl>> fixture_decls;
  std::vector<Declared<syntax::SceneDecl>> scene_decls;
  std::vector<Declared<syntax::LayoutDecl>> layout_decls;
  std::vector<Declared<syntax::TemplateDecl>> template_decls;
  std::vector<Declared<syntax::PredicateDecl>> predicate_decls;
  std::vector<Declared<syntax::MetricsDecl>> metrics_decls;
  std::vector<DeclaredTask> task_decls;  // those of a `derive` behind all written ones
  std::vector<Declared<syntax::DeriveDecl>> derive_decls;
  std::deque<std::string> derived_names;  // what their names are views of
  std::vector<Declared<syntax::SetDecl>> set_decls;
  std::vector<Declared<syntax::QuestionsDecl>> question_decls;
  std::vector<Declared<syntax::SuiteDecl>> suite_decls;
  std::vector<Declared<syntax::SpaceDecl>> space_decls;
  std::vector<Declared<syntax::RoleDecl>> role_decls;
};

inline Spelled spelled(const syntax::Name& name) { return {std::string(name.text), name.span}; }
inline Spelled spelled(const syntax::Text& text) { return {text.value, text.span}; }

// One row a declaration, in the order of `files`; P0203 for a name that is taken. The first keeps
// it.
void collect_names(const std::vector<const syntax::File*>& files, Symbols& symbols,
                   Diagnostics& diagnostics);

}  // namespace probe::sema
