#include "runtime/expert/hold_lack.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "runtime/robot/ik.h"

namespace probe::expert {

namespace {
constexpr double kThere = 1e-3;  // m: nearer is at the hold
}  // namespace

void HoldLack::add_out_of_reach(const Reach& reach, std::span<const double> joints,
                                const Pose& at) {
  std::array<double, robot::kMaxChainJoints> q{};
  const std::span<double> found = std::span(q).first(reach.chain().joint_count());
  std::copy_n(joints.begin(), found.size(), found.begin());
  nearest = std::min(nearest, robot::solve_ik(reach.chain(), at, found).position_error);
}

std::string to_text(const HoldLack& lack, const HoldProblem& problem) {
  if (lack.holds == 0) {
    HoldProblem thinner = problem;
    thinner.hand.thinnest = 0;
    if (problem.hand.thinnest > 0 && !hold_candidates(thinner).empty())
      return fmt::format("closed fingers stay {:.1f} cm apart, and what they could hold is thinner",
                         100 * problem.hand.thinnest);
    return "there is no hold with room for the hand";
  }
  if (lack.blocked == lack.holds) return "something stands in the way to each hold";
  if (lack.nearest > kThere)
    return fmt::format("the arm does not reach it: the nearest hold stays {:.1f} cm away",
                       100 * lack.nearest);
  return "the arm comes to a hold and cannot follow the part's way";
}

}  // namespace probe::expert
