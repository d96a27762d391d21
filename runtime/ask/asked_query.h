// A query of a drawn look, as a model gets it.
#pragma once

#include "runtime/ask/models.h"
#include "runtime/ask/prepared.h"

namespace probe::ask {

// Refers to all that it is given; the look has a truth for the query's question. The draw is a hash
// of the query's key: who asks, when and beside what is not in it.
AskedQuery asked_query(const plan::Plan& plan, const PreparedLook& look, const Query& query,
                       const Wording& wording);

// The words of a query about a look.
Wording wording_of(const plan::Plan& plan, const PreparedLook& look, const Query& query);

}  // namespace probe::ask
