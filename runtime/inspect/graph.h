// Which task is compared with which: an edge from each baseline to its variant.
#pragma once

#include <span>
#include <string>

#include "runtime/base/json.h"
#include "runtime/plan/plan.h"

namespace probe::inspect {

// {tasks[], edges[]}; an edge is {baseline, variant, axes[], confounded, allow}, `allow` being the
// reason given for a confounded one, or null. A baseline outside of `tasks` is listed as well.
Json graph(const plan::Plan& plan, std::span<const std::uint32_t> tasks);
// The same for Graphviz. Edges that move more than one axis are dashed, the reason is their
// tooltip.
std::string graph_dot(const Json& graph);

}  // namespace probe::inspect
