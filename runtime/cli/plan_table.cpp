#include "runtime/cli/plan_table.h"

#include <fmt/format.h>
#include "runtime/base/say.h"

namespace probe::cli {

void add_plan_table(Verb app, int& exit, PlanTable table) {
  struct PlanTableArguments {
    std::string file, suite;
    bool json = false;
    AssetOptions assets;
  };
  auto arguments = std::make_shared<PlanTableArguments>();
  Verb verb = app.add_subcommand(table.name, table.about);
  verb.footer(table.footer);
  verb.add_option("F", arguments->file, ".probe text or .plan file").required();
  verb.add_option("--suite", arguments->suite, "only the members of this suite");
  verb.add_flag("--json", arguments->json, table.json);
  add_asset_option(verb, arguments->assets);
  verb.callback([arguments, &exit, table = std::move(table)] {
    LoadedPlan loaded = load_plan(arguments->file, arguments->assets);
    exit = loaded.exit;
    if (!loaded.plan) return;
    const auto tasks = select_tasks(*loaded.plan, arguments->suite, exit);
    if (!tasks) return;
    const auto made = table.make(loaded, *tasks);
    put("{}", arguments->json ? made.dump(2) + "\n" : table.text(made));
  });
}

}  // namespace probe::cli
