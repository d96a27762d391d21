// vlaprobe serve
#include <fmt/format.h>

#include "runtime/base/asset_root.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/run_options.h"
#include "runtime/cli/full/until_ended.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/run/recorded.h"
#include "runtime/run/run.h"
#include "runtime/run/selection.h"
#include "runtime/servers/protocol.h"
#include "runtime/servers/served.h"

namespace probe::cli {
namespace {

struct ServeArguments {
  RunArguments run;
  std::string protocol = "openpi";
  servers::ServeOptions options;
};

std::string protocol_words() {
  std::string words;
  for (const servers::Protocol protocol : servers::all_protocols())
    words += (words.empty() ? "" : ", ") + std::string(servers::to_word(protocol));
  return words;
}

Result<servers::Protocol> protocol_of(const std::string& word) {
  for (const servers::Protocol protocol : servers::all_protocols()) {
    if (servers::to_word(protocol) == word) return protocol;
  }
  return Failure{Fault::kUsage, "`" + word + "` is none of " + protocol_words(), "--protocol"};
}

// A policy of this process is run first; its server then knows the episodes by their first
// pictures.
Result<std::string> folder_of(const ServeArguments& arguments, int* exit) {
  constexpr std::string_view kReplay = "replay:";
  if (arguments.run.policy.starts_with(kReplay)) return arguments.run.policy.substr(kReplay.size());
  if (arguments.run.file.empty() || arguments.run.out.empty()) {
    return Failure{Fault::kUsage,
                   "policy `" + arguments.run.policy +
                       "` sees the world: name a .probe text or .plan file, whose episodes are run "
                       "into -o DIR first, or serve `null` or `digest`",
                   "--policy"};
  }
  PROBE_ASSIGN(auto options, to_options(arguments.run));
  const LoadedPlan loaded = load_runnable(arguments.run);
  if (!loaded.plan) {
    *exit = loaded.exit;
    return std::string();
  }
  options.assets = loaded.assets;
  // What draws has other episodes for each seed, which no question names: one is served.
  PROBE_ASSIGN(const run::PolicyChoice choice, run::choose_policy(options.policy));
  if (choice.traits.draws) {
    PROBE_ASSIGN(const auto selection, run::select_jobs(*loaded.plan, options, true));
    if (options.seeds.size() > 1) {
      return Failure{Fault::kUsage,
                     "policy `" + options.policy +
                         "` draws, and no question names a seed: one of them can be served",
                     "--seeds"};
    }
    options.seeds = {selection.seeds.front()};
  }
  PROBE_ASSIGN(const run::RunSummary summary, run::run(*loaded.plan, options));
  print_summary(summary);
  return summary.out;
}

// What the robots of F take; without F a tool's changes.
Result<servers::ServedActions> actions_asked(const ServeArguments& arguments, int* exit) {
  if (arguments.run.file.empty()) return servers::ServedActions{};
  const LoadedPlan loaded = load_runnable(arguments.run);
  if (!loaded.plan) {
    *exit = loaded.exit;
    return servers::ServedActions{};
  }
  PROBE_ASSIGN(const auto options, to_options(arguments.run));
  PROBE_ASSIGN(const auto selection, run::select_jobs(*loaded.plan, options, false));
  std::vector<std::uint32_t> tasks;
  for (const run::EpisodeJob& job : selection.jobs) {
    if (tasks.empty() || tasks.back() != job.task) tasks.push_back(job.task);
  }
  PROBE_ASSIGN(const AssetRoot root, find_asset_root(loaded.assets));
  return run::only_actions(*loaded.plan, tasks, root);
}

int serve_verb(const ServeArguments& arguments) {
  const auto protocol = protocol_of(arguments.protocol);
  if (!protocol) return report(protocol.failure());
  servers::ServeOptions options = arguments.options;
  if (arguments.run.policy == "null" || arguments.run.policy == "digest") {
    int exit = kFine;
    const auto actions = actions_asked(arguments, &exit);
    if (!actions) return report(actions.failure());
    if (exit != kFine) return exit;
    options.actions = *actions;
    auto made = arguments.run.policy == "null" ? servers::serve_null(*actions)
                                               : servers::serve_digest(*actions);
    if (!made) return report(made.failure());
    options.policy = std::move(*made);
  } else {
    int exit = kFine;
    const auto dir = folder_of(arguments, &exit);
    if (!dir) return report(dir.failure());
    if (dir->empty()) return exit;
    const auto seed = run::only_seed(*dir);
    if (!seed) return report(seed.failure());
    options.seed = *seed;
    const auto actions = run::only_actions(*dir);
    if (!actions) return report(actions.failure());
    options.actions = *actions;
    const bool together = options.batch > 1;
    const auto episodes =
        together ? run::recorded_steps(*dir, options.chunk) : run::recorded_episodes(*dir);
    if (!episodes) return report(episodes.failure());
    if (together) {
      say("{} steps of {} are served, each known by its picture as rendered\n", (*episodes)->size(),
          *dir);
      options.policy = servers::serve_steps(*episodes);
    } else {
      options.keeps_episode = true;
      say("{} episodes of {} are served, each known by its first picture as rendered\n",
          (*episodes)->size(), *dir);
      options.policy =
          servers::serve_recorded(*episodes, !servers::has_reset(*protocol, options.dialect));
    }
  }
  const EndSignals ends;
  const auto listener = servers::serve(*protocol, options);
  if (!listener) return report(listener.failure());
  // The numbers of an address of version 6 have colons of their own.
  const bool six = options.address.find(':') != std::string::npos;
  const std::string address = six ? "[" + options.address + "]" : options.address;
  fmt::print("{}\n",
             servers::address_of_served(*protocol, options, address + ":" + (*listener)->port()));
  std::fflush(stdout);
  ends.wait();
  return kFine;
}

}  // namespace

void add_serve(Verb app, int& exit) {
  auto arguments = std::make_shared<ServeArguments>();
  Verb verb = app.add_subcommand("serve", "a policy behind a server, to try a client or a harness");
  verb.footer(
      "Policies: null; digest (small moves that follow from picture and words), both of steps of\n"
      "joints where the robot of F is told those; replay:DIR, a run's episodes, each known by its\n"
      "first picture; expert, noisy:SIGMA and the others of `run`, which are run over F into -o\n"
      "first. Prints the address to ask at; ends with SIGINT or SIGTERM.\n"
      "example: vlaprobe serve suite/intact.probe --policy expert --tasks carrot_on_plate \\\n"
      "           -o runs/expert --protocol gr00t --port 5555");
  verb.add_option("F", arguments->run.file, ".probe text or .plan file");
  verb.add_option("--policy", arguments->run.policy, "who acts").required();
  verb.add_option("--protocol", arguments->protocol, protocol_words());
  verb.add_option("--address", arguments->options.address, "to listen at, a number or a name");
  verb.add_option("--port", arguments->options.port, "to listen at; 0: any free one");
  verb.add_option("--chunk", arguments->options.chunk, "actions of an answer, at most")
      .between(1, 1024);
  verb.add_option("--batch", arguments->options.batch,
                  "questions answered together, at most (openpi, starvla, vlaeval); 1: no batches")
      .between(1, 256);
  verb.add_option("--dialect", arguments->options.dialect, "of gr00t and openvla");
  verb.add_option("--tls-cert", arguments->options.tls.certificate,
                  "PEM file: wss:// or https:// with this certificate; who asks trusts it by ?ca=");
  verb.add_option("--tls-key", arguments->options.tls.key, "PEM file: the certificate's key");
  verb.add_option("-o,--out", arguments->run.out, "results folder of the run before");
  verb.add_option("--suite", arguments->run.suite, "as for `run`");
  verb.add_option("--tasks", arguments->run.tasks, "as for `run`");
  verb.add_option("--episodes", arguments->run.episodes, "as for `run`");
  verb.add_option("--seeds", arguments->run.seeds, "as for `run`; of a policy that draws, one");
  verb.add_option("--jobs", arguments->run.jobs, "as for `run`");
  verb.add_option("--assets", arguments->run.assets.folders, "as for `run`").no_extra_values();
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = serve_verb(*arguments); });
}

}  // namespace probe::cli
