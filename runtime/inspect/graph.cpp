#include "runtime/inspect/graph.h"

#include <fmt/format.h>

#include <iterator>
#include <set>
#include <string_view>

#include "runtime/inspect/axes.h"

namespace probe::inspect {
namespace {

// In quotes, as DOT reads it.
std::string dot_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

Json graph(const plan::Plan& plan, std::span<const std::uint32_t> tasks) {
  std::set<std::uint32_t> nodes(tasks.begin(), tasks.end());
  Json edges = Json::array();
  for (const std::uint32_t index : tasks) {
    const plan::TaskRecord& task = plan.tasks()[index];
    if (task.baseline == plan::kNone) continue;
    nodes.insert(task.baseline);
    const auto axes = plan::axis_names(task.axes);
    edges.push_back({{"baseline", plan.text(plan.tasks()[task.baseline].name)},
                     {"variant", plan.text(task.name)},
                     {"axes", axes},
                     {"confounded", axes.size() > 1},
                     {"allow", task.allow.length == 0 ? Json() : Json(plan.text(task.allow))}});
  }
  Json names = Json::array();
  for (const std::uint32_t node : nodes) names.push_back(plan.text(plan.tasks()[node].name));
  return {{"tasks", std::move(names)}, {"edges", std::move(edges)}};
}

std::string graph_dot(const Json& graph) {
  std::string text =
      "digraph tasks {\n  rankdir=LR;\n  node [shape=box, fontname=\"Helvetica\"];\n"
      "  edge [fontname=\"Helvetica\", fontsize=10];\n";
  const auto out = std::back_inserter(text);
  for (const Json& task : graph["tasks"])
    fmt::format_to(out, "  {};\n", dot_string(task.get<std::string>()));
  for (const Json& edge : graph["edges"]) {
    std::string label;  // one axis a line; DOT's own "\n", so it is not escaped
    for (const Json& axis : edge["axes"])
      label += (label.empty() ? "" : "\\n") + axis.get<std::string>();
    fmt::format_to(out, "  {} -> {} [label=\"{}\"", dot_string(edge["baseline"].get<std::string>()),
                   dot_string(edge["variant"].get<std::string>()), label);
    if (edge["confounded"].get<bool>()) text += ", style=dashed";
    if (!edge["allow"].is_null())
      fmt::format_to(out, ", tooltip={}", dot_string(edge["allow"].get<std::string>()));
    text += "];\n";
  }
  return text + "}\n";
}

}  // namespace probe::inspect
