// Sections of the source, upwards, against the fingers' inner faces.
#include "runtime/expert/depths.h"

#include <algorithm>

namespace probe::expert {
namespace {

constexpr double kSections = 0.005;      // m from one to the next
constexpr double kRaise = 0.004;         // m from a height that is tried to the next
constexpr double kSlack = 0.001;         // m: fingers press that far into nothing
constexpr double kUnderPalm = 0.004;     // m between palm and source
constexpr double kTipsOnSource = 0.003;  // m of the source between the fingertips at least

}  // namespace

Depths::Depths(const GraspProblem& problem, double lowest) : problem_(&problem), lowest_(lowest) {
  if (problem.gripper.turning.empty()) return;
  for (double h = problem.surface; h < problem.source->top; h += kSections)
    sections_.push_back(
        {h, problem.parts.empty() ? problem.source->parts : section_above(problem.parts, h)});
}

std::optional<double> Depths::around(const Slab& slab, const Vec2& closing,
                                     const Extent& extent) const {
  const robot::HandShape& hand = problem_->gripper;
  const double half = 0.5 * extent.width(), middle = 0.5 * (extent.lower + extent.upper);
  const robot::FingersAt at = robot::fingers_at(hand.turning, hand.openness_for(half));
  const double top = problem_->source->top;
  std::vector<double> halves;  // of each section, from the middle
  for (const Section& section : sections_) {
    const Extent wide = extent_in_slab(section.outlines, slab, closing);
    halves.push_back(wide.empty() ? 0 : std::max(wide.upper - middle, middle - wide.lower));
  }
  for (double z = std::max(lowest_, top - hand.palm_above + kUnderPalm);
       z - at.tip_below < top - kTipsOnSource; z += kRaise) {
    bool fits = true;
    for (std::size_t i = 0; i < sections_.size() && fits; ++i) {
      const double room = robot::inner_face(at, hand.palm_above, z - sections_[i].height);
      fits = halves[i] <= room + kSlack;
    }
    if (fits) return z;
  }
  return std::nullopt;
}

}  // namespace probe::expert
