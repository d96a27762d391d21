// The bodies of a plan's tasks as lowering wants them, when the text that is lowered is not the one
// the plan was made from.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "compiler/lower/lower.h"
#include "compiler/model/model.h"
#include "runtime/plan/plan.h"

namespace probe::emit {

// Objects, roles and fixtures of the plan are those of the text by their names; fixtures that the
// text does not know are added to its model, for their joints.
class PlanBodies {
 public:
  PlanBodies(const plan::Plan& plan, sema::Model& model);
  std::vector<lower::Body> of(const plan::TaskRecord& task);

 private:
  void add_fixtures();
  std::uint32_t role_of(const plan::TaskRecord& task, std::uint32_t body) const;
  void set_regions(lower::Body& body, plan::BodyKind kind, std::uint32_t index);

  const plan::Plan& plan_;
  sema::Model& model_;
  // Of kParts: the fixture of the model and its part.
  std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> parts_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<sema::Region>> regions_;
};

}  // namespace probe::emit
