// What phrases mean: queries over attributes and facts as postfix programs, and their three-valued
// evaluation.
#pragma once

#include <functional>
#include <string>

#include "compiler/names/context.h"

namespace probe::sema {

// Appends the query to `out`. False when a part of it has no meaning, which is then reported.
bool compile_query(Context& context, const syntax::File& file, syntax::QueryId id, Query& out);

// The objects that a relation takes: its first parameters.
std::size_t objects_of(const syntax::PredicateDecl& relation);

// Whether the object is what the query describes. An attribute without a value is unknown, and so
// is where it stands: `placed` says whether a relation holds.
Truth evaluate(const Query& query, const Object& object);
Truth evaluate(const Query& query, const Object& object,
               const std::function<Truth(const QueryOp&)>& placed);

// Of what a query joins by `and`, what keeps it from describing the object, and what that has
// instead: "`category toy` is not true of `cube_a`, whose category is block"; empty where nothing
// is known.
std::string lack_of(const Model& model, const Query& query, const Object& object,
                    const std::function<Truth(const QueryOp&)>& placed);

}  // namespace probe::sema
