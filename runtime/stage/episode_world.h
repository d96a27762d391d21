// The physics of one episode, in the plan's terms: drop and settle, control steps, and what the
// judge, the policy and the trace want to know after each. Task-local bodies are mapped to the
// world's parties here and nowhere else.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/policy/policy.h"
#include "runtime/robot/control.h"
#include "runtime/robot/kinematics.h"
#include "runtime/stage/assets.h"
#include "runtime/vm/sample.h"
#include "runtime/world/world.h"

namespace probe::stage {

// All that changes in the physics of an episode.
struct WorldState {
  std::vector<std::byte> physics;  // world::World::save()
  robot::ControlState control;
  std::vector<vm::BodyStart> starts;  // as the judge was told them after settling
  int steps = 0;                      // control steps done
};

class EpisodeWorld {
 public:
  // `assets` were loaded for this task; the plan must live as long.
  static Result<std::unique_ptr<EpisodeWorld>> create(const plan::Plan& plan, std::uint32_t task,
                                                      std::shared_ptr<const SharedAssets> assets);

  // Drops the objects of the task's episode `index` and lets them settle with the arm out of the
  // way, then starts a fresh world from where they lie, the arm in its initial position.
  Status reset(std::uint32_t index);

  // One control step. The world must not be used after a failure, until the next reset.
  Status act(const policy::Action& action);

  // restore() works without a reset() before it. It fails (codes "world", "policy") on the state of
  // another task; only reset() and restore() may be called then.
  WorldState save() const;
  Status restore(const WorldState& state);

  // After reset() and after each act().
  int steps() const { return steps_; }
  const vm::StepSample& sample() const { return sample_; }
  std::span<const vm::BodyStart> starts() const { return starts_; }
  const policy::Privileged& privileged() const { return privileged_; }
  policy::Proprioception proprioception() const;
  std::span<const double> q() const { return world_->joints(); }
  std::span<const double> u() const { return world_->joint_speeds(); }
  std::span<const Pose> objects() const {
    return objects_;
  }  // model poses: source, target, distractors
  Sha256 state_hash() const { return world_->state_hash(); }

  const std::vector<std::string>& joint_names() const { return joints_; }
  const std::string& urdf_path() const { return parts_->model.path; }
  const std::string& tcp_link() const { return tcp_link_; }

 private:
  EpisodeWorld(const plan::Plan& plan, std::shared_ptr<const SharedAssets> assets, robot::Tree tree,
               robot::EeDeltaPoseController controller)
      : plan_(plan),
        assets_(std::move(assets)),
        tree_(std::move(tree)),
        controller_(std::move(controller)) {}

  Status read_bodies();
  world::WorldSpec spec_at(std::span<const Pose> poses, bool with_links) const;
  Result<std::vector<Pose>> settle(std::span<const Pose> placed);
  void take_starts();
  void measure();
  std::uint16_t local_index(const world::Party& party) const;

  const plan::Plan& plan_;
  std::shared_ptr<const SharedAssets> assets_;
  const plan::TaskRecord* task_ = nullptr;
  const plan::SceneRecord* scene_ = nullptr;
  const plan::RobotRecord* robot_ = nullptr;
  const RobotParts* parts_ = nullptr;
  robot::Tree tree_;
  robot::EeDeltaPoseController controller_;
  std::vector<std::string> joints_;
  std::string tcp_link_;
  int tcp_ = 0;       // link index
  int substeps_ = 1;  // a control step
  Pose base_;
  std::size_t object_count_ = 0;  // bodies 0 .. object_count_ - 1
  static constexpr std::uint16_t kNoFixture = 0xffff;
  std::uint16_t surface_ = 0, first_link_ = 0, fixture_ = kNoFixture;  // task-local
  std::vector<int> links_;  // URDF link of each link body

  std::unique_ptr<world::World> world_;
  int steps_ = 0;
  std::vector<Pose> objects_, link_poses_;
  Eigen::MatrixXd jacobian_;
  std::vector<vm::BodyStart> starts_;
  vm::StepSample sample_;
  policy::Privileged privileged_;
};

}  // namespace probe::stage
