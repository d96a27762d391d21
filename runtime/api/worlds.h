// Worlds side by side, stepped by several threads, and what they show as one array a field.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/api/crew.h"
#include "runtime/api/plan.h"
#include "runtime/api/vlaprobe.h"
#include "runtime/api/world.h"
#include "runtime/base/result.h"

namespace probe::api {

struct WorldsOptions {
  std::size_t worlds = 1;
  int threads = 1;
  stage::StageOptions stage = {};
  vlaprobe_autoreset autoreset = VLAPROBE_NEXT_STEP;
};

struct Metric {
  std::string name;
  bool is_truth = true;
};

// One row a world.
struct Columns {
  std::vector<std::vector<std::uint8_t>> rgb;  // by camera
  std::vector<double> tool, openness, joints, metrics;
  std::vector<std::int32_t> steps, tasks, episodes;
  std::vector<std::uint8_t> success, decided;
};

class Worlds {
 public:
  // Fails (kUsage) where the tasks do not show alike, naming two and what differs.
  static Result<std::unique_ptr<Worlds>> create(std::shared_ptr<const SharedPlan> plan,
                                                std::vector<std::uint32_t> tasks,
                                                const WorldsOptions& options);

  // Empty mask: all.
  Status reset(std::span<const std::uint8_t> mask, std::span<const vlaprobe_start> starts);
  Status step(std::span<const double> actions, std::span<const vlaprobe_start> next);

  std::size_t count() const { return options_.worlds; }
  const WorldsOptions& options() const { return options_; }
  const std::vector<Camera>& cameras() const { return cameras_; }
  const std::vector<Metric>& metrics() const { return metrics_; }
  std::size_t joints() const { return joints_; }
  const ActionBounds& actions() const { return *actions_; }
  const Columns& now() const { return now_; }
  // Empty unless episodes begin in the step that ends the last one.
  const Columns& final() const { return final_; }
  const std::vector<std::uint8_t>& terminated() const { return terminated_; }
  const std::vector<std::uint8_t>& truncated() const { return truncated_; }
  const std::vector<std::uint8_t>& begun() const { return begun_; }
  // The last step ended an episode that counts, whatever came of the next one.
  const std::vector<std::uint8_t>& ended() const { return ended_; }
  // What went wrong with a world in the last step; null: nothing.
  const std::string* fault(std::size_t world) const {
    return faults_[world] ? &*faults_[world] : nullptr;
  }
  // Null before its first reset.
  const World* world(std::size_t world) const { return worlds_[world].get(); }

 private:
  Worlds(std::shared_ptr<const SharedPlan> plan, std::vector<std::uint32_t> tasks,
         const WorldsOptions& options);
  Status look_alike();
  Status act_alike();
  Columns room() const;
  Status check_start(const vlaprobe_start& start) const;
  Status begin(std::size_t world, const vlaprobe_start& start);
  Status show(std::size_t world, Columns& out);
  void move(std::size_t world, const policy::Action& action, const vlaprobe_start* next);
  void spoil(std::size_t world, const Failure& failure);

  std::shared_ptr<const SharedPlan> plan_;
  std::vector<std::uint32_t> tasks_;  // ascending
  WorldsOptions options_;
  std::shared_ptr<const stage::SharedAssets> assets_;
  std::vector<Camera> cameras_;
  std::vector<Metric> metrics_;                    // of all tasks, each name once
  std::vector<std::vector<std::size_t>> columns_;  // of the metrics of tasks_[i], among these
  std::size_t joints_ = 0;
  std::optional<ActionBounds> actions_;
  std::vector<std::unique_ptr<World>> worlds_;
  Columns now_, final_;
  std::vector<std::uint8_t> over_;  // whose next turn is to begin anew
  std::vector<std::uint8_t> terminated_, truncated_, begun_, ended_;  // of the last step
  std::vector<std::optional<std::string>> faults_;
  Crew crew_;  // the last: its threads end before what they work on
};

}  // namespace probe::api
