// Which objects begin in regions of fixtures with joints, and where in them: a plan has places in
// the world alone.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "compiler/emit/compile.h"
#include "runtime/base/geometry.h"
#include "runtime/plan/plan.h"
#include "runtime/robot/kinematics.h"
#include "runtime/robot/urdf.h"
#include "runtime/vm/made_up.h"

namespace probe::audit {

class FixtureStarts {
 public:
  // Both must live as long.
  FixtureStarts(const Compilation& compilation, const plan::Plan& plan)
      : compilation_(compilation), plan_(plan) {}

  // Of one start of a task: the objects whose middle is in a region of a part as joints begin
  // there.
  std::vector<vm::BegunIn> of(std::uint32_t task, std::uint32_t start);

 private:
  struct Model {
    robot::RobotModel model;
    robot::Tree tree;
  };
  const std::optional<Model>& model_of(std::uint32_t fixture);
  // By region where its part is (world); nothing of regions that are of no part of the task's
  // fixtures, or of one whose description is not known.
  std::vector<std::optional<Pose>> owner_poses(std::uint32_t task, std::uint32_t start);

  const Compilation& compilation_;
  const plan::Plan& plan_;
  std::map<std::uint32_t, std::optional<Model>> models_;
};

}  // namespace probe::audit
