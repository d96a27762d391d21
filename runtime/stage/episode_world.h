// The physics of one episode, in the plan's terms: drop and settle, control steps, and what the
// judge, the policy and the trace want to know after each.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/policy/policy.h"
#include "runtime/robot/action_space.h"
#include "runtime/robot/controller.h"
#include "runtime/robot/robot.h"
#include "runtime/stage/assets.h"
#include "runtime/stage/measure.h"
#include "runtime/stage/privileged.h"
#include "runtime/stage/task_bodies.h"
#include "runtime/vm/sample.h"
#include "runtime/world/controlled.h"
#include "runtime/world/world.h"

namespace probe::stage {

// All that changes in the physics of an episode.
struct WorldState {
  std::vector<std::byte> physics;  // world::World::save()
  robot::ControlState control;
  std::vector<vm::BodyStart> starts;         // as the judge was told them after settling
  int steps = 0;                             // control steps done
  std::vector<policy::Action> waiting = {};  // said and not yet done, where actions are late
};

class EpisodeWorld {
 public:
  // `assets` were loaded for this task; the plan must live as long.
  static Result<std::unique_ptr<EpisodeWorld>> create(const plan::Plan& plan, std::uint32_t task,
                                                      std::shared_ptr<const SharedAssets> assets);

  // Drops the objects of the task's episode `index` and lets them settle with the arm out of the
  // way, then starts a fresh world from where they lie, the arm in its initial position, and lets
  // it stand still for the steps that the task idles: an episode begins behind them.
  Status reset(std::uint32_t index);

  // One control step. The world must not be used after a failure, until the next reset.
  Status act(const policy::Action& action);

  // What is to be done from the task's start `index`: for who restores one of its states, and done
  // by reset().
  Status begin_view(std::uint32_t index);

  // restore() works without a reset() before it. It fails (kWorld, kPolicy) on the state of
  // another task; only reset() and restore() may be called then.
  WorldState save() const;
  Status restore(const WorldState& state);

  // After reset() and after each act().
  int steps() const { return steps_; }
  const vm::StepSample& sample() const { return sample_; }
  std::span<const vm::BodyStart> starts() const { return starts_; }
  const policy::Privileged& privileged() const { return privileged_; }
  policy::Proprioception proprioception() const;
  // The robot's joints in drive order, then those of fixtures: rad and m, rad/s and m/s.
  std::span<const double> q() const { return world_->joints(); }
  std::span<const double> u() const { return world_->joint_speeds(); }
  // Model poses of the objects, in the order of the task's bodies.
  std::span<const Pose> objects() const { return objects_; }
  Sha256 state_hash() const { return world_->state_hash(); }

  const robot::ActionSpace& action_space() const { return space_; }
  const robot::Robot& robot() const { return robot_; }
  const TaskBodies& bodies() const { return bodies_; }
  std::vector<std::string> joint_names() const;  // of q

 private:
  EpisodeWorld(const plan::Plan& plan, const plan::TaskRecord& task,
               std::shared_ptr<const SharedAssets> assets, robot::Robot robot,
               robot::Controller controller, TaskBodies bodies, std::vector<PlacedTree> trees);

  // What an episode starts from besides the robot.
  struct Arrangement {
    std::vector<Pose> objects;           // model poses
    std::vector<double> fixture_joints;  // m and rad, of all fixtures in their order
  };
  Arrangement arrangement(std::vector<Pose> objects) const;  // fixtures' joints as they begin
  // The same as an episode begins, before things settle.
  Arrangement begun(const plan::EpisodeRecord& episode, std::vector<Pose> objects) const;
  world::WorldSpec spec_at(const Arrangement& at, bool with_robot_links) const;
  Result<Arrangement> settle(const Arrangement& placed);
  Status check_settled(const world::World& world) const;
  Status check_arm() const;
  Status idle();
  Status move(const policy::Action& action);
  policy::Action stay() const;
  policy::Action in_law(const policy::Action& action) const;
  // What moves by itself is on its way, so that it is where its way leads when this step ends.
  void lead();
  bool still_moves(const world::World& world) const;
  std::span<const double> robot_q() const { return q().first(controller_.joint_count()); }
  void measure();

  const plan::Plan& plan_;
  const plan::TaskRecord& task_;
  const plan::SceneRecord& scene_;
  const plan::RobotRecord& record_;
  std::shared_ptr<const SharedAssets> assets_;
  robot::Robot robot_;
  robot::Controller controller_;
  robot::ActionSpace space_;  // what policies say
  TaskBodies bodies_;
  Instruments instruments_;
  std::vector<world::JointSpec> drives_;  // what acts in the robot's joints
  int substeps_ = 1;                      // a control step

  // A fresh world and how its robot is driven.
  Status begin_world(const Arrangement& at);

  std::unique_ptr<world::World> world_;
  std::optional<world::ControlLoop> loop_;  // of world_
  int steps_ = 0;
  std::vector<double> arm_;             // where the robot's joints begin
  std::deque<policy::Action> waiting_;  // said and not yet done
  std::vector<Pose> objects_;
  std::vector<vm::BodyStart> starts_;
  vm::StepSample sample_;
  policy::Privileged privileged_;
  ToDos to_dos_;
};

}  // namespace probe::stage
