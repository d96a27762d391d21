// vlaprobe list, vlaprobe show
#include <fmt/format.h>

#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/counted.h"
#include "runtime/base/say.h"
#include "runtime/compile/library.h"
#include "runtime/cli/compile.h"
#include "runtime/cli/load.h"
#include "runtime/inspect/question_json.h"
#include "runtime/inspect/task_json.h"

namespace probe::cli {
namespace {

struct ListArguments {
  std::string file, task, suite;
  bool json = false, count = false, questions = false;
  AssetOptions assets;
};

// A text is counted without making its plan: a sweep of a million episodes in a second.
int count_text(const ListArguments& arguments) {
  const auto root = find_asset_root(root_of(arguments.assets));
  if (!root) return report(root.failure());
  const auto library = compile::find_library_folders(arguments.assets.library);
  if (!library) return report(library.failure());
  const auto counted =
      count(std::span<const std::string>(&arguments.file, 1),
            {.asset_root = *root, .suite = arguments.suite, .library_folders = *library});
  if (!counted) return report(counted.failure());
  const Compilation& compilation = counted->compilation;
  say_briefly(compilation, arguments.file);
  if (!compilation.ok) return kUser;
  const Json numbers = {{"tasks", counted->counts.tasks}, {"episodes", counted->counts.episodes}};
  put("{}", arguments.json ? numbers.dump() + "\n"
                           : probe::counted(counted->counts.tasks, "task") + ", " +
                                 probe::counted(counted->counts.episodes, "episode") + "\n");
  return kFine;
}

int list_questions(const ListArguments& arguments, const plan::Plan& plan,
                   const std::vector<std::uint32_t>& tasks) {
  const Json list = inspect::list_questions(plan, tasks);
  const auto questions = list["questions"].get<std::size_t>();
  const auto asked = list["asked"].get<std::size_t>();
  if (arguments.json) {
    put("{}", arguments.count ? Json{{"questions", questions}, {"asked", asked}}.dump() + "\n"
                              : list.dump(2) + "\n");
    return kFine;
  }
  const std::string summary = fmt::format("{} questions, asked {} times\n", questions, asked);
  put("{}", arguments.count ? summary : inspect::question_list_text(list));
  if (!arguments.count) say("{}", summary);
  return kFine;
}

int list_verb(const ListArguments& arguments) {
  if (arguments.count && !arguments.questions && arguments.file.ends_with(".probe"))
    return count_text(arguments);
  LoadedPlan loaded = load_plan(arguments.file, arguments.assets);
  if (!loaded.plan) return loaded.exit;
  const auto tasks = select_tasks(*loaded.plan, arguments.suite, loaded.exit);
  if (!tasks) return loaded.exit;
  if (arguments.questions) return list_questions(arguments, *loaded.plan, *tasks);
  const auto of = loaded.plan->find_suite(arguments.suite);
  const plan::SuiteRecord* suite = of ? &loaded.plan->suites()[*of] : nullptr;
  const Json count = inspect::count(*loaded.plan, *tasks, suite);
  const std::string summary =
      counted(count["tasks"].get<std::size_t>(), "task") + ", " +
      counted(count["episodes"].get<std::size_t>(), "episode") + "\n";
  if (arguments.count) {
    put("{}", arguments.json ? count.dump() + "\n" : summary);
    return kFine;
  }
  const Json list = inspect::list(*loaded.plan, *tasks, suite);
  put("{}", arguments.json ? list.dump(2) + "\n" : inspect::list_text(list));
  if (!arguments.json) say("{}", summary);
  return kFine;
}

int show_verb(const ListArguments& arguments) {
  LoadedPlan loaded = load_plan(arguments.file, arguments.assets);
  if (!loaded.plan) return loaded.exit;
  const auto index = find_task(*loaded.plan, arguments.task, loaded.exit);
  if (!index) return loaded.exit;
  const Json task = inspect::describe(*loaded.plan, *index);
  put("{}", arguments.json ? task.dump(2) + "\n" : inspect::describe_text(task));
  return kFine;
}

}  // namespace

void add_list(Verb app, int& exit) {
  auto arguments = std::make_shared<ListArguments>();
  Verb verb = app.add_subcommand("list", "the tasks of a file with their instructions");
  verb.footer("example: vlaprobe list suite/intact.probe --json");
  verb.add_option("F", arguments->file, ".probe text or .plan file").required();
  verb.add_option("--suite", arguments->suite, "only the members of this suite");
  verb.add_flag("--count", arguments->count, "only how many tasks and episodes there are");
  verb.add_flag("--questions", arguments->questions,
                "what a model is asked of them: families, how often, and what is left out");
  verb.add_flag("--json", arguments->json, "a JSON array of tasks, or an object of questions");
  add_asset_option(verb, arguments->assets);
  verb.callback([arguments, &exit] { exit = list_verb(*arguments); });
}

void add_show(Verb app, int& exit) {
  auto arguments = std::make_shared<ListArguments>();
  Verb verb = app.add_subcommand("show", "one task whole: roles, axes, ids, every start");
  verb.footer("example: vlaprobe show suite/intact.probe carrot_on_plate");
  verb.add_option("F", arguments->file, ".probe text or .plan file").required();
  verb.add_option("TASK", arguments->task, "task name, with or without its suite's prefix")
      .required();
  verb.add_flag("--json", arguments->json, "as a JSON object");
  add_asset_option(verb, arguments->assets);
  verb.callback([arguments, &exit] { exit = show_verb(*arguments); });
}

}  // namespace probe::cli
