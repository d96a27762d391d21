// vlaprobe sweep
#include "runtime/run/sweep.h"
#include "runtime/base/say.h"

#include <fmt/format.h>

#include "runtime/cli/full/run_options.h"
#include "runtime/cli/full/verbs.h"

namespace probe::cli {
namespace {

struct SweepArguments {
  RunArguments run;
  std::vector<std::string> checkpoints;
};

int sweep_verb(const SweepArguments& arguments) {
  auto options = to_options(arguments.run);
  if (!options) return report(options.failure());
  options->progress = [](const run::RunProgress& progress) {
    if (progress.row != nullptr && progress.row->invalid) print_invalid(*progress.row);
  };
  run::SweepOptions sweeping;
  sweeping.run = std::move(*options);
  sweeping.checkpoints = arguments.checkpoints;
  if (auto able = run::check_sweep(sweeping); !able) return report(able.failure());
  const LoadedPlan loaded = load_runnable(arguments.run);
  if (!loaded.plan) return loaded.exit;
  sweeping.run.assets = loaded.assets;
  if (sweeping.run.accepts_any_certificate) warn_of_insecure(sweeping.run.policy);
  sweeping.tell = [](const std::string& sentence) { say("{}\n", sentence); };
  const auto swept = run::sweep(*loaded.plan, sweeping);
  if (!swept) return report(swept.failure());
  print_summary(swept->whole);
  put("{}\n", swept->scores[swept->best].checkpoint);
  return swept->whole.invalid ? kOutside : kFine;
}

}  // namespace

void add_sweep(Verb app, int& exit) {
  auto arguments = std::make_shared<SweepArguments>();
  Verb verb =
      app.add_subcommand("sweep", "the best of several checkpoints, then the whole suite with it");
  verb.footer(
      "Each checkpoint runs the suite's original tasks in its own folder below -o. The best has "
      "the\n"
      "highest mean success over these tasks, then intention, then comes first. Prints its name.\n"
      "example: vlaprobe sweep suite/intact.probe --policy "
      "'intact://127.0.0.1:8000?profile=pi0_bridge&model={}' \\\n"
      "           --checkpoints /ckpt/10000,/ckpt/20000 --jobs 8 -o runs/pi0");
  add_run_options(verb, arguments->run);
  verb.add_option("--checkpoints", arguments->checkpoints, "A,B,...: each stands for {} in P")
      .delimiter(',')
      .required();
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = sweep_verb(*arguments); });
}

}  // namespace probe::cli
