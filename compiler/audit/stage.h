// What begins and stands otherwise than it looks: objects that fall onto one another, parts of
// fixtures that are drawn and cannot be touched; and what begins in such parts.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/emit/compile.h"
#include "runtime/plan/plan.h"
#include "runtime/robot/kinematics.h"
#include "runtime/robot/urdf.h"
#include "runtime/vm/made_up.h"

namespace probe::audit {

// Starts of a task in which the upright boxes around two objects overlap as seen from above by more
// than a centimetre, and one is so far above the other that it falls. What begins on something, as a
// layout puts it there, is left out.
struct Falls {
  std::size_t starts = 0, of = 0;
  std::size_t first = 0;   // the first such start
  std::string first_pair;  // "`pepsi` and `sponge`"
};
Falls falls_in(const plan::Plan& plan, std::uint32_t task);

// One sentence for each link of a fixture whose drawn boxes reach more than 5 mm beyond what is felt
// of it. Links with meshes are left out: their extents are not at hand here.
std::vector<std::string> unfelt_in(const Compilation& compilation, const plan::Plan& plan,
                                   std::uint32_t fixture);

// Where objects begin in fixtures with joints, and in their parts.
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
  std::vector<std::optional<Pose>> owners(std::uint32_t task, std::uint32_t start);

  const Compilation& compilation_;
  const plan::Plan& plan_;
  std::map<std::uint32_t, std::optional<Model>> models_;
};

}  // namespace probe::audit
