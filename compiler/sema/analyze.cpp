#include "compiler/sema/analyze.h"

#include "compiler/sema/passes.h"

namespace probe::sema {

Model analyze(const SourceSet& sources, const std::vector<const syntax::File*>& files,
              const std::string& asset_root, Diagnostics& diagnostics) {
  Model model;
  Context context{.sources = sources,
                  .diagnostics = diagnostics,
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
  return model;
}

}  // namespace probe::sema
