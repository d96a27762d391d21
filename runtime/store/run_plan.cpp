#include "runtime/store/run_plan.h"

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
  const AssetRoot recorded = AssetRoot::chosen(record.asset_folders);
  return find_asset_root(recorded.check() ? recorded : AssetRoot());
}

}  // namespace probe::store
