#include "compiler/sema/analyze.h"

#include "compiler/sema/passes.h"
#include "compiler/sema/report.h"

namespace probe::sema {

Model analyze(const SourceSet& sources, const std::vector<const syntax::File*>& files,
              const std::string& asset_root, Diagnostics& diagnostics, std::vector<FileId> roots) {
  Model model;
  Diagnostics found;
  Context context{.sources = sources,
                  .diagnostics = found,
                  .asset_root = asset_root,
                  .model = model,
                  .symbols = {},
                  .files = files};
  collect_names(context);
  define_catalog(context);
  define_stage(context);
  define_layouts(context);
  define_templates(context);
  define_judgement(context);
  define_tasks(context);
  check_comparisons(context);
  check_language(context);
  check_starts(context);
  check_metrics(context);
  define_sets(context);
  define_suites(context);
  check_tags(context);
  check_magnitudes(context);
  if (roots.empty()) {
    for (const syntax::File* file : files) roots.push_back(file->id);
  }
  check_unused(context, roots);
  say(context, roots, diagnostics);
  return model;
}

}  // namespace probe::sema
