#include "runtime/cli/full/shared_options.h"

#include <array>
#include <string_view>

#include "runtime/base/check.h"

namespace probe::cli {
namespace {

struct SharedOption {
  std::string_view names;
  std::array<const char*, 3> about;  // by SharedWords; empty: not in the help
};
constexpr SharedOption kSharedOptions[] = {
    {"--name", {"what the rows call the policy (default: P); stays when its server moves", "", ""}},
    {"-o,--out",
     {"results folder", "folder of answers",
      "folder of answers; shards/, slurm/job.sh and its logs stand in it, too"}},
    {"--suite", {"which suite (default: the first that F itself declares)", "", ""}},
    {"--tasks", {"glob over task names", "glob over task names", ""}},
    {"--episodes",
     {"A-B, first and last start of each task", "A-B, first and last start of each task", ""}},
    {"--jobs",
     {"worlds in parallel; more than cores if the policy takes its time (1)",
      "questions at the server at a time (1)", ""}},
    {"--retries",
     {"how often an episode that the server failed is tried again at once (2)", "", ""}},
    {"--give-up-after",
     {"stop when the server failed that many episodes in a row; 0: never (5)", "", ""}},
    {"--insecure",
     {"accept any certificate of a wss:// or https:// server; stored and reported", "", ""}},
    {"--if-changed",
     {"refuse, fork (into DIR-2) or continue over another build or profile", "", ""}},
};

}  // namespace

void add_shared_options(Verb verb, SharedArguments& arguments, SharedWords words) {
  const auto about = [&](std::string_view names) -> std::string {
    for (const SharedOption& option : kSharedOptions) {
      if (option.names == names) return option.about[static_cast<std::size_t>(words)];
    }
    PROBE_CHECK(false, "a shared option has a row");
    return {};
  };
  const auto text = [&](const char* names, std::string& value) {
    return verb.add_option(names, value, about(names));
  };
  const auto number = [&](const char* names, int& value) {
    return verb.add_option(names, value, about(names));
  };
  text("--name", arguments.name);
  text("-o,--out", arguments.out).required();
  text("--suite", arguments.suite);
  text("--tasks", arguments.tasks);
  text("--episodes", arguments.episodes);
  number("--jobs", arguments.jobs).between(1, 1024);
  number("--retries", arguments.retries).between(0, 1000);
  number("--give-up-after", arguments.give_up_after).between(0, 1000000);
  verb.add_flag("--insecure", arguments.insecure, about("--insecure"));
  text("--if-changed", arguments.if_changed).one_of({"refuse", "fork", "continue"});
  add_asset_option(verb, arguments.assets, words == SharedWords::kRun);
}

std::string unsaid_options(SharedWords words) {
  std::string all;
  for (const SharedOption& option : kSharedOptions) {
    if (option.about[static_cast<std::size_t>(words)][0] == '\0')
      all += std::string(option.names) + " ";
  }
  return words == SharedWords::kRun ? all : all + "--assets --std";
}

}  // namespace probe::cli
