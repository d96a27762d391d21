// vlaprobe results
#include "runtime/store/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runtime/adaptive/sampled.h"
#include "runtime/ask/answers.h"
#include "runtime/base/put_words.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/answer_results.h"
#include "runtime/cli/full/follow.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/cli/load.h"
#include "runtime/compile/grafted.h"
#include "runtime/rejudge/event_table.h"
#include "runtime/rejudge/tally.h"
#include "runtime/run/delivery.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/store.h"

namespace probe::cli {
namespace {

struct ResultsArguments {
  std::string dir;
  bool json = false, csv = false, delivery = false, events = false, follow = false, is_long = false;
  std::string with, page;
  AssetOptions assets;
};

// What the questions at the beginning of the run showed of a policy server. A folder of an older
// program has none.
void print_readings(const std::string& dir) {
  const auto summary = store::read_reading_summary(dir);
  if (!summary) return;
  for (const std::string& finding : summary->findings) put_words("{}\n", finding);
  if (!summary->good.empty()) put_words("{}\n", summary->good);
  for (const std::string& sentence : summary->batches) put_words("{}\n", sentence);
}

// Rows that their traces do not bear; the exit that they leave.
int say_refused(const store::ProvenRun& proven) {
  for (const std::string& sentence : proven.refused) say("vlaprobe: {}\n", sentence);
  return proven.refused.empty() ? kFine : kOutside;
}

// Of a world that did not wait for its policy.
void print_live(const store::ProvenRun& proven) {
  if (proven.live_terms.empty()) return;
  put_words("{}\n", proven.live_terms);
  put_words("live: {}\n", to_text(proven.live));
}

// Of a run that stops by what it finds: what may be said of its rates.
void print_until(const adaptive::Summarizer& sums, bool is_long) {
  for (const std::string& line : adaptive::to_lines(sums.summary(), is_long))
    put_words("{}\n", line);
}

// How the questions of the folder's calls went, where they went together.
void print_batches(const std::string& dir) {
  const auto calls = store::read_run_calls(dir);
  if (!calls) return;
  for (const store::RunCall& call : *calls) {
    if (call.queries.batches > 0) put_words("{}\n", store::to_text(call));
  }
}

// In place of rates, which a folder of successes alone has none of.
void print_successes(const std::string& dir,
                     const std::vector<std::pair<std::string, int>>& counts) {
  put_words("{} {}\n", dir, store::kSuccessesAlone);
  for (const auto& [task, count] : counts) put_words("{}: {} successes kept\n", task, count);
}

// Whether what makes tasks different reached the policy.
int delivery_verb(const ResultsArguments& arguments) {
  const auto plan = rejudge::stored_plan(arguments.dir);
  if (!plan) {
    const auto run = store::read_run_record(arguments.dir);
    return report(run ? Failure{Fault::kStore, "its plan cannot be read", arguments.dir}
                      : run.failure());
  }
  run::Delivery delivery(*plan);
  int episodes = 0;
  const auto proven = store::for_each_proven_row(arguments.dir, [&](store::ResultRow&& row) {
    delivery.add(row);
    ++episodes;
    return Status();
  });
  if (!proven) return report(proven.failure());
  const int exit = say_refused(*proven);
  auto findings = delivery.findings();
  if (arguments.json) {
    if (!proven->live_terms.empty()) {
      run::DeliveryFinding live;
      live.kind = run::DeliveryFinding::Kind::kLive;
      live.episodes = episodes;
      live.sentence = proven->live_terms + ": " + to_text(proven->live);
      findings.push_back(std::move(live));
    }
    put("{}\n", run::to_json(findings));
    return exit;
  }
  for (const run::DeliveryFinding& finding : findings) put_words("{}\n", finding.sentence);
  print_readings(arguments.dir);
  print_batches(arguments.dir);
  print_live(*proven);
  if (findings.empty()) {
    put_words("every instruction and picture that should differ reached the policy different\n");
  }
  return exit;
}

// A row an episode.
int rows_verb(const ResultsArguments& arguments) {
  constexpr std::size_t kAtOnce = 100'000;  // rows that are kept
  const auto count = store::count_rows(arguments.dir);
  if (!count) return report(count.failure());
  store::RowTexts texts;
  std::vector<store::ResultRow> rows;
  const auto print = [&](const store::ResultRow& row) {
    put("{}", arguments.json ? texts.json(row) : texts.csv(row));
  };
  const auto proven = store::for_each_proven_row(arguments.dir, [&](store::ResultRow&& row) {
    texts.know(row);
    if (*count <= kAtOnce) rows.push_back(std::move(row));
    return Status();
  });
  if (!proven) return report(proven.failure());
  const int exit = say_refused(*proven);
  put("{}", arguments.json ? texts.json_begin() : texts.csv_begin());
  for (const store::ResultRow& row : rows) print(row);
  // What stands in them is known before the first is printed, so more are read twice; their traces
  // are not.
  if (*count > kAtOnce) {
    const auto again = store::for_each_proven_row(arguments.dir, [&](store::ResultRow&& row) {
      print(row);
      return Status();
    });
    if (!again) return report(again.failure());
  }
  if (arguments.json) put("{}\n", texts.json_end());
  return exit;
}

// Counts by task.
int tally_verb(const ResultsArguments& arguments) {
  const auto until = adaptive::read_adaptive(arguments.dir);
  if (!until) return report(until.failure());
  std::optional<adaptive::Summarizer> sums;
  if (*until) sums.emplace(**until);
  rejudge::TallyText tally;
  std::vector<std::pair<std::string, int>> successes;  // a task's rows stand together
  const auto proven = store::for_each_proven_row(arguments.dir, [&](store::ResultRow&& row) {
    tally.add(row);
    if (sums) sums->add(row);
    if (successes.empty() || successes.back().first != row.task) successes.push_back({row.task, 0});
    if (!row.invalid) ++successes.back().second;
    return Status();
  });
  if (!proven) return report(proven.failure());
  const int exit = say_refused(*proven);
  if (proven->only_success) {
    print_successes(arguments.dir, successes);
    return exit;
  }
  const auto plan = rejudge::stored_plan(arguments.dir);
  put_words("{}", tally.text(plan ? &*plan : nullptr, arguments.is_long));
  if (sums) print_until(*sums, arguments.is_long);
  print_live(*proven);
  print_readings(arguments.dir);
  return exit;
}

// What happened in the episodes. One whose trace does not bear its row is told of with the reason.
int events_verb(ResultsArguments arguments) {
  if (arguments.with.empty()) arguments.with = compile::kEventsText;
  const auto stored = store::open_run_plan(arguments.dir);
  if (!stored) return report(stored.failure());
  auto rows = store::read_results(arguments.dir);
  if (!rows) return report(rows.failure());
  auto text =
      compile::metrics_text(arguments.with, root_of(arguments.assets), arguments.assets.library);
  if (!text) {
    const LoadedPlan loaded = load_plan(arguments.with, arguments.assets);
    if (!loaded.plan) return loaded.exit;
    return report({Fault::kUsage,
                   "has tasks of its own; events are told by a text of metrics alone",
                   arguments.with});
  }
  const auto grafted = compile::graft(*stored, *std::move(text));
  if (!grafted) return report(grafted.failure());
  int exit = kFine;
  std::vector<rejudge::EventRow> told;
  std::set<std::string> tasks;  // that are told of
  for (store::ResultRow& row : *rows) {
    tasks.insert(row.task);
    rejudge::EventRow& out = told.emplace_back();
    const auto task = stored->find_task(row.task);
    const auto trace = store::prove(*stored, row);
    if (!trace || !task) {
      out.events.untold = trace ? "its task is not in the plan" : to_text(trace.failure());
      exit = kOutside;
    } else {
      auto events = rejudge::events_of(grafted->plan, *task, *trace, grafted->metrics);
      if (!events) return report(events.failure());
      out.events = std::move(*events);
    }
    out.row = std::move(row);
  }
  if (arguments.json) {
    put("{}\n", rejudge::events_to_json(told));
  } else if (arguments.csv) {
    put("{}", rejudge::events_to_csv(told));
  } else {
    put_words("{}", rejudge::event_tally(told));
  }
  if (std::ranges::any_of(told, [](const auto& one) { return one.row.only_success; }))
    say("{} {}\n", arguments.dir, store::kSuccessesAlone);
  for (const MetricLeftOut& out : compile::of_tasks(grafted->left_out, tasks)) say("{}\n", compile::to_text(out));
  return exit;
}

int results_verb(const ResultsArguments& arguments) {
  if (!arguments.page.empty() && !arguments.follow)
    return report({Fault::kUsage, "is a page that follows a run, which --follow asks for", "--page"});
  if (arguments.follow) return follow_run(arguments.dir, arguments.json, arguments.page);
  if (ask::holds_answers(arguments.dir)) {
    if (arguments.delivery || arguments.events)
      return report({Fault::kUsage, "is of runs; these are answers",
                     arguments.events ? "--events" : "--delivery"});
    return print_answers(arguments.dir, arguments.json  ? AnswerForm::kJson
                                        : arguments.csv ? AnswerForm::kCsv
                                                        : AnswerForm::kTable);
  }
  if (arguments.events) return events_verb(arguments);
  if (!arguments.with.empty())
    return report({Fault::kUsage, "says what events are, which --events asks for", "--with"});
  if (arguments.delivery) return delivery_verb(arguments);
  return arguments.json || arguments.csv ? rows_verb(arguments) : tally_verb(arguments);
}

}  // namespace

void add_results(Verb app, int& exit) {
  auto arguments = std::make_shared<ResultsArguments>();
  Verb verb = app.add_subcommand(
      "results", "what a run or an asking found: counts, or one row an episode or answer");
  verb.footer(
      "example: vlaprobe results runs/expert --json\n"
      "         vlaprobe results runs/expert --events");
  verb.add_option("DIR", arguments->dir, "results folder").required();
  const Option json = verb.add_flag("--json", arguments->json, "a JSON array of rows");
  verb.add_flag("--csv", arguments->csv, "rows as comma-separated values").excludes(json);
  verb.add_flag("--long", arguments->is_long,
                "lines for each task where there are many, in place of a table");
  verb.add_flag("--delivery", arguments->delivery,
                "whether differing instructions and pictures reached the policy (--json too)");
  verb.add_flag(
      "--events", arguments->events,
      "what happened: dropped, bumped, tipped; subgoals and their times; how the tool moved");
  verb.add_flag("--follow", arguments->follow,
                "while somebody writes: counts, rates, time left, newest failures (--json: a line "
                "a look)");
  verb.add_option("--page", arguments->page, "with --follow: PORT of a page of it; 0: any free one");
  verb.add_option("--with", arguments->with,
                  "with --events: the text that says what events are (std/events.probe)");
  add_asset_option(verb, arguments->assets);
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = results_verb(*arguments); });
}

}  // namespace probe::cli
