// How deep a thing can stand between fingers that turn: they are aslant, so what is wide stands
// deep only where they leave it room from their tips up to the palm.
#pragma once

#include <optional>
#include <vector>

#include "runtime/expert/footprint.h"
#include "runtime/expert/grasp_candidates.h"

namespace probe::expert {

class Depths {
 public:
  // `lowest`: of the tool centre point. The problem outlives it. Costs nothing where fingers slide.
  Depths(const GraspProblem& problem, double lowest);

  // The least height of the tool centre point at which the fingers close around the extent of the
  // source in a slab; nullopt where they would close above it.
  std::optional<double> around(const Slab& slab, const Vec2& closing, const Extent& extent) const;

 private:
  struct Section {
    double height = 0;
    std::vector<Outline> outlines;  // of all that is as high
  };
  const GraspProblem* problem_;
  double lowest_;
  std::vector<Section> sections_;
};

}  // namespace probe::expert
