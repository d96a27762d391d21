// vlaprobe graph
#include "runtime/inspect/graph.h"

#include "runtime/cli/plan_table.h"

namespace probe::cli {

void add_graph(Verb app, int& exit) {
  add_plan_table(app, exit,
                 {.name = "graph",
                  .about = "which task is compared with which, for Graphviz (DOT)",
                  .footer = "dashed: more than one axis moves\n"
                            "example: vlaprobe graph suite/intact.probe | dot -Tsvg > tasks.svg",
                  .json = "tasks and edges as a JSON object",
                  .make =
                      [](const LoadedPlan& loaded, std::span<const std::uint32_t> tasks) {
                        return inspect::graph(*loaded.plan, tasks);
                      },
                  .text = inspect::graph_dot});
}

}  // namespace probe::cli
