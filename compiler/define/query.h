// What phrases mean: queries over attributes and facts as postfix programs, and their three-valued
// evaluation.
#pragma once

#include "compiler/names/context.h"

namespace probe::sema {

// Appends the query to `out`. False when a part of it has no meaning, which is then reported.
bool compile_query(Context& context, const syntax::File& file, syntax::QueryId id, Query& out);

// Whether the object is what the query describes. An attribute without a value is unknown.
Truth evaluate(const Query& query, const Object& object);

}  // namespace probe::sema
