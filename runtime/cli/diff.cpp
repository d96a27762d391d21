// vlaprobe diff
#include <fmt/format.h>

#include <filesystem>

#include "runtime/base/say.h"
#include "runtime/cli/load.h"
#include "runtime/inspect/plan_diff.h"
#include "runtime/inspect/task_diff.h"

namespace probe::cli {
namespace {

struct DiffArguments {
  std::string file, a, b;
  bool json = false;
  AssetOptions assets;
};

int diff_two_tasks(const DiffArguments& arguments) {
  LoadedPlan loaded = load_plan(arguments.file, arguments.assets);
  if (!loaded.plan) return loaded.exit;
  const auto a = find_task(*loaded.plan, arguments.a, loaded.exit);
  if (!a) return loaded.exit;
  const auto b = find_task(*loaded.plan, arguments.b, loaded.exit);
  if (!b) return loaded.exit;
  const auto diff = inspect::diff_tasks(*loaded.plan, *a, *b);
  put("{}", arguments.json ? diff.dump(2) + "\n" : inspect::diff_text(diff));
  return kFine;
}

int diff_two_plans(const DiffArguments& arguments) {
  LoadedPlan a = load_plan(arguments.file, arguments.assets);
  if (!a.plan) return a.exit;
  if (!std::filesystem::exists(arguments.a) && a.plan->find_task(arguments.a)) {
    return report({Fault::kUsage,
                   "`" + arguments.a + "` is one task of it; name another one to compare it with",
                   arguments.file});
  }
  LoadedPlan b = load_plan(arguments.a, arguments.assets);
  if (!b.plan) return b.exit;
  const auto diff = inspect::diff_plans(*a.plan, *b.plan);
  put("{}", arguments.json ? diff.dump(2) + "\n" : inspect::plan_diff_text(diff));
  return kFine;
}

}  // namespace

void add_diff(Verb app, int& exit) {
  auto arguments = std::make_shared<DiffArguments>();
  Verb verb =
      app.add_subcommand("diff", "two tasks of a file, or two files, by axes and identities");
  verb.footer(
      "example: vlaprobe diff suite/intact.probe carrot_on_plate carrot_on_plate_lang_color\n"
      "         vlaprobe diff old.plan new.plan");
  verb.add_option("F", arguments->file, ".probe text or .plan file").required();
  verb.add_option("A", arguments->a, "a task of F; or, without B, another file").required();
  verb.add_option("B", arguments->b, "another task of F");
  verb.add_flag("--json", arguments->json, "as a JSON object");
  add_asset_option(verb, arguments->assets);
  verb.callback([arguments, &exit] {
    exit = arguments->b.empty() ? diff_two_plans(*arguments) : diff_two_tasks(*arguments);
  });
}

}  // namespace probe::cli
