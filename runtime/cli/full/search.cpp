// vlaprobe search
#include "runtime/search/search.h"

#include <memory>

#include "runtime/base/put_words.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/progress_printer.h"
#include "runtime/cli/full/run_options.h"
#include "runtime/cli/full/share.h"
#include "runtime/cli/full/verbs.h"

namespace probe::cli {
namespace {

struct SearchArguments {
  std::string method, file, space, policy, name, out, error = "5%", from, at, shard = "1/1";
  int jobs = 1, retries = 2, give_up_after = 5, levels = 41, number = 1;
  std::optional<int> budget;
  std::optional<std::uint32_t> seed;
  bool unproved = false, insecure = false, json = false;
  AssetOptions assets;
};

int say_found(const search::SearchSummary& found, bool json) {
  for (const std::string& note : found.notes) say("note: {}\n", note);
  if (json) {
    put("{}\n", found.findings.dump(1));
  } else {
    for (const std::string& line : found.lines) put_words("{}\n", line);
  }
  return kFine;
}

int search_verb(const SearchArguments& arguments) {
  const auto method = search::method_of(arguments.method);
  if (!method) {
    const auto found = search::read_search(arguments.file);
    if (!found) return report(found.failure());
    return say_found(*found, arguments.json);
  }
  for (const auto& [value, flag] :
       {std::pair(&arguments.policy, "--policy"), std::pair(&arguments.out, "-o")}) {
    if (value->empty())
      return report(Failure{Fault::kUsage, std::string(flag) + " is missing", "search"});
  }
  const auto error = read_share("--error", arguments.error);
  if (!error) return report(error.failure());
  if (const Status named = check_name(arguments.name); !named) return report(named.failure());
  search::SearchOptions options;
  options.method = *method;
  options.text = {arguments.file, arguments.space, root_of(arguments.assets),
                  arguments.assets.library};
  options.run.policy = arguments.policy;
  options.run.name = arguments.name;
  options.run.out = arguments.out;
  options.run.jobs = arguments.jobs;
  options.run.retries = arguments.retries;
  options.run.give_up_after = arguments.give_up_after;
  options.run.accepts_any_certificate = arguments.insecure;
  options.seed = arguments.seed.value_or(0);
  options.budget = arguments.budget;
  options.error = *error;
  options.levels = arguments.levels;
  options.proves = !arguments.unproved;
  options.from = arguments.from;
  options.number = arguments.number;
  options.at = arguments.at;
  options.tell = [](const std::string& what) { say("{}\n", what); };
  const auto shard = parse_shard(arguments.shard);
  if (!shard) return report(shard.failure());
  options.run.shard = shard->first;
  options.run.shards = shard->second;
  if (options.run.accepts_any_certificate) warn_of_insecure(options.run.policy);
  std::string said;
  const auto found = search::search(options, said);
  if (!found) {
    say("{}", said);
    return report(found.failure());
  }
  say("{} trials, {} episodes ({} run now), {} trials left out\n", found->trials, found->episodes,
      found->ran, found->left_out);
  return say_found(*found, arguments.json);
}

}  // namespace

void add_search(Verb app, int& exit) {
  auto arguments = std::make_shared<SearchArguments>();
  Verb verb =
      app.add_subcommand("search", "where a policy breaks, in a space of variants that are fair");
  verb.footer(
      "boundary   of each change alone: how much of it the policy stands\n"
      "worst      the smallest changes together that break it, confirmed by fresh trials\n"
      "minimal    of a case that fails: which of its changes are needed\n"
      "axes       which changes matter, and which two matter together\n"
      "show       what a search's folder has found\n\n"
      "the same command again continues; found.probe in the folder has what was found as variants\n"
      "example: vlaprobe search boundary mine.probe --space around --policy expert -o searches/a");
  verb.add_option("METHOD", arguments->method, "what is looked for")
      .required()
      .one_of({"boundary", "worst", "minimal", "axes", "show"});
  verb.add_option("F", arguments->file, ".probe text with the space; of `show` a search's folder")
      .required();
  verb.add_option("--space", arguments->space, "which, where the text declares several");
  verb.add_option("--policy", arguments->policy, "who acts");
  verb.add_option("-o,--out", arguments->out, "folder of the search");
  verb.add_option("--name", arguments->name, "what folder and rows call the policy");
  verb.add_option("--budget", arguments->budget, "trials at most; of boundaries each side's");
  verb.add_option("--error", arguments->error,
                  "of a boundary: half its interval's width, as a share of its side (5%)");
  verb.add_option("--levels", arguments->levels,
                  "of a boundary: steps from the task to an end (41)");
  verb.add_option("--seed", arguments->seed, "of everything that a search draws (0)");
  verb.add_option("--from", arguments->from, "of minimal: folder of a `search worst`");
  verb.add_option("--case", arguments->number, "of minimal: which case of it (1)");
  verb.add_option("--at", arguments->at, "of minimal: the case, as \"light.power 0.3, clutter 2\"");
  verb.add_flag("--unproved", arguments->unproved,
                "do not ask the expert whether what is tried can be done");
  verb.add_option(
      "--shard", arguments->shard,
      "I/N: of a boundary's sides or the axes' trials a share; of worst one of N searches");
  verb.add_option("--jobs", arguments->jobs, "worlds in parallel").between(1, 1024);
  verb.add_option("--retries", arguments->retries,
                  "times an episode is tried again that a server spoiled (2)")
      .between(0, 100);
  verb.add_option("--give-up-after", arguments->give_up_after,
                  "spoiled episodes in a row that end the call (5; 0: never)")
      .between(0, 1000000);
  verb.add_flag("--insecure", arguments->insecure, "do not check a server's certificate");
  add_asset_option(verb, arguments->assets);
  verb.add_flag("--json", arguments->json, "what was found as a JSON object");
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = search_verb(*arguments); });
}

}  // namespace probe::cli
