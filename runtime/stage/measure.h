// What the judge and the trace read of a world: bodies, contacts, joints, the tool.
#pragma once

#include <vector>

#include "runtime/plan/plan.h"
#include "runtime/stage/placed_tree.h"
#include "runtime/stage/task_bodies.h"
#include "runtime/vm/sample.h"
#include "runtime/world/world.h"

namespace probe::stage {

// Of one task. Keeps its arrays from step to step.
class Instruments {
 public:
  // The plan and `bodies` must live as long.
  Instruments(const plan::Plan& plan, const plan::TaskRecord& task, const TaskBodies& bodies,
              std::vector<PlacedTree> trees, int tcp_link);

  // After `steps` control steps of `substeps` substeps; `openness` 0 closed .. 1 open.
  void read(const world::World& world, int steps, int substeps, double openness,
            vm::StepSample* sample);

  // What a judge is told once, from the first sample after settling.
  std::vector<vm::BodyStart> starts(const vm::StepSample& settled) const;

 private:
  void read_links(const world::World& world, vm::StepSample* sample);
  void read_contacts(const world::World& world, vm::StepSample* sample) const;

  const plan::Plan& plan_;
  const plan::TaskRecord& task_;
  const plan::SceneRecord& scene_;
  const plan::RobotRecord& robot_;
  const TaskBodies& bodies_;
  std::vector<PlacedTree> trees_;
  int tcp_;
  std::vector<Eigen::MatrixXd> jacobians_;  // by tree, room for one link's
};

}  // namespace probe::stage
