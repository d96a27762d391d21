#include "runtime/store/run_plan.h"

#include "runtime/plan/asset_files.h"
#include "runtime/store/store.h"

namespace probe::store {

Result<plan::Plan> open_run_plan(const std::string& dir) {
  PROBE_ASSIGN(const RunRecord record, read_run_record(dir));
  const std::string path = plan_path(dir);
  auto plan = plan::Plan::open(path);
  if (!plan) {
    return Failure{Fault::kStore,
                   "the plan of this run cannot be read: " + plan.failure().message +
                       "; `vlaprobe run` with the plan it was begun with puts it back",
                   path};
  }
  const std::string root = to_hex(plan->root());
  if (root == record.identity.plan_root) return plan;
  return Failure{Fault::kStore,
                 "is not the plan of this run (root " + root.substr(0, 12) + ", recorded " +
                     record.identity.plan_root.substr(0, 12) +
                     "); `vlaprobe run` with the plan it was begun with puts it back",
                 path};
}

Result<AssetRoot> find_run_assets(const std::string& dir, const AssetRoot& chosen) {
  if (!chosen.empty()) return find_asset_root(chosen);
  PROBE_ASSIGN(const RunRecord record, read_run_record(dir));
  // A folder that is gone, as the program's own after an upgrade, takes no other with it.
  std::vector<std::string> folders;
  for (const std::string& folder : record.asset_folders) {
    if (AssetRoot::chosen({folder}).check()) folders.push_back(folder);
  }
  if (folders.empty()) return find_asset_root();
  if (folders.size() == record.asset_folders.size()) return AssetRoot::chosen(folders);
  const auto own = find_asset_root();
  if (own) {
    for (const std::string& folder : own->folders()) folders.push_back(folder);
  }
  return AssetRoot::chosen(folders);
}

std::vector<std::string> files_of_run(const std::string& dir, const AssetRoot& chosen) {
  const auto plan = open_run_plan(dir);
  const auto root = find_run_assets(dir, chosen);
  if (!plan || !root) return {};
  return plan::asset_files(*plan, *root);
}

}  // namespace probe::store
