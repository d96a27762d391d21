#include "runtime/servers/sticky_gripper.h"

#include <doctest/doctest.h>

#include <vector>

namespace probe::servers {
namespace {

std::vector<double> steps(StickyRule rule, int held, const std::vector<double>& openings) {
  StickyGripper gripper(rule, held);
  std::vector<double> out;
  for (const double opening : openings) out.push_back(gripper.step(opening));
  return out;
}
using Numbers = std::vector<double>;

}  // namespace

TEST_CASE("a change against the answer before is held, and small ones are done as they are") {
  // One answer to close is three steps of closing; the answer after it, open again, is swallowed.
  CHECK(steps(StickyRule::kLast, 3, {1, 1, 0, 1, 1, 1}) == Numbers{0, 0, -1, -1, -1, 0});
  CHECK(steps(StickyRule::kLast, 3, {1, 0.75, 0.5, 0.25}) == Numbers{0, -0.25, -0.25, -0.25});
  // The step at which the hold ends counts among them, and the next switch begins anew.
  CHECK(steps(StickyRule::kLast, 2, {1, 0, 0, 0, 1, 1}) == Numbers{0, -1, -1, 0, 1, 1});
}

TEST_CASE("a change against the last switch adds up until it is one") {
  CHECK(steps(StickyRule::kSwitch, 2, {1, 0.75, 0.25, 0.25, 0.25, 0.5}) ==
        Numbers{0, -0.25, -0.75, -0.75, 0, 0.25});
}

TEST_CASE("against half way the gripper goes from the first answer on") {
  CHECK(steps(StickyRule::kHalf, 2, {1, 0, 0.5, 0}) == Numbers{1, 1, 0, -1});
}

TEST_CASE("what was held is forgotten with the episode, or with its instruction") {
  StickyGripper gripper(StickyRule::kLast, 15);
  gripper.step(1);
  CHECK(gripper.step(0) == -1);
  gripper.reset();
  CHECK(gripper.step(0) == 0);
  CHECK(gripper.step(0) == 0);
}

}  // namespace probe::servers
