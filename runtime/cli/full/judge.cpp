// vlaprobe judge
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "runtime/adaptive/sampled.h"
#include "runtime/base/json.h"
#include "runtime/base/put_words.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/cli/load.h"
#include "runtime/compile/grafted.h"
#include "runtime/rejudge/readings.h"
#include "runtime/rejudge/rejudge.h"
#include "runtime/store/results.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"

namespace probe::cli {
namespace {

struct JudgeArguments {
  std::string dir, with;
  std::vector<std::string> suites;  // globs
  std::string metric;
  rejudge::RejudgeOptions options;
  bool json = false;
  AssetOptions assets;
};

Json changes_json(const std::vector<rejudge::MetricChange>& changes) {
  Json list = Json::array();
  for (const rejudge::MetricChange& m : changes) {
    Json entry = {{"metric", m.name},
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
    list.push_back(std::move(entry));
  }
  return list;
}

void print_json(const rejudge::RejudgeReport& report, const plan::Plan& plan) {
  const Json json = {{"plan_root", to_hex(plan.root())},
                     {"same_plan", report.same_plan},
                     {"valid", report.valid},
                     {"invalid", report.invalid},
                     {"not_attempted", report.not_attempted.count()},
                     {"left_out", report.left_out},
                     {"metrics", changes_json(report.metrics)},
                     {"episodes", Json::parse(store::results_to_json(report.rows))}};
  put("{}\n", json.dump(1));
}

void print_json(const std::vector<rejudge::Reading>& readings, const plan::Plan& plan) {
  Json json = {{"plan_root", to_hex(plan.root())}, {"suites", Json::array()}};
  for (const rejudge::Reading& reading : readings) {
    Json tasks = Json::array();
    for (const rejudge::TaskReading& task : reading.tasks)
      tasks.push_back({{"task", task.task}, {"metrics", changes_json(task.metrics)}});
    json["suites"].push_back({{"suite", reading.suite},
                              {"valid", reading.valid},
                              {"invalid", reading.invalid},
                              {"not_attempted", reading.not_attempted.count()},
                              {"left_out", reading.left_out},
                              {"metrics", changes_json(reading.metrics)},
                              {"tasks", std::move(tasks)}});
  }
  put("{}\n", json.dump(1));
}

// "7 / 24" or a mean, of a metric that is in the new rule alone.
std::string after_alone(const rejudge::RejudgeReport& report, const std::string& name) {
  std::size_t episodes = 0;
  double sum = 0;
  bool is_bool = true;
  for (const store::ResultRow& row : report.rows) {
    if (row.invalid) continue;
    const auto found = std::ranges::find(row.metrics, name, &store::MetricValue::name);
    if (found == row.metrics.end()) continue;
    ++episodes;
    sum += found->value;
    is_bool = found->is_bool;
  }
  if (episodes == 0) return "judged";
  if (is_bool) return fmt::format("{:.0f} / {}", sum, episodes);
  return fmt::format("{:.4g}", sum / static_cast<double>(episodes));
}

void print_table(const rejudge::RejudgeReport& report) {
  std::size_t width = 6;
  for (const rejudge::MetricChange& m : report.metrics) width = std::max(width, m.name.size());
  put_words("{:<{}}  {:>9}  {:>9}  {:>6}  {:>6}\n", "metric", width, "before", "after", "lost",
            "gained");
  for (const rejudge::MetricChange& m : report.metrics) {
    if (m.episodes == 0) {
      put_words("{:<{}}  {:>9}  {:>9}\n", m.name, width, m.only_before > 0 ? "judged" : "-",
                m.only_after > 0 ? after_alone(report, m.name) : "-");
    } else if (m.is_bool) {
      put_words("{:<{}}  {:>4} / {:<2}  {:>4} / {:<2}  {:>6}  {:>6}\n", m.name, width, m.before,
                m.episodes, m.after, m.episodes, m.lost, m.gained);
    } else {
      put_words("{:<{}}  {:>9.4g}  {:>9.4g}  {:>6} of {} changed\n", m.name, width, m.mean_before,
                m.mean_after, m.changed, m.episodes);
    }
  }
}

// Cells under a heading each, the first column to the left, the others to the right.
void print_cells(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const auto& row : rows) {
    std::string line = fmt::format("{:<{}}", row[0], widths[0]);
    for (std::size_t i = 1; i < row.size(); ++i) line += fmt::format("  {:>{}}", row[i], widths[i]);
    put_words("{}\n", line);
  }
}

const rejudge::MetricChange* find(const std::vector<rejudge::MetricChange>& changes,
                                  const std::string& name) {
  const auto it = std::ranges::find(changes, name, &rejudge::MetricChange::name);
  return it == changes.end() || it->episodes == 0 ? nullptr : &*it;
}

std::string before_text(const rejudge::MetricChange& m) {
  return m.is_bool ? fmt::format("{}", m.before) : fmt::format("{:.4g}", m.mean_before);
}

// "31 +9 -2": true in 31, in 9 that were not and no more in 2 that were.
std::string after_text(const rejudge::MetricChange& m) {
  if (!m.is_bool) return fmt::format("{:.4g}", m.mean_after);
  std::string text = fmt::format("{}", m.after);
  if (m.gained > 0) text += fmt::format(" +{}", m.gained);
  if (m.lost > 0) text += fmt::format(" -{}", m.lost);
  return text;
}

// A suite a line, a metric a column.
void print_by_suite(const std::vector<rejudge::Reading>& readings) {
  std::vector<std::vector<std::string>> rows = {{"suite", "episodes"}, {"as stored", ""}};
  std::vector<std::string> names;
  for (const rejudge::Reading& reading : readings) {
    for (const rejudge::MetricChange& m : reading.metrics) {
      if (std::ranges::find(names, m.name) != names.end()) continue;
      names.push_back(m.name);
      rows[0].push_back(m.name);
      rows[1].push_back(m.episodes > 0 ? before_text(m) : "");
    }
  }
  // What was stored is told for the episodes of the first suite.
  rows[1][1] = fmt::format("{}", readings.front().valid);
  for (const rejudge::Reading& reading : readings) {
    rows.push_back({reading.suite, fmt::format("{}", reading.valid)});
    for (const std::string& name : names) {
      const rejudge::MetricChange* m = find(reading.metrics, name);
      rows.back().push_back(m == nullptr ? "" : after_text(*m));
    }
  }
  print_cells(rows);
}

// A task a line, a suite a column, one metric.
void print_by_task(const std::vector<rejudge::Reading>& readings, const std::string& metric) {
  std::vector<std::vector<std::string>> rows = {{"task", "episodes", "as stored"}};
  std::vector<std::string> tasks;
  for (const rejudge::Reading& reading : readings) {
    rows[0].push_back(reading.suite);
    for (const rejudge::TaskReading& task : reading.tasks) {
      if (std::ranges::find(tasks, task.task) == tasks.end()) tasks.push_back(task.task);
    }
  }
  for (const std::string& name : tasks) {
    std::vector<std::string> row = {name, "", ""};
    for (const rejudge::Reading& reading : readings) {
      const auto task = std::ranges::find(reading.tasks, name, &rejudge::TaskReading::task);
      const auto* m = task == reading.tasks.end() ? nullptr : find(task->metrics, metric);
      row.push_back(m == nullptr ? "" : after_text(*m));
      if (m == nullptr) continue;
      row[1] = fmt::format("{}", m->episodes);
      row[2] = before_text(*m);
    }
    rows.push_back(std::move(row));
  }
  print_cells(rows);
}

int judge_under_several(const JudgeArguments& arguments, const plan::Plan& plan) {
  if (!arguments.options.out.empty()) {
    return report(
        {Fault::kUsage, "a results folder is written under one suite; name it whole", "--out"});
  }
  const auto readings =
      rejudge::read_under(arguments.dir, plan, arguments.suites, arguments.options.tasks);
  if (!readings) return report(readings.failure());
  const auto has_metric = [&](const rejudge::Reading& reading) {
    return std::ranges::find(reading.metrics, arguments.metric, &rejudge::MetricChange::name) !=
           reading.metrics.end();
  };
  if (!arguments.metric.empty() && std::ranges::none_of(*readings, has_metric))
    return report({Fault::kUsage, "no metric is called `" + arguments.metric + "`", "--metric"});
  if (arguments.json) {
    print_json(*readings, plan);
  } else if (arguments.metric.empty()) {
    print_by_suite(*readings);
  } else {
    print_by_task(*readings, arguments.metric);
  }
  for (const rejudge::Reading& reading : *readings) {
    if (reading.left_out.empty()) continue;
    say("left out by suite `{}`: {}\n", reading.suite, fmt::join(reading.left_out, ", "));
  }
  return kFine;
}

// The plan that `--with` names, or the stored one with the metrics of a text that has no tasks.
LoadedPlan judging_plan(const JudgeArguments& arguments) {
  auto text =
      compile::metrics_text(arguments.with, root_of(arguments.assets), arguments.assets.library);
  if (!text) return load_plan(arguments.with, arguments.assets);
  LoadedPlan loaded;
  const auto stored = store::open_run_plan(arguments.dir);
  if (!stored) {
    loaded.exit = report(stored.failure());
    return loaded;
  }
  auto grafted = compile::graft(*stored, *std::move(text));
  if (!grafted) {
    loaded.exit = report(grafted.failure());
    return loaded;
  }
  std::set<std::string> tasks;  // that are judged
  if (const auto rows = store::read_results(arguments.dir)) {
    for (const store::ResultRow& row : *rows) tasks.insert(row.task);
  }
  for (const MetricLeftOut& out : compile::of_tasks(grafted->left_out, tasks))
    say("{}\n", compile::to_text(out));
  loaded.plan = std::move(grafted->plan);
  return loaded;
}

int judge_verb(JudgeArguments arguments) {
  LoadedPlan loaded = judging_plan(arguments);
  if (!loaded.plan) return loaded.exit;
  const plan::Plan& plan = *loaded.plan;
  bool several = arguments.suites.size() > 1 || !arguments.metric.empty();
  for (const std::string& suite : arguments.suites) {
    const bool is_glob = suite.find_first_of("*?") != std::string::npos;
    if (!is_glob && !find_suite(plan, suite, loaded.exit)) return loaded.exit;
    several = several || is_glob;
  }
  if (several) {
    if (arguments.suites.empty()) arguments.suites = {"*"};
    return judge_under_several(arguments, plan);
  }
  if (!arguments.suites.empty()) arguments.options.suite = arguments.suites.front();
  auto judged = rejudge::rejudge(arguments.dir, plan, arguments.options);
  if (!judged) return report(judged.failure());
  if (arguments.json) {
    print_json(*judged, plan);
  } else {
    print_table(*judged);
  }
  for (const std::string& task : judged->left_out)
    say("left out: the judging plan has no task for `{}`\n", task);
  if (const auto record = store::read_run_record(arguments.dir);
      record && record->identity.only_success)
    say("{} {}\n", arguments.dir, store::kSuccessesAlone);
  if (const auto record = store::read_run_record(arguments.dir);
      record && !record->identity.until.empty())
    say("{}: {}\n", arguments.dir, adaptive::why_not_fixed(record->identity.until));
  say("{} episodes judged, {} of them invalid\n", judged->rows.size(), judged->invalid);
  if (judged->not_attempted.count() > 0)
    say("{} of them were not attempted: {}\n", judged->not_attempted.count(),
        store::to_text(judged->not_attempted));
  if (!arguments.options.out.empty()) say("results and traces: {}\n", arguments.options.out);
  return kFine;
}

}  // namespace

void add_judge(Verb app, int& exit) {
  auto arguments = std::make_shared<JudgeArguments>();
  Verb verb = app.add_subcommand(
      "judge", "stored traces under another plan's metrics: no policy, no physics");
  verb.footer(
      "tasks are matched by name, or through variants that differ in nothing but what is judged\n"
      "with several suites the table has a line for each, with --metric a column for each and\n"
      "a line a task; `40 +9 -2` is 40 episodes, 9 that were none before, without 2 that were\n"
      "example: vlaprobe judge runs/expert --with suite/semantics.probe --suite ever\n"
      "         vlaprobe judge runs/expert --with std/events.probe -o runs/expert-events");
  verb.add_option("DIR", arguments->dir, "results folder").required();
  verb.add_option("--with", arguments->with,
                  "the judging .plan or .probe text; a text of metrics alone, such as "
                  "std/events.probe, is put behind the run's own")
      .required();
  verb.add_option("--suite", arguments->suites,
                  "judge with this suite's tasks; several, or a glob: a table of them")
      .no_extra_values();
  verb.add_option("--metric", arguments->metric, "this one alone, task by task and suite by suite");
  verb.add_option("--tasks", arguments->options.tasks, "glob over the stored task names");
  verb.add_option("-o,--out", arguments->options.out, "write a results folder");
  verb.add_flag("--json", arguments->json, "changes and rows as a JSON object");
  add_asset_option(verb, arguments->assets);
  verb.callback([arguments, &exit] { exit = judge_verb(*arguments); });
}

}  // namespace probe::cli
