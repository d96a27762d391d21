// Options to RunOptions, and sentences about runs.
#include "runtime/cli/full/run_options.h"

#include <fmt/format.h>

#include <charconv>
#include <map>

#include "runtime/base/printable.h"
#include "runtime/base/say.h"
#include "runtime/run/policies.h"
#include "runtime/servers/api_key.h"
#include "runtime/store/not_attempted.h"

namespace probe::cli {
namespace {

constexpr double kLongestDelay = 3600;  // s

Failure usage(std::string message) { return Failure{Fault::kUsage, std::move(message), ""}; }

Result<std::vector<int>> parse_seeds(const std::string& text) {
  std::vector<int> seeds;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const auto seed = to_int(std::string_view(text).substr(begin, comma - begin));
    if (!seed || *seed < 0) {
      return usage(fmt::format("--seeds `{}` is not a list of whole numbers, as in 42,7", text));
    }
    seeds.push_back(*seed);
    begin = comma + 1;
  }
  return seeds;
}

// "80ms", "0.3s", in seconds.
Result<double> parse_delay(const std::string& text) {
  const double in_second = text.ends_with("ms") ? 1000 : 1;
  const std::size_t digits =
      text.size() - std::min<std::size_t>(in_second > 1 ? 2 : 1, text.size());
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + digits, value);
  if (!text.ends_with('s') || error != std::errc() || end != text.data() + digits ||
      !(value >= 0) || value / in_second > kLongestDelay) {
    return usage(
        fmt::format("--live-delay `{}` is not a time from 0ms to 3600s, as in 80ms", text));
  }
  return value / in_second;  // the double nearest to it, however it is written
}

}  // namespace

Failure no_own_suite(const plan::Plan& plan, const std::string& file) {
  std::string names;
  for (const plan::SuiteRecord& suite : plan.suites())
    names += (names.empty() ? "" : ", ") + std::string(plan.text(suite.name));
  return {Fault::kUsage,
          "declares no suite; add `suite mine { tasks { ... }; seeds 42 }`, or take one of a used "
          "file with "
          "--suite: " +
              names,
          file};
}

