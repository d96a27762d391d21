#include "compiler/names/symbols.h"

namespace probe::sema {
namespace {

template <typename Node>
void collect(NameTable& names, std::vector<Declared<Node>>& decls, Diagnostics& diagnostics,
             const syntax::File& file, const syntax::Decl& decl, const Node& node) {
  if (names.declare(node.name, diagnostics)) decls.push_back({&file, &decl, &node});
}

void collect_task(Symbols& symbols, Diagnostics& diagnostics, DeclaredTask task) {
  if (symbols.tasks.declare(task.name, diagnostics)) {
    symbols.task_decls.push_back(std::move(task));
  }
}

struct Collector {
  Symbols& symbols;
  Diagnostics& diagnostics;
  const syntax::File& file;
  const syntax::Decl& decl;

  void operator()(const syntax::UseDecl&) const {}
  void operator()(const syntax::DatasetDecl& node) const {
    collect(symbols.datasets, symbols.dataset_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::AttributeDecl& node) const {
    collect(symbols.attributes, symbols.attribute_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::FactsDecl& node) const {
    for (const syntax::Name& name : node.names) symbols.facts.declare(name, diagnostics);
  }
  void operator()(const syntax::ObjectDecl& node) const {
    collect(symbols.objects, symbols.object_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::ExtendDecl& node) const {
    symbols.extend_decls.push_back({&file, &decl, &node});
  }
  void operator()(const syntax::RobotDecl& node) const {
    collect(symbols.robots, symbols.robot_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::CameraDecl& node) const {
    collect(symbols.cameras, symbols.camera_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::LightDecl& node) const {
    collect(symbols.lights, symbols.light_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::FixtureDecl& node) const {
    collect(symbols.fixtures, symbols.fixture_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::SceneDecl& node) const {
    collect(symbols.scenes, symbols.scene_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::LayoutDecl& node) const {
    collect(symbols.layouts, symbols.layout_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::TemplateDecl& node) const {
    collect(symbols.templates, symbols.template_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::PredicateDecl& node) const {
    collect(symbols.predicates, symbols.predicate_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::MetricsDecl& node) const {
    collect(symbols.metrics, symbols.metrics_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::RoleDecl& node) const {
    collect(symbols.roles, symbols.role_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::TaskDecl& node) const {
    collect_task(symbols, diagnostics,
                 {&file, &decl, node.name, node.abstract, node.like, node.against, &node.body});
  }
  // `variant X of Y` is `task X like Y against Y`.
  void operator()(const syntax::VariantDecl& node) const {
    collect_task(symbols, diagnostics,
                 {&file, &decl, node.name, false, node.of, node.against ? *node.against : node.of,
                  &node.body});
  }
  void operator()(const syntax::VariantsDecl& node) const {
    for (const syntax::VariantsMember& member : node.members) {
      collect_task(symbols, diagnostics,
                   {&file, &decl, member.name, false, node.of, node.of, &member.body});
    }
  }
  // Its tasks are made when those that it goes over are known.
  void operator()(const syntax::DeriveDecl& node) const {
    symbols.derive_decls.push_back({&file, &decl, &node});
  }
  void operator()(const syntax::SetDecl& node) const {
    collect(symbols.sets, symbols.set_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::QuestionsDecl& node) const {
    collect(symbols.question_sets, symbols.question_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::SuiteDecl& node) const {
    collect(symbols.suites, symbols.suite_decls, diagnostics, file, decl, node);
  }
  void operator()(const syntax::SpaceDecl& node) const {
    collect(symbols.spaces, symbols.space_decls, diagnostics, file, decl, node);
  }
};

}  // namespace

void collect_names(const std::vector<const syntax::File*>& files, Symbols& symbols,
                   Diagnostics& diagnostics) {
  for (const syntax::File* file : files) {
    for (const syntax::Decl& decl : file->decls) {
      std::visit(Collector{symbols, diagnostics, *file, decl}, decl.node);
    }
  }
}

}  // namespace probe::sema
