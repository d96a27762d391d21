// A put that is neither straight up nor straight down: of what begins under something, or shall go
// under something; and what a hand whose fingers turn picks and puts, which leans. Holds from any
// direction, ways out from where the source lies and ways in to where it goes, in three dimensions;
// whether inverse kinematics follows all of it is asked here, too. Base frame.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/expert/put_spot.h"
#include "runtime/expert/reach.h"
#include "runtime/expert/waypoints.h"

namespace probe::expert {

// The tool's way from one end to the other, hand and source included.
struct PutPlan {
  std::vector<Pose> to_hold;  // the hold last
  double open = 1;            // openness of the gripper there, and where it lets go
  bool sets_first = false;    // the fingers are so before the hand goes
  std::vector<Pose> carry;    // where it lets go last
  std::vector<Pose> leave;    // off what was put; none of what is only picked up
  Pose hold;                  // of the tool in the source's frame
  Pose put;                   // of the source, where it is let go
};

struct PutProblem {
  const Scene* scene = nullptr;  // sees the source
  const policy::Privileged* view = nullptr;
  const Reach* reach = nullptr;
  int object = -1;                   // the source, of the view
  std::span<const PutPlace> places;  // where it may go
  std::span<const Pose> failed;      // holds that were tried
  bool lifts = false;                // it is only picked up
};

std::optional<PutPlan> plan_put(const PutProblem& problem);

// Whether something hangs over the source, so that it is not lifted straight up.
bool is_covered(const Scene& scene);

}  // namespace probe::expert
