// vlaprobe run
#include "runtime/run/run.h"
#include "runtime/base/say.h"

#include <fmt/format.h>

#include <memory>

#include "runtime/cli/full/progress_printer.h"
#include "runtime/cli/full/run_options.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/follow/page.h"
#include "runtime/run/policies.h"

namespace probe::cli {
namespace {

struct CallArguments {
  RunArguments run;
  std::string shard = "1/1", watch, until;
};

int run_verb(const CallArguments& arguments) {
  auto options = to_options(arguments.run);
  if (!options) return report(options.failure());
  const auto shard = parse_shard(arguments.shard);
  if (!shard) return report(shard.failure());
  if (!arguments.until.empty()) {
    if (const auto set = run::set_until(arguments.until, *options); !set)
      return report(set.failure());
  }
  options->shard = shard->first;
  options->shards = shard->second;
  if (auto actor = run::choose_actor(*options); !actor) return report(actor.failure());
  const LoadedPlan loaded = load_runnable(arguments.run);
  if (!loaded.plan) return loaded.exit;
  options->assets = loaded.assets;

  if (options->accepts_any_certificate) warn_of_insecure(options->policy);
  std::unique_ptr<follow::FollowPage> page;
  if (!arguments.watch.empty()) {
    // The folder that it would go to is known when it runs.
    if (options->if_changed == run::IfChanged::kFork)
      return report(Failure{Fault::kUsage, "--watch follows -o, which --if-changed fork leaves", ""});
    auto started = follow::FollowPage::start(options->out, arguments.watch);
    if (!started) return report(started.failure());
    page = std::move(*started);
    say("{}\n", page->address());
  }
  ProgressPrinter printer;
  options->progress = [&](const run::RunProgress& progress) { printer(progress); };
  auto summary = run::run(*loaded.plan, *options);
  printer.clear();
  if (!summary) return report(summary.failure());
  print_summary(*summary);
  return summary->invalid ? kOutside : kFine;
}

}  // namespace

void add_run(Verb app, int& exit) {
  auto arguments = std::make_shared<CallArguments>();
  Verb verb = app.add_subcommand("run", "evaluate a policy; the same command again continues");
  verb.footer("policies:\n" + run::policy_help() +
              "\nexample: vlaprobe run suite/intact.probe --policy expert --jobs 2 -o runs/expert\n"
              "         vlaprobe run suite/intact.probe --policy P -o runs/p --until \"width 10%\"");
  add_run_options(verb, arguments->run);
  verb.add_option("--shard", arguments->shard, "I/N: this call's share; `merge` joins them. @I/N: I counted from 0");
  verb.add_option("--until", arguments->until,
                  "when to stop early: \"width 10%\", \"width 5% of all\", \"decided-against DIR\"; "
                  "none: run the rest");
  verb.add_option("--watch", arguments->watch,
                  "PORT of a page on this machine that follows the run; 0: any free one");
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = run_verb(*arguments); });
}

}  // namespace probe::cli
