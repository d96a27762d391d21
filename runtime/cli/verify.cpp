// vlaprobe verify
#include <fmt/format.h>

#include "runtime/cli/load.h"

namespace probe::cli {

void add_verify(CLI::App& app, int& exit) {
  auto file = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand("verify", "check every rule of the plan format on a file");
  verb->footer("example: vlaprobe verify intact.plan");
  verb->add_option("X.plan", *file, "plan file")->required();
  verb->callback([file, &exit] {
    auto plan = plan::Plan::open(*file);
    if (!plan) {
      exit = report(plan.failure());
      return;
    }
    fmt::print("{}\n", to_hex(plan->root()));
    fmt::print(stderr, "{}: good, {} tasks, {} episodes, {} bytes\n", *file, plan->tasks().size(),
               plan->episodes().size(), plan->bytes().size());
  });
}

}  // namespace probe::cli
