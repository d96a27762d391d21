// The files of a plan's models and pictures, where they lie. Header only.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/asset_root.h"
#include "runtime/plan/plan.h"

namespace probe::plan {

inline std::vector<std::string> asset_files(const Plan& plan, const AssetRoot& root) {
  std::vector<std::string> files;
  for (const AssetRecord& asset : plan.assets()) files.push_back(root.file(plan.text(asset.path)));
  return files;
}

}  // namespace probe::plan
