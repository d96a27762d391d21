#include "runtime/cluster/run_words.h"

#include <cmath>
#include <cstdio>

#include "runtime/base/large.h"
#include "runtime/base/paths.h"

namespace probe::cluster {

std::vector<std::string> run_words(const run::RunOptions& options) {
  std::vector<std::string> words;
  const auto add = [&](const char* flag, const std::string& value) {
    words.insert(words.end(), {flag, value});
  };
  if (!options.suite.empty()) add("--suite", options.suite);
  if (options.tasks != "*") add("--tasks", options.tasks);
  if (options.episodes) {
    add("--episodes",
        std::to_string(options.episodes->first) + "-" + std::to_string(options.episodes->second));
  }
  if (!options.seeds.empty()) {
    std::string seeds;
    for (const int seed : options.seeds) seeds += (seeds.empty() ? "" : ",") + std::to_string(seed);
    add("--seeds", seeds);
  }
  if (options.video != run::VideoChoice::kNone) {
    add("--video", options.video == run::VideoChoice::kAll ? "all" : "failures");
  }
  for (const std::string& folder : options.assets.folders()) add("--assets", absolute_path(folder));
  add("--retries", std::to_string(options.retries));
  add("--give-up-after", std::to_string(options.give_up_after));
  if (options.if_changed == run::IfChanged::kContinue) add("--if-changed", "continue");
  if (options.accepts_any_certificate) words.push_back("--insecure");
  if (is_large_allowed()) words.push_back("--allow-large");
  if (options.live) {
    if (options.live->delay_s) {
      char delay[40];
      std::snprintf(delay, sizeof delay, "%.17gs", *options.live->delay_s);
      add("--live-delay", delay);
    } else {
      words.push_back("--live");
    }
    add("--live-most-held", std::to_string(std::lround(100 * options.live->most_held)));
  }
  return words;
}

}  // namespace probe::cluster
