// The skill that a PutPlan is for: fingers set, where need is, to the hold, close, carry along the
// way, let down, open, back off, home; or to the hold, close, up, and it stays in the hand. A hold
// that is lost is planned anew.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/expert/put_plan.h"
#include "runtime/expert/servo.h"
#include "runtime/expert/tool_way.h"

namespace probe::expert {

class PutUnder {
 public:
  // False where there is no plan: nothing is begun. `ready` is where the tool goes in the end, so
  // that the arm is not left twisted.
  bool begin(const Scene& scene, const policy::Privileged& view, const policy::Skill& skill,
             const Reach& reach, const Pose& ready, bool only_reaches = false);

  // One decision; nothing once it is over.
  std::optional<policy::Action> act(const Scene& scene, const policy::Privileged& view,
                                    const Reach& reach, Servo& servo);

  // Why it was not done; empty else.
  const std::string& lack() const { return lack_; }
  // What shall only be picked up is in the hand, or what is only gone to is there.
  bool keeps() const { return phase_ == Phase::kKeep; }

 private:
  enum class Phase { kSet, kGo, kGrip, kCarry, kKeep, kLower, kOpen, kLeave, kOver };

  bool plan(const Scene& scene, const policy::Privileged& view, const Reach& reach);
  void enter(Phase phase);
  void start_over(const Scene& scene, const policy::Privileged& view, const Reach& reach,
                  const char* lack);
  void advance(const Scene& scene, const policy::Privileged& view, const Reach& reach);
  void begin_leave(const Scene& scene, const policy::Privileged& view, const Reach& reach);
  bool holds(const Scene& scene) const;
  policy::Action command(const Scene& scene, Servo& servo) const;

  policy::Skill skill_;
  Pose ready_;
  Phase phase_ = Phase::kOver;
  int steps_ = 0, tries_ = 0;
  std::optional<PutPlan> plan_;
  std::vector<Pose> failed_;  // holds, in the source's frame
  ToolWay way_;
  Pose taken_, last_;  // of the source in the tool's frame; of the tool
  bool is_done_ = false, only_reaches_ = false;
  std::string lack_;
};

}  // namespace probe::expert
