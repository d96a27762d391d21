// vlaprobe slurm
#include "runtime/cluster/slurm.h"
#include "runtime/base/own_folder.h"
#include "runtime/base/say.h"
#include "runtime/base/shell_word.h"

#include <fmt/format.h>

#include <filesystem>

#include "runtime/ask/ask_on_slurm.h"
#include "runtime/cli/full/ask_options.h"
#include "runtime/cli/full/run_options.h"
#include "runtime/cli/full/verbs.h"

namespace probe::cli {
namespace {

struct ArrayArguments {
  cluster::JobScript script;
  int array = 0, nodes = 0;
  bool submit = false, detach = false;
};
struct SlurmArguments : ArrayArguments {
  RunArguments run;
  std::string time_from;
};
struct SlurmAskArguments : ArrayArguments {
  AskArguments ask;
};

Result<cluster::ArrayOptions> array_options(const ArrayArguments& arguments) {
  if ((arguments.array > 0) == (arguments.nodes > 0)) {
    return Failure{Fault::kUsage, "one of --array N and --nodes N says how many tasks there are",
                   ""};
  }
  cluster::ArrayOptions options;
  options.script = arguments.script;
  options.script.tasks = arguments.array + arguments.nodes;
  options.script.whole_nodes = arguments.nodes > 0;
  options.script.server_apart = !arguments.script.server_sbatch.empty();
  if (options.script.program.empty())
    options.script.program = (folder_of_program() / "vlaprobe").string();
  options.submit = arguments.submit || arguments.detach;
  options.detach = arguments.detach;
  options.tell = [](const std::string& sentence) { say("{}\n", sentence); };
  return options;
}

// What came of the job, and the exit code.
int tell(const Result<cluster::SlurmReport>& done, const cluster::ArrayOptions& options,
         const char* things, const std::string& out) {
  if (!done) return report(done.failure());
  if (!options.submit) {
    say("{}: an array of {} tasks for {} {}; read it, then run sbatch with it, or "
        "this command with --submit\n",
        done->script, options.script.tasks, done->total, things);
    return kFine;
  }
  if (options.detach && !(done->job.empty() && done->merge_job.empty())) {
    say("{} of {} {} are stored in {}; {} shows the shards grow\n", done->stored, done->total,
        things, out,
        std::string_view(things) == "episodes"
            ? "`vlaprobe results " + shell_word(out) + " --follow`"
            : "squeue and slurm/log there");
    return kFine;
  }
  for (const std::string& note : done->merged.notes) say("note: {}\n", note);
  for (const std::string& note : done->notes) say("note: {}\n", note);
  say("{} of {} {} are stored in {}\n", done->stored, done->total, things, out);
  if (done->stored == done->total) return kFine;
  say("the same command runs what is missing\n");
  return kOutside;
}

int slurm_verb(const SlurmArguments& arguments) {
  const auto array = array_options(arguments);
  if (!array) return report(array.failure());
  auto run_options = to_options(arguments.run);
  if (!run_options) return report(run_options.failure());
  const LoadedPlan loaded = load_runnable(arguments.run);
  if (!loaded.plan) return loaded.exit;
  run_options->assets = loaded.assets;
  cluster::SlurmOptions options;
  static_cast<cluster::ArrayOptions&>(options) = *array;
  options.run = std::move(*run_options);
  options.time_from = arguments.time_from;
  return tell(cluster::run_on_slurm(*loaded.plan, options), *array, "episodes", options.run.out);
}

int slurm_ask_verb(const SlurmAskArguments& arguments) {
  const auto array = array_options(arguments);
  if (!array) return report(array.failure());
  auto options = ask_options(arguments.ask);
  if (!options) return report(options.failure());
  const LoadedPlan loaded = load_asked(arguments.ask, *options);
  if (!loaded.plan) return loaded.exit;
  // The jobs read a plan, which does not say whose suites its suites are.
  if (options->choice.whole_plan) return report(no_own_suite(*loaded.plan, arguments.ask.file));
  return tell(ask::ask_on_slurm(*loaded.plan, *options, *array), *array, "answers", options->out);
}

// `is_brief`: its help has no room for all words.
void add_array_options(Verb verb, ArrayArguments& arguments, bool is_brief) {
  verb.add_option("--array", arguments.array, "N tasks, each with one shard").between(1, 100000);
  verb.add_option("--nodes", arguments.nodes, "N tasks, each with one shard and a node of its own")
      .between(1, 100000);
  verb.add_option("--server-command", arguments.script.server_command,
                  "shell line that starts each task's server; {port} is its port, here and in P");
  verb.add_option("--server-wait", arguments.script.server_wait_s,
                  "seconds until a server answers (600)")
      .between(1, 86400);
  verb.add_option("--sbatch", arguments.script.sbatch,
                  "an option of sbatch, as --sbatch=--gres=gpu:1; may be repeated");
  verb.add_option("--program", arguments.script.program, "path of vlaprobe on the nodes");
  verb.add_flag("--submit", arguments.submit, "submit it, wait and merge");
  verb.add_flag("--detach", arguments.detach,
                is_brief ? "" : "submit it and a job that merges, and do not wait");
  verb.add_option(
      "--server-sbatch", arguments.script.server_sbatch,
      is_brief ? ""
               : "one server for all, on a node of its own, {host} in P: an option of sbatch for it");
}

}  // namespace

void add_slurm(Verb app, int& exit) {
  auto arguments = std::make_shared<SlurmArguments>();
  Verb verb = app.add_subcommand("slurm", "`run` as an array job of Slurm, merged at the end");
  verb.footer(
      "-o holds shards/, slurm/job.sh, its logs and, at the end, the merged run.\n"
      "example: vlaprobe slurm suite/intact.probe --array 8 --jobs 8 -o runs/pi0 --submit \\\n"
      "           --policy 'openpi://127.0.0.1:{port}' --server-command 'serve --port {port}'");
  add_run_options(verb, arguments->run);
  verb.add_option("--time-from", arguments->time_from,
                  "each task asks for time as the episodes of this run took");
  add_array_options(verb, *arguments, false);
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = slurm_verb(*arguments); });
}

void add_slurm_ask(Verb app, int& exit) {
  auto arguments = std::make_shared<SlurmAskArguments>();
  Verb verb = app.add_subcommand("slurm-ask", "`ask` as an array job of Slurm, merged at the end");
  verb.footer(
      more_ask_options(SharedWords::kSlurmAsk) +
      "example: vlaprobe slurm-ask suite/questions.probe --array 8 --jobs 32 -o answers/qwen "
      "--submit \\\n"
      "           --model 'openai://127.0.0.1:{port}?model=qwen' --server-command 'vllm serve qwen "
      "--port {port}'");
  add_ask_options(verb, arguments->ask, SharedWords::kSlurmAsk);
  add_array_options(verb, *arguments, true);
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = slurm_ask_verb(*arguments); });
}

}  // namespace probe::cli
