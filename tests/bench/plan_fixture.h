// The suite, compiled once, and the assets of its first task.
#pragma once

#include <memory>

#include "compiler/emit/compile.h"
#include "runtime/plan/plan.h"
#include "runtime/stage/assets.h"
#include "tests/bench/need.h"

namespace probe::bench {

inline const plan::Plan& suite_plan() {
  static const plan::Plan plan = [] {
    const std::string files[] = {suite_path()};
    Compilation compiled = need(build(files, {.asset_root = asset_root(), .suite = ""}));
    return need(plan::Plan::from_bytes(std::move(compiled.plan)));
  }();
  return plan;
}

inline std::uint32_t bench_task() { return suite_plan().find_task("carrot_on_plate").value(); }

inline std::shared_ptr<const stage::SharedAssets> suite_assets() {
  static const auto assets = [] {
    const std::uint32_t tasks[] = {bench_task()};
    return need(stage::SharedAssets::load(suite_plan(), asset_root(), tasks));
  }();
  return assets;
}

}  // namespace probe::bench
