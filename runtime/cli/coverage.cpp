// vlaprobe coverage
#include "runtime/inspect/coverage.h"

#include <fmt/format.h>

#include "runtime/cli/load.h"

namespace probe::cli {

void add_coverage(CLI::App& app, int& exit) {
  struct Arguments {
    std::string file, suite;
    bool json = false;
    AssetOptions assets;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb =
      app.add_subcommand("coverage", "how many variants of each base task move each axis");
  verb->footer("example: vlaprobe coverage suite/intact.probe --suite language");
  verb->add_option("F", arguments->file, ".probe text or .plan file")->required();
  verb->add_option("--suite", arguments->suite, "only the members of this suite");
  verb->add_flag("--json", arguments->json, "as a JSON object");
  add_asset_option(*verb, arguments->assets);
  verb->callback([arguments, &exit] {
    LoadedPlan loaded = load_plan(arguments->file, arguments->assets);
    exit = loaded.exit;
    if (!loaded.plan) return;
    const auto tasks = select_tasks(*loaded.plan, arguments->suite, exit);
    if (!tasks) return;
    const auto coverage = inspect::coverage(*loaded.plan, *tasks);
    fmt::print("{}", arguments->json ? coverage.dump(2) + "\n" : inspect::coverage_text(coverage));
  });
}

}  // namespace probe::cli
