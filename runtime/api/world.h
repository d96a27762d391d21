// One world of the library's: a stage that refuses what a stage must not be asked. Stages and
// batches of the interface stand on it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/api/plan.h"
#include "runtime/api/vlaprobe.h"
#include "runtime/base/result.h"
#include "runtime/robot/action_space.h"
#include "runtime/stage/stage.h"

namespace probe::api {

// What a caller said as an action, as one. Fails (kUsage) on another count than `size` and on
// numbers that are none: not finite, or larger than any policy means.
Result<policy::Action> read_action(std::span<const double> numbers, std::size_t size);

// What a robot's actions are, and between what numbers they usually lie.
struct ActionBounds {
  robot::ActionSpace space;
  std::vector<double> low, high;  // one for each number
  explicit ActionBounds(const robot::Robot& robot);
  vlaprobe_action_space told() const;  // its arrays are this
};

// Of a task, also of a world without pictures.
struct Camera {
  std::string name;
  int width = 0, height = 0;  // of its pictures
  bool operator==(const Camera&) const = default;
};
std::vector<Camera> cameras_of(const plan::Plan& plan, const plan::TaskRecord& task,
                               const stage::ImageSize& size);

// Fails (kUsage) on a picture that is too large, and on one side without the other.
Status check_picture_size(std::int32_t width, std::int32_t height);

class World {
 public:
  static Result<std::unique_ptr<World>> create(std::shared_ptr<const SharedPlan> plan,
                                               std::uint32_t task,
                                               std::shared_ptr<const stage::SharedAssets> assets,
                                               const stage::StageOptions& options);

  // Fails (kUsage) on an episode that there is not, (kWorld) where the instruction does not hold of
  // the settled start.
  Status reset(std::int32_t episode);
  // Fails (kUsage) before the first reset, behind a failure, and when the episode is over.
  Status step(const policy::Action& action);
  // The same questions, without the step.
  Status check_step() const;
  // The pictures of what is now; an episode that is over has its last ones.
  Result<policy::Observation> observe();
  Status restore(std::span<const std::byte> bytes);
  Result<std::vector<std::byte>> save() const;

  bool has_episode() const { return phase_ == Phase::kInEpisode; }
  // Counts resets and restores: what was told of an episode holds as long as this stays.
  std::uint64_t turn() const { return turn_; }
  Status check_episode() const;
  bool terminated() const { return stage_->judge().ended(); }
  bool truncated() const { return stage_->steps() >= horizon_ && !terminated(); }
  bool success() const { return success_ && stage_->judge().truth(*success_); }
  int horizon() const { return horizon_; }
  std::int32_t episode() const { return episode_; }
  // Position and rotation (w x y z) of the objects' model frames, in a row each.
  std::span<const double> objects();
  std::size_t object_count() const { return object_count_; }
  // Position and rotation (w x y z) of the tool centre point in the robot's base frame.
  void write_tool(double (&out)[7]);
  const ActionBounds& actions() const { return actions_; }
  // Since the last reset or step.
  const policy::Proprioception& proprioception();

  const std::vector<Camera>& cameras() const { return cameras_; }
  // The robot's in drive order, then those of fixtures.
  const std::vector<std::string>& joint_names() const { return joint_names_; }

  stage::Stage& stage() { return *stage_; }
  const stage::Stage& stage() const { return *stage_; }
  const SharedPlan& plan() const { return *plan_; }
  std::uint32_t task() const { return stage_->task(); }

 private:
  enum class Phase { kEmpty, kInEpisode, kBroken };
  World(std::shared_ptr<const SharedPlan> plan, std::unique_ptr<stage::Stage> stage,
        stage::ImageSize size);
  std::string place() const;

  std::shared_ptr<const SharedPlan> plan_;  // what the stage refers to
  std::unique_ptr<stage::Stage> stage_;
  Phase phase_ = Phase::kEmpty;
  std::int32_t episode_ = 0;
  std::uint64_t turn_ = 0;
  int horizon_ = 0;
  std::optional<std::uint32_t> success_;
  std::vector<Camera> cameras_;
  std::vector<std::string> joint_names_;
  std::size_t object_count_ = 0;
  ActionBounds actions_;
  std::vector<double> objects_;
  std::optional<policy::Proprioception> proprioception_;  // of now, when it was asked for
};

}  // namespace probe::api
