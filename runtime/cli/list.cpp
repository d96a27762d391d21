// vlaprobe list, vlaprobe show
#include <fmt/format.h>

#include "runtime/cli/load.h"
#include "runtime/cli/task_json.h"

namespace probe::cli {
namespace {

struct Arguments {
  std::string file, task, suite;
  bool json = false;
  AssetOptions assets;
};

std::string joined(const nlohmann::ordered_json& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word.get<std::string>();
  return text;
}

int list_verb(const Arguments& arguments) {
  LoadedPlan loaded = load_plan(arguments.file, arguments.assets);
  if (!loaded.plan) return loaded.exit;
  const plan::Plan& plan = *loaded.plan;
  std::vector<std::uint32_t> tasks;
  if (arguments.suite.empty()) {
    for (std::uint32_t t = 0; t < plan.tasks().size(); ++t) tasks.push_back(t);
  } else {
    const auto suite = find_suite(plan, arguments.suite, loaded.exit);
    if (!suite) return loaded.exit;
    const auto members = plan.members(plan.suites()[*suite]);
    tasks.assign(members.begin(), members.end());
  }
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (std::uint32_t task : tasks) all.push_back(summarise(plan, task));
  if (arguments.json) {
    fmt::print("{}\n", all.dump(2));
    return kFine;
  }
  std::size_t width = 0;
  for (const auto& task : all)
    width = std::max(width, task["task"].get_ref<const std::string&>().size());
  std::size_t episodes = 0;
  for (const auto& task : all) {
    fmt::print("{:<{}}  {:>4}  {}\n", task["task"].get<std::string>(), width,
               task["episodes"].get<std::size_t>(), task["prompt"].get<std::string>());
    episodes += task["episodes"].get<std::size_t>();
  }
  fmt::print(stderr, "{} tasks, {} episodes\n", all.size(), episodes);
  return kFine;
}

int show_verb(const Arguments& arguments) {
  LoadedPlan loaded = load_plan(arguments.file, arguments.assets);
  if (!loaded.plan) return loaded.exit;
  const auto index = find_task(*loaded.plan, arguments.task, loaded.exit);
  if (!index) return loaded.exit;
  const auto task = describe(*loaded.plan, *index);
  if (arguments.json) {
    fmt::print("{}\n", task.dump(2));
    return kFine;
  }
  const auto line = [](const char* name, const std::string& value) {
    fmt::print("{:<12} {}\n", name, value);
  };
  line("task", task["task"].get<std::string>());
  line("prompt", task["prompt"].get<std::string>());
  line("source", task["source"].get<std::string>());
  line("target", task["target"].get<std::string>());
  line("distractors", task["distractors"].empty() ? "none" : joined(task["distractors"]));
  line("baseline", task["baseline"].is_null() ? "none" : task["baseline"].get<std::string>());
  line("axes", task["axes"].empty() ? "none" : joined(task["axes"]));
  line("categories", task["categories"].empty() ? "none" : joined(task["categories"]));
  line("metrics", joined(task["metrics"]));
  line("horizon", fmt::format("{} steps", task["horizon"].get<int>()));
  std::size_t number = 0;
  for (const auto& start : task["starts"]) {
    fmt::print("start {:>3}", number++);
    for (const auto& object : start) {
      fmt::print("   {} ({:.4g}, {:.4g}) m", object["object"].get<std::string>(),
                 object["x_m"].get<double>(), object["y_m"].get<double>());
      for (const char* angle : {"roll", "pitch", "yaw"}) {
        const double degrees = object[std::string(angle) + "_deg"].get<double>();
        if (degrees != 0) fmt::print(" {} {:.4g} deg", angle, degrees);
      }
    }
    fmt::print("\n");
  }
  return kFine;
}

}  // namespace

void add_list(CLI::App& app, int& exit) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = app.add_subcommand("list", "the tasks of a file with their instructions");
  verb->footer("example: vlaprobe list suite/intact.probe --json");
  verb->add_option("F", arguments->file, ".probe text or .plan file")->required();
  verb->add_option("--suite", arguments->suite, "only the members of this suite");
  verb->add_flag("--json", arguments->json, "a JSON array of tasks");
  add_asset_option(*verb, arguments->assets);
  verb->callback([arguments, &exit] { exit = list_verb(*arguments); });
}

void add_show(CLI::App& app, int& exit) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = app.add_subcommand("show", "one task whole: roles, axes, every start");
  verb->footer("example: vlaprobe show suite/intact.probe carrot_on_plate");
  verb->add_option("F", arguments->file, ".probe text or .plan file")->required();
  verb->add_option("TASK", arguments->task, "task name, with or without its suite's prefix")
      ->required();
  verb->add_flag("--json", arguments->json, "as a JSON object");
  add_asset_option(*verb, arguments->assets);
  verb->callback([arguments, &exit] { exit = show_verb(*arguments); });
}

}  // namespace probe::cli
