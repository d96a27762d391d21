// vlaprobe report
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "runtime/base/file.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/grafted.h"
#include "runtime/cli/full/notes.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/cli/output.h"
#include "runtime/report/episode_documents.h"
#include "runtime/report/event_tables.h"
#include "runtime/report/page_data.h"
#include "runtime/report/page_writer.h"
#include "runtime/report/published_match.h"
#include "runtime/report/table_text.h"

namespace probe::cli {
namespace {

struct ReportArguments {
  std::vector<std::string> dirs, published, sets;
  std::string out, title, floors, format;
  bool json = false, no_traces = false;
  int jobs = 0;
  std::string command;  // as it was called
};

std::string dump(const Json& json, int indent = -1) { return json.dump(indent); }

// The plans of the runs with std/events.probe behind their metrics, in the benchmark's order; none
// when there is no standard library, or one of them cannot be asked: a note then.
struct EventPlans {
  std::vector<plan::Plan> plans;
  rejudge::EventMetrics metrics;
  std::string note;
};
EventPlans event_plans(const report::Benchmark& benchmark) {
  EventPlans out;
  for (const plan::Plan& stored : benchmark.plan_files) {
    auto text = metrics_text(kEventsText, {});
    if (!text) {
      return {.plans = {},
              .metrics = {},
              .note =
                  "no events are told: std/events.probe is not "
                  "there, or has a mistake"};
    }
    auto grafted = graft(stored, *std::move(text));
    if (!grafted) {
      return {
          .plans = {}, .metrics = {}, .note = "no events are told: " + to_text(grafted.failure())};
    }
    out.plans.push_back(std::move(grafted->plan));
    out.metrics = std::move(grafted->metrics);
  }
  return out;
}

report::EpisodeDocuments read_traces(const report::Benchmark& benchmark, const EventPlans& events,
                                     const ReportArguments& arguments) {
  std::vector<report::EpisodeTrace> episodes;
  episodes.reserve(benchmark.episodes.size());
  for (const report::Episode& e : benchmark.episodes) {
    const auto plan = static_cast<std::size_t>(e.plan);
    episodes.push_back({.row = &e.row,
                        .plan = &benchmark.plan_files[plan],
                        .task = e.task,
                        .events = events.plans.empty() ? nullptr : &events.plans[plan]});
  }
  std::vector<std::string> metrics;
  for (const report::Metric& metric : benchmark.metrics) metrics.push_back(metric.name);
  const int all = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return report::episode_documents(episodes, metrics, benchmark.tasks.size(),
                                   {.jobs = arguments.jobs > 0 ? arguments.jobs : all,
                                    .traces = !arguments.no_traces,
                                    .events = events.metrics});
}

Status write_report(const ReportArguments& arguments) {
  std::vector<std::string> inputs = arguments.published;
  inputs.push_back(arguments.floors);
  PROBE_TRY(check_output(arguments.out, inputs));
  PROBE_ASSIGN(report::Benchmark benchmark,
               report::load(arguments.dirs, {.sets = arguments.sets, .prove = true}));
  report::PageOptions options{.title = arguments.title,
                              .command = arguments.command,
                              .program = std::string("vlaprobe ") + version(),
                              .relative_to = "",
                              .published = {},
                              .models = true};
  options.relative_to = std::filesystem::path(arguments.out).parent_path().string();
  for (const std::string& path : arguments.published) {
    PROBE_ASSIGN(auto table, report::read_published(path));
    for (report::Note& note : report::unmatched(benchmark, table))
      benchmark.notes.push_back(std::move(note));
    options.published.push_back(std::move(table));
  }
  report::Tables tables = report::make_tables(benchmark);
  if (!arguments.floors.empty()) PROBE_TRY(report::add_floors(arguments.floors, benchmark, tables));
  if (!arguments.format.empty()) {
    const std::string text = report::table_text(benchmark, tables, options.published,
                                                *report::table_format(arguments.format));
    say_notes(benchmark.notes);
    if (!arguments.out.empty()) return write_file(arguments.out, std::as_bytes(std::span(text)));
    put("{}", text);
    return {};
  }
  EventPlans events;
  if (!arguments.no_traces) events = event_plans(benchmark);
  if (!events.note.empty()) benchmark.notes.push_back({.level = "note", .text = events.note});
  report::EpisodeDocuments episodes = read_traces(benchmark, events, arguments);
  options.events = report::events_json(benchmark, {events.metrics, std::move(episodes.events)});
  if (arguments.json) {
    put("{}\n", dump(report::page_data(benchmark, tables, options), 1));
    if (arguments.out.empty()) return {};
  }
  for (std::string& note : episodes.notes)
    benchmark.notes.push_back({.level = "warn", .text = std::move(note)});
  const std::string page =
      report::write_page({.data = dump(report::page_data(benchmark, tables, options)),
                          .timelines = std::move(episodes.timelines),
                          .whys = std::move(episodes.whys)});
  PROBE_TRY(write_file(arguments.out, std::as_bytes(std::span(page))));
  say_notes(benchmark.notes);
  say("{}: {} {}, {} episodes, {:.1f} MB\n", arguments.out, benchmark.policies.size(),
      benchmark.policies.size() == 1 ? "policy" : "policies", benchmark.episodes.size(),
      static_cast<double>(page.size()) / 1e6);
  return {};
}

int report_verb(ReportArguments& arguments) {
  if (arguments.out.empty() && !arguments.json && arguments.format.empty()) {
    return report(Failure{Fault::kUsage,
                          "nothing to write: give -o page.html, or --json, or --format csv", ""});
  }
  arguments.command = "vlaprobe report";
  for (const std::string& dir : arguments.dirs) arguments.command += " " + dir;
  for (const std::string& path : arguments.published) arguments.command += " --with " + path;
  if (!arguments.floors.empty()) arguments.command += " --floors " + arguments.floors;
  if (!arguments.out.empty()) arguments.command += " -o " + arguments.out;
  const Status status = write_report(arguments);
  return status ? kFine : report(status.failure());
}

}  // namespace

void add_report(Verb app, int& exit) {
  auto arguments = std::make_shared<ReportArguments>();
  Verb verb = app.add_subcommand("report",
                                 "one page of runs: tables with intervals, charts, every episode");
  verb.footer(
      "the page opens from disk, offline; videos are linked, so keep them where they are\n"
      "example: vlaprobe report runs/expert runs/null runs/pi0 -o page.html");
  verb.add_option("DIR", arguments->dirs, "results folders").required();
  verb.add_option("-o,--out", arguments->out, "the page");
  verb.add_option("--title", arguments->title, "of the page");
  verb.add_option("--with", arguments->published,
                  "CSV of published percentages, to stand beside ours")
      .one_each();
  verb.add_option("--floors", arguments->floors,
                  "CSV of floors and ceilings measured before, as suite/floors.csv");
  verb.add_option("--sets", arguments->sets, "A,B,...: sets of the plan that are the columns")
      .delimiter(',');
  const Option json =
      verb.add_flag("--json", arguments->json, "the page's numbers as JSON on stdout");
  std::vector<std::string> formats;
  for (const report::TableFormatName& known : report::kTableFormats)
    formats.emplace_back(known.name);
  verb.add_option("--format", arguments->format,
                  "only the tables, as csv (rates), csv-differences (tests), json or latex, to "
                  "stdout or -o")
      .one_of(formats)
      .excludes(json);
  verb.add_flag("--no-traces", arguments->no_traces, "no timelines and no explained verdicts");
  verb.add_option("--jobs", arguments->jobs, "threads that read traces (default: all cores)")
      .between(1, 1024);
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = report_verb(*arguments); });
}

}  // namespace probe::cli
