// vlaprobe dis
#include "runtime/plan/dis.h"

#include <fmt/format.h>

#include "runtime/base/say.h"
#include "runtime/cli/load.h"

namespace probe::cli {

void add_dis(Verb app, int& exit) {
  struct DisArguments {
    std::string file, task;
    AssetOptions assets;
  };
  auto arguments = std::make_shared<DisArguments>();
  Verb verb =
      app.add_subcommand("dis", "a plan as text: tables and programs with their source lines");
  verb.footer("example: vlaprobe dis intact.plan carrot_on_plate");
  verb.add_option("F", arguments->file, ".plan file or .probe text").required();
  verb.add_option("TASK", arguments->task, "the program of this task alone");
  add_asset_option(verb, arguments->assets);
  verb.callback([arguments, &exit] {
    LoadedPlan loaded = load_plan(arguments->file, arguments->assets);
    exit = loaded.exit;
    if (!loaded.plan) return;
    if (arguments->task.empty()) {
      put("{}", plan::disassemble(*loaded.plan));
      return;
    }
    if (const auto task = find_task(*loaded.plan, arguments->task, exit)) {
      put("{}", plan::disassemble(*loaded.plan, *task));
    }
  });
}

}  // namespace probe::cli
