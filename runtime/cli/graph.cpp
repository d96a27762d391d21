// vlaprobe graph
#include "runtime/inspect/graph.h"

#include <fmt/format.h>

#include "runtime/cli/load.h"

namespace probe::cli {

void add_graph(CLI::App& app, int& exit) {
  struct Arguments {
    std::string file, suite;
    bool json = false;
    AssetOptions assets;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb =
      app.add_subcommand("graph", "which task is compared with which, for Graphviz (DOT)");
  verb->footer(
      "dashed: more than one axis moves\n"
      "example: vlaprobe graph suite/intact.probe | dot -Tsvg > tasks.svg");
  verb->add_option("F", arguments->file, ".probe text or .plan file")->required();
  verb->add_option("--suite", arguments->suite, "only the members of this suite");
  verb->add_flag("--json", arguments->json, "tasks and edges as a JSON object");
  add_asset_option(*verb, arguments->assets);
  verb->callback([arguments, &exit] {
    LoadedPlan loaded = load_plan(arguments->file, arguments->assets);
    exit = loaded.exit;
    if (!loaded.plan) return;
    const auto tasks = select_tasks(*loaded.plan, arguments->suite, exit);
    if (!tasks) return;
    const auto graph = inspect::graph(*loaded.plan, *tasks);
    fmt::print("{}", arguments->json ? graph.dump(2) + "\n" : inspect::graph_dot(graph));
  });
}

}  // namespace probe::cli
