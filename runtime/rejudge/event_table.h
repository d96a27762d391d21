// Events of many episodes as text: a few lines a task for people, a row an episode for programs.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/rejudge/events.h"
#include "runtime/store/results.h"

namespace probe::rejudge {

struct EventRow {
  store::ResultRow row;
  EpisodeEvents events;
};

// Tasks in the order of the rows: of each event in how many episodes it began and how often, how
// far episodes came, means of numbers. Episodes of which nothing is told count nowhere and are
// named with the first reason.
std::string event_tally(std::span<const EventRow> rows);
// An array of objects {task, episode, seed, policy, untold | steps, marks, events, subgoals,
// reached, motion, why_not}; numbers without a value are null, with the reason in `why_not`.
std::string events_to_json(std::span<const EventRow> rows);
// A header and a line an episode; what has no value is empty, its reasons stand in the last column.
std::string events_to_csv(std::span<const EventRow> rows);

}  // namespace probe::rejudge
