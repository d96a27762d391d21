// Leads the tool under `osc_pose`, whose actions are pulls: an arm that is told to go somewhere
// goes an eighth of the way in a control step and keeps some of its speed. The tracker knows the
// law, so it pulls ahead by what a steady motion asks for, and takes back a share of what the
// measured tool is off. See README.
#pragma once

#include <array>

#include "runtime/base/geometry.h"
#include "runtime/policy/policy.h"
#include "runtime/robot/laws.h"

namespace probe::expert {

class ToolTracker {
 public:
  // `rate` in control steps a second.
  ToolTracker(const robot::OscPose& law, double rate);

  // Control steps between two decisions of who leads: long enough for the expert's usual moves.
  int interval() const { return interval_; }

  // The tool rests at `tool`, base frame as everywhere here.
  void begin(const Pose& tool);

  // Once a control step, before act(): where the tool is now.
  void observe(const Pose& tool) { at_ = tool; }

  // The tool shall be there, and the gripper as wide (-1 closed .. 1 open), after interval() steps.
  void aim(const Pose& goal, double gripper);
  const Pose& goal() const { return to_; }

  // The action of this control step; `openness` of the gripper, 0 .. 1.
  policy::Action act(double openness);

 private:
  double grip(double openness);

  // Of a direction: what to ask for, per m (rad) that the tool shall go on in a control step, and
  // per m that it is off.
  struct Response {
    double of_way = 0, of_error = 0;
  };

  std::array<Response, 6> responses_;
  std::array<double, 6> output_;
  int interval_ = 1;
  Pose at_, from_, to_;
  double gripper_ = 1, last_openness_ = 1;
  bool is_wide_ = false;  // the gripper, as wide as it shall be
  int step_ = 0;          // of the interval
};

}  // namespace probe::expert
