#include "runtime/export/dataset/check.h"

#include <optional>

#include "runtime/base/paths.h"
#include "runtime/export/dataset/format_checks.h"
#include "runtime/export/dataset/lerobot.h"
#include "runtime/export/dataset/rlds.h"
#include "runtime/export/dataset/robomimic.h"

namespace probe::dataset {

Result<CheckReport> check_dataset(const std::string& dir, const CheckOptions& options) {
  PROBE_ASSIGN(NamedRuns named, NamedRuns::open(dir, options.runs));
  std::optional<PicturesAgain> again;
  if (options.redraws) again.emplace(named.shape(), options.assets);
  PicturesAgain* const drawn = again ? &*again : nullptr;
  if (is_file(dir + "/" + lerobot::kInfoPath)) return check_lerobot(dir, std::move(named), drawn);
  if (is_file(dir + "/" + robomimic::kFile)) return check_robomimic(dir, std::move(named), drawn);
  if (is_file(dir + "/" + rlds::kDatasetVersion + "/dataset_info.json"))
    return check_rlds(dir, std::move(named), drawn);
  return Failure{Fault::kUsage,
                 "is no dataset of a format that is checked: it has no meta/info.json, no " +
                     std::string(robomimic::kFile) + " and no " + rlds::kDatasetVersion + "/",
                 dir};
}

}  // namespace probe::dataset
