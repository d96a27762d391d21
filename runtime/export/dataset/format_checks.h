// The check of each format, which check_dataset() chooses from by what lies in the folder. `again`:
// what draws pictures anew that are no copies of the policy's; null: they are not looked at.
#pragma once

#include <string>

#include "runtime/base/result.h"
#include "runtime/export/dataset/check.h"
#include "runtime/export/dataset/named_runs.h"
#include "runtime/export/dataset/pictures_again.h"

namespace probe::dataset {

Result<CheckReport> check_lerobot(const std::string& dir, NamedRuns runs, PicturesAgain* again);
Result<CheckReport> check_robomimic(const std::string& dir, NamedRuns runs, PicturesAgain* again);
Result<CheckReport> check_rlds(const std::string& dir, NamedRuns runs, PicturesAgain* again);

}  // namespace probe::dataset
