// vlaprobe judge
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "runtime/cli/load.h"
#include "runtime/rejudge/rejudge.h"

namespace probe::cli {
namespace {

struct Arguments {
  std::string dir, with;
  rejudge::RejudgeOptions options;
  bool json = false;
  AssetOptions assets;
};

void print_json(const rejudge::RejudgeReport& report, const plan::Plan& plan) {
  nlohmann::ordered_json json;
  json["plan_root"] = to_hex(plan.root());
  json["same_plan"] = report.same_plan;
  json["valid"] = report.valid;
  json["invalid"] = report.invalid;
  json["left_out"] = report.left_out;
  json["metrics"] = nlohmann::ordered_json::array();
  for (const rejudge::MetricChange& m : report.metrics) {
    nlohmann::ordered_json entry = {{"metric", m.name},
                                    {"episodes", m.episodes},
                                    {"only_before", m.only_before},
                                    {"only_after", m.only_after},
                                    {"changed", m.changed}};
    if (m.is_bool) {
      entry.update(
          {{"before", m.before}, {"after", m.after}, {"lost", m.lost}, {"gained", m.gained}});
    } else {
      entry.update({{"mean_before", m.mean_before}, {"mean_after", m.mean_after}});
    }
    json["metrics"].push_back(std::move(entry));
  }
  json["episodes"] = nlohmann::ordered_json::parse(run::results_to_json(report.rows));
  fmt::print("{}\n", json.dump(1));
}

void print_table(const rejudge::RejudgeReport& report) {
  std::size_t width = 6;
  for (const rejudge::MetricChange& m : report.metrics) width = std::max(width, m.name.size());
  fmt::print("{:<{}}  {:>9}  {:>9}  {:>6}  {:>6}\n", "metric", width, "before", "after", "lost",
             "gained");
  for (const rejudge::MetricChange& m : report.metrics) {
    if (m.episodes == 0) {
      fmt::print("{:<{}}  {:>9}  {:>9}\n", m.name, width, m.only_before > 0 ? "judged" : "-",
                 m.only_after > 0 ? "judged" : "-");
    } else if (m.is_bool) {
      fmt::print("{:<{}}  {:>4} / {:<2}  {:>4} / {:<2}  {:>6}  {:>6}\n", m.name, width, m.before,
                 m.episodes, m.after, m.episodes, m.lost, m.gained);
    } else {
      fmt::print("{:<{}}  {:>9.4g}  {:>9.4g}  {:>6} of {} changed\n", m.name, width, m.mean_before,
                 m.mean_after, m.changed, m.episodes);
    }
  }
}

int judge_verb(const Arguments& arguments) {
  LoadedPlan loaded = load_plan(arguments.with, arguments.assets);
  if (!loaded.plan) return loaded.exit;
  const plan::Plan& plan = *loaded.plan;
  if (!arguments.options.suite.empty() && !find_suite(plan, arguments.options.suite, loaded.exit)) {
    return loaded.exit;
  }
  auto judged = rejudge::rejudge(arguments.dir, plan, arguments.options);
  if (!judged) return report(judged.failure());
  if (arguments.json) {
    print_json(*judged, plan);
  } else {
    print_table(*judged);
  }
  for (const std::string& task : judged->left_out)
    fmt::print(stderr, "left out: the judging plan has no task for `{}`\n", task);
  fmt::print(stderr, "{} episodes judged, {} of them invalid\n", judged->rows.size(),
             judged->invalid);
  if (!arguments.options.out.empty())
    fmt::print(stderr, "results and traces: {}\n", arguments.options.out);
  return kFine;
}

}  // namespace

void add_judge(CLI::App& app, int& exit) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = app.add_subcommand(
      "judge", "stored traces under another plan's metrics: no policy, no physics");
  verb->footer(
      "tasks are matched by name, or through variants that differ in nothing but what is judged\n"
      "example: vlaprobe judge runs/expert --with suite/semantics.probe --suite ever");
  verb->add_option("DIR", arguments->dir, "results folder")->required();
  verb->add_option("--with", arguments->with, "the judging .plan or .probe text")->required();
  verb->add_option("--suite", arguments->options.suite, "judge with this suite's tasks");
  verb->add_option("--tasks", arguments->options.tasks, "glob over the stored task names");
  verb->add_option("-o,--out", arguments->options.out, "write a results folder");
  verb->add_flag("--json", arguments->json, "changes and rows as a JSON object");
  add_asset_option(*verb, arguments->assets);
  verb->callback([arguments, &exit] { exit = judge_verb(*arguments); });
}

}  // namespace probe::cli