std::optional<int> to_int(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

Result<std::pair<int, int>> parse_range(const std::string& text) {
  const std::size_t dash = text.find('-');
  const auto first = to_int(std::string_view(text).substr(0, dash));
  const auto last =
      dash == std::string::npos ? first : to_int(std::string_view(text).substr(dash + 1));
  if (!first || !last || *first < 0 || *last < *first) {
    return usage(fmt::format("--episodes `{}` is not of the form A-B, as in 0-23", text));
  }
  return std::pair(*first, *last);
}

Result<std::pair<int, int>> parse_shard(const std::string& text) {
  // Schedulers count from 0.
  const int first = text.starts_with('@') ? 0 : 1;
  const std::string_view numbers = std::string_view(text).substr(first == 0 ? 1 : 0);
  const std::size_t slash = numbers.find('/');
  if (slash != std::string_view::npos) {
    const auto part = to_int(numbers.substr(0, slash));
    const auto parts = to_int(numbers.substr(slash + 1));
    if (part && parts && *part >= first && *part - first < *parts)
      return std::pair(*part - first + 1, *parts);
  }
  return Failure{Fault::kUsage,
                 fmt::format("--shard `{}` is not of the form I/N with 1 <= I <= N, or @I/N with 0 "
                             "<= I < N",
                             text),
                 ""};
}

Status check_name(const std::string& name) {
  if (is_printable(name)) return {};
  constexpr std::size_t kShown = 100;
  return Failure{Fault::kUsage,
                 fmt::format("a name is UTF-8 text without control characters (line breaks, tabs, "
                             "escapes), which `{}` is not",
                             printable(name, kShown)),
                 "--name"};
}

run::IfChanged if_changed_of(const std::string& word) {
  static const std::map<std::string, run::IfChanged> kIfChanged = {
      {"refuse", run::IfChanged::kRefuse},
      {"fork", run::IfChanged::kFork},
      {"continue", run::IfChanged::kContinue}};
  return kIfChanged.at(word);
}

Result<run::RunOptions> to_options(const RunArguments& arguments) {
  run::RunOptions options;
  options.policy = arguments.policy;
  PROBE_TRY(check_name(arguments.name));
  options.name = arguments.name;
  options.out = arguments.out;
  options.suite = arguments.suite;
  options.tasks = arguments.tasks;
  options.assets = root_of(arguments.assets);
  options.jobs = arguments.jobs;
  if (!arguments.episodes.empty()) {
    PROBE_ASSIGN(options.episodes, parse_range(arguments.episodes));
  }
  if (!arguments.seeds.empty()) {
    PROBE_ASSIGN(options.seeds, parse_seeds(arguments.seeds));
  }
  if (arguments.live_most_held && !arguments.live && arguments.live_delay.empty())
    return usage("--live-most-held goes with --live or --live-delay");
  if (arguments.live || !arguments.live_delay.empty()) {
    options.live.emplace();
    if (arguments.live_most_held) options.live->most_held = *arguments.live_most_held / 100.0;
    if (!arguments.live_delay.empty()) {
      PROBE_ASSIGN(options.live->delay_s, parse_delay(arguments.live_delay));
    }
  }
  static const std::map<std::string, run::VideoChoice> kVideo = {
      {"none", run::VideoChoice::kNone},
      {"failures", run::VideoChoice::kFailures},
      {"all", run::VideoChoice::kAll}};
  options.video = kVideo.at(arguments.video);
  options.retries = arguments.retries;
  options.give_up_after = arguments.give_up_after;
  options.accepts_any_certificate = arguments.insecure;
  options.if_changed = if_changed_of(arguments.if_changed);
  return options;
}

LoadedPlan load_runnable(const RunArguments& arguments) {
  AssetOptions assets = arguments.assets;
  assets.tasks = arguments.tasks;
  LoadedPlan loaded = load_plan(arguments.file, assets);
  if (loaded.plan && loaded.only_used_suites && arguments.suite.empty()) {
    loaded.exit = report(no_own_suite(*loaded.plan, arguments.file));
    loaded.plan.reset();
  }
  return loaded;
}

void warn_of_insecure(const std::string& policy) {
  say("WARNING: --insecure: the certificate of `{}` is not checked. Whoever stands between can "
      "answer in its place, and reads pictures and instructions{}.\n",
      policy, servers::api_key().empty() ? "" : " and VLAPROBE_API_KEY");
}

void print_invalid(const store::ResultRow& row) {
  if (store::is_not_attempted(row)) return;  // told once, of all of them
  say("invalid: {} episode {} seed {}: {}\n", row.task, row.episode, row.seed, *row.invalid);
}

void print_summary(const run::RunSummary& summary) {
  for (const std::string& note : summary.notes) say("note: {}\n", note);
  if (summary.total == 0) return;
  say("{}{} episodes in {}: {} run now, {} were there, {} invalid\n",
      summary.until.empty() ? "" : "at most ", summary.total, summary.out, summary.done,
      summary.skipped, summary.invalid);
  for (const std::string& line : summary.until) say("{}\n", line);
  if (summary.not_attempted.count() > 0)
    say("{} of them were not attempted: {}\n", summary.not_attempted.count(),
        store::to_text(summary.not_attempted));
  if (summary.done > 0) say("{}\n", store::to_text(summary.call));
  if (summary.call.retried > 0) {
    say("{} attempts that the server spoiled were made again\n", summary.call.retried);
  }
}

void add_run_options(Verb verb, RunArguments& arguments) {
  verb.add_option("F", arguments.file, ".probe text or .plan file").required();
  verb.add_option("--policy", arguments.policy, "who acts").required();
  add_shared_options(verb, arguments, SharedWords::kRun);
  verb.add_option("--seeds", arguments.seeds, "A,B,... instead of the suite's");
  verb.add_flag("--live", arguments.live,
                "the world does not wait for answers: each takes effect as late as it came");
  verb.add_option("--live-delay", arguments.live_delay,
                  "live, with this time for every answer instead of the measured, as in 80ms");
  verb.add_option("--live-most-held", arguments.live_most_held,
                  "percent of a live episode's steps without an action; more make it invalid (90)")
      .between(0, 100);
  verb.add_option("--video", arguments.video, "none, failures or all")
      .one_of({"none", "failures", "all"});
}

}  // namespace probe::cli
