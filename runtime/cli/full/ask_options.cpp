#include "runtime/cli/full/ask_options.h"

#include <algorithm>

#include "runtime/base/say.h"
#include "runtime/cli/full/verbs.h"

namespace probe::cli {
Result<ask::AskOptions> ask_options(const AskArguments& arguments) {
  ask::AskOptions options;
  PROBE_TRY(check_name(arguments.name));
  options.model = arguments.model;
  options.name = arguments.name;
  options.out = arguments.out;
  options.frames = arguments.frames;
  options.jobs = arguments.jobs;
  options.retries = arguments.retries;
  options.give_up_after = arguments.give_up_after;
  options.accepts_any_certificate = arguments.insecure;
  options.if_changed = if_changed_of(arguments.if_changed);
  options.assets = root_of(arguments.assets);
  options.choice.suite = arguments.suite;
  options.choice.tasks = arguments.tasks;
  options.choice.questions = arguments.questions;
  options.choice.arms.clear();
  for (const std::string& word : arguments.arms) {
    PROBE_ASSIGN(const ask::Arm arm, ask::arm_of(word));
    if (std::ranges::find(options.choice.arms, arm) == options.choice.arms.end())
      options.choice.arms.push_back(arm);
  }
  std::ranges::sort(options.choice.arms);
  if (!arguments.episodes.empty()) {
    PROBE_ASSIGN(options.choice.episodes, parse_range(arguments.episodes));
  }
  PROBE_ASSIGN(const auto shard, parse_shard(arguments.shard));
  options.choice.shard = shard.first;
  options.choice.shards = shard.second;
  return options;
}

LoadedPlan load_asked(const AskArguments& arguments, ask::AskOptions& options) {
  AssetOptions assets = arguments.assets;
  assets.tasks = arguments.tasks;
  // Of a text nothing but the suite is compiled, so that its tasks are asked its questions alone.
  LoadedPlan loaded = load_plan(arguments.file, assets, arguments.suite);
  if (loaded.plan && !loaded.is_text && !arguments.suite.empty() &&
      loaded.plan->suites().size() > 1) {
    say("note: a plan of several suites does not say which of them asks what: the tasks of `{}` "
        "are asked all of theirs; a text, or a plan of `build --suite`, asks its own alone\n",
        arguments.suite);
  }
  options.assets = loaded.assets;
  options.choice.whole_plan = loaded.only_used_suites && arguments.suite.empty();
  return loaded;
}

void add_ask_options(Verb verb, AskArguments& arguments, SharedWords words) {
  const auto about = [&](const char* said) { return words == SharedWords::kAsk ? said : ""; };
  verb.add_option("F", arguments.file, ".probe text or .plan file").required();
  verb.add_option("--model", arguments.model,
                  "openai://HOST:PORT?model=NAME, also https://...; or truth, random, first")
      .required();
  add_shared_options(verb, arguments, words);
  verb.add_option("--questions", arguments.questions,
                  about("SET or SET.FAMILY, with * and ? (all)"))
      .delimiter(',')
      .no_extra_values();
  verb.add_option("--arms", arguments.arms,
                  about("picture, blind (none) and prior (another start's) (picture)"))
      .delimiter(',')
      .no_extra_values();
  verb.add_option("--frames", arguments.frames,
                  about("folder of a run: its ends are what questions at the end are about"));
}

std::string more_ask_options(SharedWords words) {
  if (words == SharedWords::kAsk)
    return "more, in runtime/ask/README.md: " + unsaid_options(words) + "\n";
  return "more, as `ask` has them: --questions --arms --frames " + unsaid_options(words) +
         "; as `slurm`: --server-sbatch --detach\n";
}

}  // namespace probe::cli
