// What is installed and whether it computes what it should: for `vlaprobe doctor`, and for anybody
// who wonders why two machines disagree.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/asset_root.h"
#include "runtime/doctor/golden_frames.h"
#include "runtime/plan/plan.h"

namespace probe::doctor {

struct DoctorReport {
  store::Fingerprint fingerprint;     // of this process with the shipped assets' manifest
  std::string ray_engine;             // Embree's version and packet sizes
  std::vector<std::string> cpu_sets;  // instruction sets that libraries choose their code by
  std::string code_level;             // of the hot loops: x86-64-v2, v3 or v4
  std::string asset_root;             // its folders, as they are read out
  int asset_files = 0;                    // of the manifest
  std::vector<std::string> asset_damage;  // "path: has other bytes"
  std::string mesh_cache;                 // folder, empty: none
  bool own_assets = true;     // those of the golden pictures; else nothing is drawn or dropped
  std::string settle_state;   // hash after the drop, hexadecimal
  std::string golden_folder;  // empty: not here
  std::optional<GoldenReport> golden;
  std::string no_suite;  // why the suite's own scenes were not drawn; empty: they were
  bool fine() const;
};

// The suite whose scenes are drawn, compiled with the asset folder that is examined, or why there
// is none.
using SuiteMaker = std::function<Result<plan::Plan>(const AssetRoot& asset_root)>;

// `assets` as find_asset_root. Fails when there is no asset folder or its objects cannot be drawn.
Result<DoctorReport> examine(const AssetRoot& assets, const SuiteMaker& suite);

std::string to_json(const DoctorReport& report, const std::string& version);
std::string to_text(const DoctorReport& report, const std::string& version);

}  // namespace probe::doctor
