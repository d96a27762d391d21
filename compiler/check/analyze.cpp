#include "compiler/check/analyze.h"

#include <algorithm>
#include <string_view>
#include <type_traits>

#include "compiler/check/check.h"
#include "compiler/define/define.h"
#include "compiler/names/allow.h"
#include "compiler/names/repeats.h"

namespace probe::sema {
namespace {

// Whether all names that it declares were read; of the members of a list not even then.
bool has_names(const syntax::Decl& decl) {
  if (decl.complete) return true;
  return std::visit(
      [](const auto& node) {
        using Node = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<Node, syntax::FactsDecl> ||
                      std::is_same_v<Node, syntax::AttributeDecl> ||
                      std::is_same_v<Node, syntax::VariantsDecl>)
          return false;
        if constexpr (requires { std::string_view(node.name.text); })
          return !std::string_view(node.name.text).empty();
        return true;
      },
      decl.node);
}

// A mistake by which whole declarations are not known: in the name of a file, or outside of every
// declaration that could be read.
bool loses_names(const std::vector<const syntax::File*>& files, const Diagnostic& mistake) {
  if (mistake.code == Code::P0202) return true;
  if (mistake.severity != Severity::kError) return false;
  for (const syntax::File* file : files) {
    for (const syntax::Decl& decl : file->decls) {
      if (is_within(mistake.primary, decl.span)) return !has_names(decl);
    }
  }
  return true;
}

}  // namespace

Model analyze(const SourceSet& sources, const std::vector<const syntax::File*>& files,
              const AssetRoot& asset_root, Diagnostics& diagnostics, std::vector<FileId> roots,
              const Depth& depth) {
  if (roots.empty()) {
    for (const syntax::File* file : files) roots.push_back(file->id);
  }
  Model model;
  Diagnostics found;
  Reporter reporter{found, diagnostics.has_errors()};
  reporter.depth = depth;
  Context context{sources, reporter, found, asset_root, model, files, roots};
  collect_names(files, context.symbols, found);
  check_repeats(context);
  check_allows(files, found);
  define_model(context);
  check_model({model, context.symbols, sources, files, roots, asset_root}, reporter);
  const bool lacks_names =
      std::any_of(diagnostics.items().begin(), diagnostics.items().end(),
                  [&](const Diagnostic& item) { return loses_names(files, item); });
  say(context, roots, lacks_names, diagnostics);
  return model;
}

}  // namespace probe::sema
