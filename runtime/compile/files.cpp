#include "runtime/compile/files.h"

#include <algorithm>
#include <utility>

#include "runtime/assets/asset_check.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/glob.h"
#include "runtime/compile/library.h"

namespace probe::compile {

Result<Compilation> compile_files(const std::vector<std::string>& files,
                                  const FilesRequest& request) {
  PROBE_ASSIGN(const AssetRoot root, find_asset_root(request.assets));
  PROBE_ASSIGN(std::vector<std::string> library, find_library_folders(request.library));
  PROBE_ASSIGN(AssetInspector inspect, assets::AssetCheck::open(root));
  CompileOptions options{.asset_root = root,
                         .suite = request.suite,
                         .library_folders = std::move(library),
                         .inspect_asset = std::move(inspect),
                         .unsaved = request.unsaved,
                         .stop = request.stop,
                         .plans = request.plans};
  if (!request.tasks.empty()) {
    options.wants_task = [glob = request.tasks](std::string_view name) {
      // A task may be asked for with its suite's prefix before it.
      return matches_glob(glob, name) || glob.ends_with("_" + std::string(name));
    };
  }
  return request.wants_plan ? build(files, options) : check(files, options);
}

AssetRoot root_for(const plan::Plan& plan, const AssetRoot& root) {
  std::vector<std::string> paths;
  for (const plan::AssetRecord& asset : plan.assets()) paths.emplace_back(plan.text(asset.path));
  return root.kept_for(paths);
}

AssetRoot root_for_file(const plan::Plan& plan, const std::string& path, const AssetRoot& chosen) {
  const auto root = find_asset_root(chosen);
  if (!root) return chosen;
  return root_for(plan, root->beside(std::span(&path, 1)));
}

bool lacks_only_assets(const Diagnostics& diagnostics) {
  const auto& items = diagnostics.items();
  return diagnostics.error_count() > 0 && std::ranges::all_of(items, [](const Diagnostic& said) {
           return said.severity != Severity::kError || said.code == Code::P0202;
         });
}

}  // namespace probe::compile
