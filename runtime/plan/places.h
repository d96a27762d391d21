// Where a start lies: what clusters are made of.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "runtime/plan/plan.h"

namespace probe::plan {

// A place seen from above as it is compared: micrometres, so that what differs by the rounding of a
// sum is one place.
using Place = std::array<std::int64_t, 2>;
Place place_at(double x, double y);

// Starts of any tasks that have one key lie in the same place: one scene, one number in its layout
// (which stands for turns, since those differ by object), the same places of all that fills roles.
std::string place_key(const Plan& plan, const TaskRecord& task, const EpisodeRecord& episode);
// The same of starts in which the same places are taken, distractors apart, whichever thing has
// which role, or none: "the left can" and "the right can" of two.
std::string taken_key(const Plan& plan, const TaskRecord& task, const EpisodeRecord& episode);

}  // namespace probe::plan
