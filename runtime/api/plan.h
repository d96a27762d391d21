// A plan behind its handle: the plan, where its files lie, and what was read of them for worlds.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "runtime/api/vlaprobe.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/stage/assets.h"

namespace probe::api {

// Shared by all that was made of the plan.
class SharedPlan {
 public:
  // `assets`: empty: found by itself when they are first needed.
  SharedPlan(plan::Plan plan, AssetRoot assets);

  const plan::Plan& plan() const { return plan_; }
  const std::string& root() const { return root_; }
  const AssetRoot& asset_root() const { return asset_root_; }
  // With zero bytes at their ends.
  const std::string& asset_folders() const { return asset_folders_; }  // one a line
  const std::string& name(std::uint32_t task) const { return names_[task]; }
  const std::string& instruction(std::uint32_t task) const { return instructions_[task]; }
  const std::string& object_name(std::uint32_t object) const { return objects_[object]; }
  const std::string& suite_name(std::size_t suite) const { return suites_[suite]; }
  const std::string& suite_prefix(std::size_t suite) const { return prefixes_[suite]; }

  Result<std::uint32_t> find_task(std::string_view name) const;
  // Fail (kUsage) naming the number and what there is.
  Result<std::uint32_t> task(std::size_t number) const;
  Status check_episode(std::uint32_t task, std::int32_t episode) const;

  // The files that these tasks need, read when they are first asked for.
  Result<std::shared_ptr<const stage::SharedAssets>> assets(
      std::span<const std::uint32_t> tasks) const;
  void forget() const;

  struct Said {
    std::string text, json = "[]";
  };
  Said warnings;
  bool only_used_suites = false;  // a text that declares none, while files that it uses do

 private:
  struct Loaded {
    std::vector<std::uint32_t> tasks;  // ascending
    std::shared_ptr<const stage::SharedAssets> assets;
  };

  plan::Plan plan_;
  std::string root_;
  AssetRoot asset_root_;
  std::string asset_folders_;
  std::vector<std::string> names_, instructions_, objects_, suites_, prefixes_;
  mutable std::mutex mutex_;  // what follows
  mutable std::vector<Loaded> loaded_;
};

// What names `task` in messages.
std::string task_place(const SharedPlan& plan, std::uint32_t task);

}  // namespace probe::api

struct vlaprobe_plan {
  std::shared_ptr<probe::api::SharedPlan> shared;
};
