// vlaprobe results
#include "runtime/run/results.h"

#include <fmt/format.h>

#include <map>

#include "runtime/cli/filled.h"
#include "runtime/cli/verbs.h"

namespace probe::cli {
namespace {

struct Arguments {
  std::string dir;
  bool json = false, csv = false;
};

struct Tally {
  int valid = 0, invalid = 0;
  std::string first_invalid;                       // which, and why
  std::vector<std::pair<std::string, int>> trues;  // by metric, in the plan's order
};

// Counts by task, for people; the rows themselves are --json and --csv.
void print_counts(const std::vector<run::ResultRow>& rows) {
  std::vector<std::string> order;
  std::map<std::string, Tally> tallies;
  for (const run::ResultRow& row : rows) {
    auto [it, fresh] = tallies.try_emplace(row.task);
    if (fresh) order.push_back(row.task);
    Tally& tally = it->second;
    if (row.invalid) {
      if (tally.invalid++ == 0) {
        tally.first_invalid =
            fmt::format("episode {} seed {}: {}", row.episode, row.seed, *row.invalid);
      }
      continue;
    }
    ++tally.valid;
    if (tally.trues.empty()) {
      for (const run::MetricValue& metric : row.metrics) {
        if (metric.is_bool) tally.trues.emplace_back(metric.name, 0);
      }
    }
    for (auto& [name, count] : tally.trues) {
      for (const run::MetricValue& metric : row.metrics) {
        if (metric.name == name && metric.value != 0) ++count;
      }
    }
  }
  for (const std::string& task : order) {
    const Tally& tally = tallies[task];
    fmt::print("{}: {} episodes", task, tally.valid + tally.invalid);
    if (tally.invalid) fmt::print(", {} invalid ({})", tally.invalid, tally.first_invalid);
    fmt::print("\n");
    for (const auto& [name, count] : tally.trues) {
      fmt::print("  {:<12} {:>4} of {}\n", name, count, tally.valid);
    }
  }
}

int results_verb(const Arguments& arguments) {
  auto rows = run::read_results(arguments.dir);
  if (!rows) return report(rows.failure());
  if (arguments.json) {
    fmt::print("{}\n", run::results_to_json(*rows));
  } else if (arguments.csv) {
    fmt::print("{}", run::results_to_csv(*rows));
  } else {
    print_counts(*rows);
  }
  return kFine;
}

}  // namespace

void add_results(CLI::App& app, int& exit) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = app.add_subcommand("results", "what a run found: counts, or one row an episode");
  verb->footer("example: vlaprobe results runs/expert --json");
  verb->add_option("DIR", arguments->dir, "results folder")->required();
  CLI::Option* json = verb->add_flag("--json", arguments->json, "a JSON array of rows");
  verb->add_flag("--csv", arguments->csv, "rows as comma-separated values")->excludes(json);
  refuse_empty_values(*verb);
  verb->callback([arguments, &exit] { exit = results_verb(*arguments); });
}

}  // namespace probe::cli
