#include "runtime/cli/full/ask_options.h"

#include <algorithm>

#include "runtime/cli/full/verbs.h"

namespace probe::cli {
namespace {

Result<ask::Arm> arm_of(const std::string& word) {
  for (const ask::Arm arm : {ask::Arm::kPicture, ask::Arm::kBlind, ask::Arm::kPrior}) {
    if (word == ask::word_of(arm)) return arm;
  }
  return Failure{Fault::kUsage, "an arm is picture, blind or prior, found `" + word + "`",
                 "--arms"};
}

}  // namespace

Result<ask::AskOptions> ask_options(const AskArguments& arguments) {
  ask::AskOptions options;
  PROBE_TRY(check_name(arguments.run.name));
  options.model = arguments.model;
  options.name = arguments.run.name;
  options.out = arguments.run.out;
  options.frames = arguments.frames;
  options.jobs = arguments.run.jobs;
  options.retries = arguments.run.retries;
  options.give_up_after = arguments.run.give_up_after;
  options.accepts_any_certificate = arguments.run.insecure;
  options.if_changed = if_changed_of(arguments.run.if_changed);
  options.assets = arguments.run.assets.root;
  options.choice.suite = arguments.run.suite;
  options.choice.tasks = arguments.run.tasks;
  options.choice.questions = arguments.questions;
  options.choice.arms.clear();
  for (const std::string& word : arguments.arms) {
    PROBE_ASSIGN(const ask::Arm arm, arm_of(word));
    if (std::ranges::find(options.choice.arms, arm) == options.choice.arms.end())
      options.choice.arms.push_back(arm);
  }
  std::ranges::sort(options.choice.arms);
  if (!arguments.run.episodes.empty()) {
    PROBE_ASSIGN(options.choice.episodes, parse_range(arguments.run.episodes));
  }
  PROBE_ASSIGN(const auto shard, parse_shard(arguments.shard));
  options.choice.shard = shard.first;
  options.choice.shards = shard.second;
  return options;
}

LoadedPlan load_asked(const AskArguments& arguments, ask::AskOptions& options) {
  AssetOptions assets = arguments.run.assets;
  assets.tasks = arguments.run.tasks;
  LoadedPlan loaded = load_plan(arguments.run.file, assets);
  options.choice.whole_plan = loaded.only_used_suites && arguments.run.suite.empty();
  return loaded;
}

void add_ask_options(Verb verb, AskArguments& arguments) {
  RunArguments& run = arguments.run;
  verb.add_option("F", run.file, ".probe text or .plan file").required();
  verb.add_option("--model", arguments.model,
                  "openai://HOST:PORT?model=NAME, also https://...; or truth, random, first")
      .required();
  verb.add_option("-o,--out", run.out, "folder of answers").required();
  verb.add_option("--questions", arguments.questions, "SET or SET.FAMILY, with * and ? (all)")
      .delimiter(',')
      .no_extra_values();
  verb.add_option("--arms", arguments.arms,
                  "picture, blind (none) and prior (another start's) (picture)")
      .delimiter(',')
      .no_extra_values();
  verb.add_option("--frames", arguments.frames,
                  "folder of a run: its ends are what questions at the end are about");
  verb.add_option("--tasks", run.tasks, "glob over task names");
  verb.add_option("--episodes", run.episodes, "A-B, first and last start of each task");
  verb.add_option("--jobs", run.jobs, "questions at the server at a time (1)").between(1, 1024);
  // On the verb's page, so that the help fits a screen: kMoreAskOptions.
  verb.add_option("--name", run.name, "");
  verb.add_option("--suite", run.suite, "");
  verb.add_option("--retries", run.retries, "").between(0, 1000);
  verb.add_option("--give-up-after", run.give_up_after, "").between(0, 1000000);
  verb.add_flag("--insecure", run.insecure, "");
  verb.add_option("--if-changed", run.if_changed, "").one_of({"refuse", "fork", "continue"});
  verb.add_option("--assets", run.assets.root, "");
  verb.add_option("--std", run.assets.library, "");
}

}  // namespace probe::cli
