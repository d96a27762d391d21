// vlaprobe demos
#include <fmt/format.h>

#include "runtime/base/say.h"
#include "runtime/cli/full/progress_printer.h"
#include "runtime/cli/full/run_options.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/run/run.h"

namespace probe::cli {
namespace {

struct DemosArguments {
  RunArguments run;
  std::string noise = "0.02";
  int per_start = 1, seed = 0;
};

// The policy and the seeds are what `demos` adds to `run`.
Result<run::RunOptions> options_of(DemosArguments arguments) {
  arguments.run.policy = "pushed:" + arguments.noise;
  PROBE_ASSIGN(run::RunOptions options, to_options(arguments.run));
  PROBE_ASSIGN(const run::Actor actor, run::choose_actor(options));
  constexpr int kMost = 1'000'000'000;
  if (arguments.per_start < 1 || arguments.per_start > 100'000)
    return Failure{Fault::kUsage, "1 to 100,000 demonstrations of each start", "--per-start"};
  if (arguments.seed < 0 || arguments.seed > kMost)
    return Failure{Fault::kUsage, "a seed is a whole number from 0", "--seed"};
  if (!actor.traits.draws && arguments.per_start > 1)
    return Failure{Fault::kUsage, "without noise every demonstration of a start is the same",
                   "--per-start"};
  for (int i = 0; i < arguments.per_start; ++i) options.seeds.push_back(arguments.seed + i);
  options.only_success = true;
  return options;
}

int demos_verb(const DemosArguments& arguments) {
  auto options = options_of(arguments);
  if (!options) return report(options.failure());
  const LoadedPlan loaded = load_runnable(arguments.run);
  if (!loaded.plan) return loaded.exit;
  options->assets = loaded.assets;
  ProgressPrinter printer;
  options->progress = [&](const run::RunProgress& progress) { printer(progress); };
  const auto summary = run::run(*loaded.plan, *options);
  printer.clear();
  if (!summary) return report(summary.failure());
  print_summary(*summary);
  if (summary->not_kept > 0)
    say("{} of them did not succeed and were not kept\n", summary->not_kept);
  return summary->invalid ? kOutside : kFine;
}

}  // namespace

void add_demos(Verb app, int& exit) {
  auto arguments = std::make_shared<DemosArguments>();
  RunArguments& run = arguments->run;
  Verb verb = app.add_subcommand("demos", "demonstrations of the expert, to train on");
  verb.footer(
      "the expert, pushed off its way in one step of eight; what succeeds is kept for `export`\n"
      "example: vlaprobe demos suite/intact.probe --tasks carrot_on_plate --per-start 4 -o demos");
  verb.add_option("F", run.file, ".probe text or .plan file").required();
  verb.add_option("-o,--out", run.out, "results folder").required();
  verb.add_option("--per-start", arguments->per_start, "demonstrations of each start (1)");
  verb.add_option("--noise", arguments->noise,
                  "SIGMA of a push: m of place, 2 SIGMA rad of rotation (0.02)");
  verb.add_option("--seed", arguments->seed, "of a start's first demonstration (0)");
  verb.add_option("--suite", run.suite, "which suite (default: the first that F itself declares)");
  verb.add_option("--tasks", run.tasks, "glob over task names");
  verb.add_option("--episodes", run.episodes, "A-B, first and last start of each task");
  verb.add_option("--jobs", run.jobs, "worlds in parallel (1)").between(1, 1024);
  verb.add_option("--if-changed", run.if_changed,
                  "refuse, fork (into DIR-2) or continue over another build")
      .one_of({"refuse", "fork", "continue"});
  add_asset_option(verb, run.assets, false);
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = demos_verb(*arguments); });
}

}  // namespace probe::cli
