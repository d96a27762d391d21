#include "runtime/report/report_page.h"

#include <algorithm>
#include <filesystem>
#include <thread>
#include <utility>

#include "runtime/compile/grafted.h"
#include "runtime/report/event_tables.h"
#include "runtime/report/page_writer.h"
#include "runtime/report/published_match.h"

namespace probe::report {
namespace {

// The plans of the runs with std/events.probe behind their metrics, in the benchmark's order; none
// when there is no standard library, or one of them cannot be asked: a note then.
struct EventPlans {
  std::vector<plan::Plan> plans;
  rejudge::EventMetrics metrics;
  std::string note;
};
EventPlans event_plans(const Benchmark& benchmark) {
  EventPlans out;
  for (const plan::Plan& stored : benchmark.plan_files) {
    auto text = compile::metrics_text(compile::kEventsText);
    if (!text) {
      return {.plans = {},
              .metrics = {},
              .note =
                  "no events are told: std/events.probe is not "
                  "there, or has a mistake"};
    }
    auto grafted = compile::graft(stored, *std::move(text));
    if (!grafted) {
      return {
          .plans = {}, .metrics = {}, .note = "no events are told: " + to_text(grafted.failure())};
    }
    out.plans.push_back(std::move(grafted->plan));
    out.metrics = std::move(grafted->metrics);
  }
  return out;
}

EpisodeDocuments read_traces(const Benchmark& benchmark, const EventPlans& events,
                             const ReportRequest& request) {
  std::vector<EpisodeTrace> episodes;
  episodes.reserve(benchmark.episodes.size());
  for (const Episode& e : benchmark.episodes) {
    const auto plan = static_cast<std::size_t>(e.plan);
    episodes.push_back({.row = e.row == kAbsent ? nullptr
                                                  : &benchmark.rows[static_cast<std::size_t>(e.row)],
                        .plan = &benchmark.plan_files[plan],
                        .task = e.task,
                        .events = events.plans.empty() ? nullptr : &events.plans[plan]});
  }
  std::vector<std::string> metrics;
  for (const Metric& metric : benchmark.metrics) metrics.push_back(metric.name);
  const int all = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return episode_documents(episodes, metrics, benchmark.tasks.size(),
                           {.jobs = request.jobs > 0 ? request.jobs : all,
                            .traces = request.traces,
                            .events = events.metrics});
}

}  // namespace

Result<LoadedReport> load_report(const ReportRequest& request) {
  PROBE_ASSIGN(Benchmark benchmark, load(request.dirs, {.sets = request.sets, .prove = true}));
  PageOptions options{.title = request.title,
                      .command = request.command,
                      .program = request.program,
                      .relative_to = "",
                      .published = {},
                      .models = true};
  options.relative_to = std::filesystem::path(request.out).parent_path().string();
  for (const std::string& path : request.published) {
    PROBE_ASSIGN(auto table, read_published(path));
    for (Note& note : unmatched(benchmark, table)) benchmark.notes.push_back(std::move(note));
    options.published.push_back(std::move(table));
  }
  Tables tables = make_tables(benchmark);
  if (!request.floors.empty()) PROBE_TRY(add_floors(request.floors, benchmark, tables));
  return LoadedReport{std::move(benchmark), std::move(tables), std::move(options)};
}

EpisodeDocuments read_episodes(LoadedReport& report, const ReportRequest& request) {
  EventPlans events;
  const bool has_all = std::ranges::none_of(
      report.benchmark.episodes, [](const Episode& e) { return e.row == kAbsent; });
  if (request.traces && has_all) events = event_plans(report.benchmark);
  // Sums of some, failures first, would say nothing of all.
  if (request.traces && !has_all)
    events.note =
        "of so many episodes timelines and reasons are of some failures and successes of each task "
        "alone, and no events are told; `vlaprobe why` and `results --events` tell of any";
  if (!events.note.empty())
    report.benchmark.notes.push_back({.level = "note", .text = events.note});
  EpisodeDocuments episodes = read_traces(report.benchmark, events, request);
  if (!has_all) return episodes;
  report.options.events =
      events_json(report.benchmark, {events.metrics, std::move(episodes.events)});
  return episodes;
}

std::string page_text(LoadedReport& report, EpisodeDocuments episodes) {
  for (std::string& note : episodes.notes)
    report.benchmark.notes.push_back({.level = "warn", .text = std::move(note)});
  report.options.plain = 50'000;
  return write_page({.data = page_data(report.benchmark, report.tables, report.options).dump(),
                     .timelines = std::move(episodes.timelines),
                     .whys = std::move(episodes.whys)});
}

}  // namespace probe::report
