// The check of each format, which check_dataset() chooses from by what lies in the folder.
#pragma once

#include <string>

#include "runtime/base/result.h"
#include "runtime/export/dataset/check.h"
#include "runtime/export/dataset/named_runs.h"

namespace probe::dataset {

Result<CheckReport> check_lerobot(const std::string& dir, NamedRuns runs);
Result<CheckReport> check_robomimic(const std::string& dir, NamedRuns runs);
Result<CheckReport> check_rlds(const std::string& dir, NamedRuns runs);

}  // namespace probe::dataset
