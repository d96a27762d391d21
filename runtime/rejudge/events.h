// What happened in one stored episode, for people: events with their steps, subgoals in their
// order, numbers of the tool's motion. Read out of a trace by a plan whose metrics say what an
// event is (std/events.probe, put behind a run's own metrics by compiler/emit/graft.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/rejudge/motion.h"
#include "runtime/store/trace.h"

namespace probe::rejudge {

// Which metrics of a plan are events, and which are subgoals in this order. Those that a task does
// not have are passed over.
struct EventMetrics {
  std::vector<std::string> events, subgoals;
};
// Of metrics by these names, what std/events.probe calls so: the subgoals that times are counted
// from.
inline constexpr char kGraspedSubgoal[] = "grasped_it", kPlacedSubgoal[] = "placed_it";

// An event that began, or a subgoal that was reached first.
struct EventMark {
  std::string name;    // of the metric
  int step = 0;        // from 1
  std::string bodies;  // of whom: "carrot", "left_finger"; objects alone where there are some
  std::vector<std::uint16_t> of;  // the same by index among the task's bodies
  bool is_subgoal = false;
};

// The metric of an event after the last step, such as how often it began; nothing of one that says
// "never".
struct EventCount {
  std::string name;
  std::optional<double> value;
};

struct EpisodeEvents {
  // Why nothing is told of the episode; what follows is empty then.
  std::string untold;
  std::vector<EventMark> marks;  // ascending by step
  std::vector<EventCount> counts;
  int reached = 0, subgoals = 0;  // the first so many of so many, one after the other
  std::string last;               // the last of those reached
  // Steps at which subgoals were reached first, in their order; 0: never.
  std::vector<std::pair<std::string, int>> firsts;
  std::vector<Told> motion;  // by motion.def
  Told to_grasp, hand_over;  // s from the start to the first grasp, and from there to the place
};

// Judges the trace as `task` of `plan` again. Of an invalid episode nothing is told. Fails as
// rescore() does.
Result<EpisodeEvents> events_of(const plan::Plan& plan, std::uint32_t task,
                                const store::Trace& trace, const EventMetrics& metrics);

// "touched_table" as people read it: "touched table".
std::string event_words(std::string_view name);

}  // namespace probe::rejudge
