// vlaprobe run
#include "runtime/run/run.h"

#include <fmt/format.h>
#include <unistd.h>

#include "runtime/cli/filled.h"
#include "runtime/cli/run_options.h"
#include "runtime/policy/factory.h"

namespace probe::cli {
namespace {

struct Arguments {
  RunArguments run;
  std::string shard = "1/1";
};

Result<std::pair<int, int>> parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash != std::string::npos) {
    const auto part = to_int(std::string_view(text).substr(0, slash));
    const auto parts = to_int(std::string_view(text).substr(slash + 1));
    if (part && parts && *part >= 1 && *part <= *parts) return std::pair(*part, *parts);
  }
  return Failure{"usage", fmt::format("--shard `{}` is not of the form I/N with 1 <= I <= N", text),
                 ""};
}

// One line that is rewritten on a terminal; one line an episode that went wrong anywhere.
class ProgressPrinter {
 public:
  void operator()(const run::RunProgress& progress) {
    if (progress.row && progress.row->invalid) {
      clear();
      print_invalid(*progress.row);
    }
    if (!terminal_) return;
    fmt::print(stderr, "\r{}/{} episodes{}", progress.done + progress.skipped, progress.total,
               progress.skipped ? fmt::format(" ({} were there)", progress.skipped) : "");
    std::fflush(stderr);
    dirty_ = true;
  }
  void clear() {
    if (dirty_) fmt::print(stderr, "\r\033[K");
    dirty_ = false;
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  bool dirty_ = false;
};

int run_verb(const Arguments& arguments) {
  auto options = to_options(arguments.run);
  if (!options) return report(options.failure());
  const auto shard = parse_shard(arguments.shard);
  if (!shard) return report(shard.failure());
  options->shard = shard->first;
  options->shards = shard->second;
  if (auto traits = policy::policy_traits(options->policy); !traits)
    return report(traits.failure());
  const LoadedPlan loaded = load_runnable(arguments.run);
  if (!loaded.plan) return loaded.exit;

  ProgressPrinter printer;
  options->progress = [&](const run::RunProgress& progress) { printer(progress); };
  auto summary = run::run(*loaded.plan, *options);
  printer.clear();
  if (!summary) return report(summary.failure());
  print_summary(*summary);
  return summary->invalid ? kOutside : kFine;
}

}  // namespace

void add_run(CLI::App& app, int& exit) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = app.add_subcommand("run", "evaluate a policy; the same command again continues");
  verb->footer(
      "policies:\n" + policy::policy_help() +
      "\nexample: vlaprobe run suite/intact.probe --policy expert --jobs 2 -o runs/expert");
  add_run_options(*verb, arguments->run);
  verb->add_option("--shard", arguments->shard, "I/N: this call's share; `merge` joins them");
  refuse_empty_values(*verb);
  verb->callback([arguments, &exit] { exit = run_verb(*arguments); });
}

}  // namespace probe::cli
