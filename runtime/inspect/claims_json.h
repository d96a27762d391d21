// What the words of a task say of places, for `show` and `diff`.
#pragma once

#include <cstdint>

#include "runtime/base/json.h"
#include "runtime/plan/plan.h"

namespace probe::inspect {

// claims: [{text, object, among[]}], where the task has any: `text` is to denote `object` alone
// among itself and `among` where things have come to rest.
void add_claims(const plan::Plan& plan, std::uint32_t task, Json& json);

// A line each: "can on the left" is left_can, not pepsi_can.
Json claims_text(const Json& claims);

// Whether two tasks of one name claim the same, judged the same way.
bool same_claims(const plan::Plan& a, std::uint32_t ours, const plan::Plan& b,
                 std::uint32_t theirs);

}  // namespace probe::inspect
