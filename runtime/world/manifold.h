// What a pair remembers from substep to substep: reuse of a manifold while the pair has hardly
// moved, and handing the impulses of old points to new ones. Stillness at rest comes from here.
#pragma once

#include "runtime/world/hull_contact.h"

namespace probe::world {

// True if the record was live in the previous substep and the pair has moved less than `reuse`
// since its making. `radius` is the smaller bounding radius.
bool can_reuse(const PairRecord& record, std::uint64_t substep, const RelativePose& pose,
               double radius, double reuse);

// Replaces the record's points by the candidates, which inherit impulses from old points within
// `match`.
void renew(PairRecord* record, std::uint64_t substep, const RelativePose& pose,
           const Candidates& candidates, bool plane, double match);

}  // namespace probe::world
