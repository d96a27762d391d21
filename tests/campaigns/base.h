// What campaigns begin with: a plan of the project's own text, with the files that its tasks need.
#pragma once

#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "runtime/compile/files.h"
#include "runtime/plan/plan.h"
#include "runtime/stage/assets.h"
#include "tests/campaigns/driver.h"

namespace probe::campaign {

inline AssetRoot asset_root() { return AssetRoot(VLAPROBE_SOURCE_DIR "/assets"); }
inline compile::FilesRequest request() {
  return {.assets = asset_root(), .library = VLAPROBE_SOURCE_DIR "/dsl"};
}

struct Base {
  plan::Plan plan;
  std::shared_ptr<const stage::SharedAssets> assets;  // of all its tasks
};

// Ends `program` with the reason where there is none. `tasks`: glob over those to keep.
inline Base base_of(const std::string& program, const std::string& file,
                    const std::string& tasks = "") {
  compile::FilesRequest wanted = request();
  wanted.tasks = tasks;
  auto compiled = compile::compile_files({file}, wanted);
  if (!compiled) usage(program, to_text(compiled.failure()));
  if (compiled->plan.empty()) usage(program, file + " makes no plan: `vlaprobe check` says why");
  auto plan = plan::Plan::from_bytes(std::move(compiled->plan));
  if (!plan) usage(program, to_text(plan.failure()));
  std::vector<std::uint32_t> all(plan->tasks().size());
  std::iota(all.begin(), all.end(), 0u);
  auto assets = stage::SharedAssets::load(*plan, asset_root(), all);
  if (!assets) usage(program, to_text(assets.failure()));
  return {std::move(*plan), std::move(*assets)};
}

// Of the texts that the words name, one at least.
inline std::vector<Base> bases_of(const std::string& program, const Options& options) {
  if (options.words.empty()) usage(program, "no text to begin with");
  std::vector<Base> bases;
  for (const std::string& file : options.words) bases.push_back(base_of(program, file));
  return bases;
}

}  // namespace probe::campaign
