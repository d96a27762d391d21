// vlaprobe verify
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "runtime/cli/load.h"

namespace probe::cli {

void add_verify(CLI::App& app, int& exit) {
  struct Arguments {
    std::string file;
    bool json = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = app.add_subcommand("verify", "check every rule of the plan format on a file");
  verb->footer("example: vlaprobe verify intact.plan");
  verb->add_option("X.plan", arguments->file, "plan file")->required();
  verb->add_flag("--json", arguments->json, "root and sizes as a JSON object");
  verb->callback([arguments, &exit] {
    auto plan = plan::Plan::open(arguments->file);
    if (!plan) {
      exit = report(plan.failure());
      return;
    }
    if (arguments->json) {
      const nlohmann::ordered_json json = {{"root", to_hex(plan->root())},
                                           {"tasks", plan->tasks().size()},
                                           {"episodes", plan->episodes().size()},
                                           {"bytes", plan->bytes().size()}};
      fmt::print("{}\n", json.dump(2));
      return;
    }
    fmt::print("{}\n", to_hex(plan->root()));
    fmt::print(stderr, "{}: good, {} tasks, {} episodes, {} bytes\n", arguments->file,
               plan->tasks().size(), plan->episodes().size(), plan->bytes().size());
  });
}

}  // namespace probe::cli
