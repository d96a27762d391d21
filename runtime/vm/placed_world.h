// Things put somewhere in a made-up world: onto a body, into or beside it, into a region.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "runtime/plan/plan.h"
#include "runtime/vm/made_up.h"

namespace probe::vm {

// Where things are put: onto a body, or into a region.
struct PutPlace {
  std::uint32_t to = plan::kNone, region = plan::kNone;
  plan::SkillRelation relation = plan::SkillRelation::kOn;
  bool operator==(const PutPlace&) const = default;
};

// Moves an object of the task there and has it pressed by nothing but what carries it. `index`:
// which of those that are put one after another it is, from 0. Each lies a millimetre aside from
// the one before, as rules look at each alone; what is put beside a thing is on its next side.
void put_at(const plan::Plan& plan, const plan::TaskRecord& task, std::uint32_t object,
            const PutPlace& place, std::size_t index, MadeUpWorld* world);

// Each pair once, ascending, as judges are told of contacts.
void put_contacts_in_order(MadeUpWorld* world);

}  // namespace probe::vm
