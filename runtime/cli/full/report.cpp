// vlaprobe report
#include <fmt/format.h>

#include <span>
#include <utility>

#include "runtime/assets/output_file.h"
#include "runtime/base/file.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/notes.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/report/page_data.h"
#include "runtime/report/report_page.h"
#include "runtime/report/search_page.h"
#include "runtime/report/table_text.h"

namespace probe::cli {
namespace {

struct ReportArguments {
  std::vector<std::string> dirs, published, sets;
  std::string out, title, floors, format;
  bool json = false, no_traces = false;
  int jobs = 0;
  std::vector<std::string> assets;
  std::string command;  // as it was called
};

// What is of runs alone, and was given with searches.
Status check_search_options(const ReportArguments& arguments) {
  const std::pair<bool, const char*> of_runs[] = {{!arguments.published.empty(), "--with"},
                                                  {!arguments.floors.empty(), "--floors"},
                                                  {!arguments.sets.empty(), "--sets"},
                                                  {!arguments.format.empty(), "--format"}};
  for (const auto& [is_given, flag] : of_runs) {
    if (is_given)
      return Failure{
          Fault::kUsage,
          std::string(flag) + " is of runs; `" + arguments.dirs.front() + "` is a search's folder",
          ""};
  }
  return {};
}

Status write_search_report(const ReportArguments& arguments) {
  PROBE_TRY(check_search_options(arguments));
  PROBE_ASSIGN(const auto searches, report::load_searches(arguments.dirs));
  const report::SearchPageOptions options{.title = arguments.title,
                                          .command = arguments.command,
                                          .program = std::string("vlaprobe ") + version(),
                                          .assets = AssetRoot::chosen(arguments.assets)};
  if (arguments.json) {
    put("{}\n", report::search_page_json(searches, options).dump(1));
    if (arguments.out.empty()) return {};
  }
  const report::SearchPage page = report::search_page(searches, options);
  PROBE_TRY(write_file(arguments.out, std::as_bytes(std::span(page.html))));
  for (const std::string& note : page.notes) say("note: {}\n", note);
  int trials = 0;
  for (const report::SearchFindings& one : searches) trials += one.trials;
  say("{}: {} {}, {} trials, {:.1f} MB\n", arguments.out, searches.size(),
      searches.size() == 1 ? "search" : "searches", trials,
      static_cast<double>(page.html.size()) / 1e6);
  return {};
}

// What it ends with.
Result<int> write_report(const ReportArguments& arguments) {
  std::vector<std::string> inputs = arguments.published;
  inputs.push_back(arguments.floors);
  PROBE_TRY(assets::check_output(arguments.out, inputs));
  PROBE_ASSIGN(const bool are_searches, report::are_searches(arguments.dirs));
  if (are_searches) {
    PROBE_TRY(write_search_report(arguments));
    return kFine;
  }
  const report::ReportRequest request{.dirs = arguments.dirs,
                                      .sets = arguments.sets,
                                      .published = arguments.published,
                                      .floors = arguments.floors,
                                      .title = arguments.title,
                                      .command = arguments.command,
                                      .program = std::string("vlaprobe ") + version(),
                                      .out = arguments.out,
                                      .traces = !arguments.no_traces,
                                      .jobs = arguments.jobs};
  PROBE_ASSIGN(report::LoadedReport loaded, report::load_report(request));
  if (!arguments.format.empty()) {
    const std::string text =
        report::table_text(loaded.benchmark, loaded.tables, loaded.options.published,
                           *report::table_format(arguments.format));
    say_notes(loaded.benchmark.notes);
    if (arguments.out.empty()) {
      put("{}", text);
    } else {
      PROBE_TRY(write_file(arguments.out, std::as_bytes(std::span(text))));
    }
    return exit_of(loaded.benchmark);
  }
  report::EpisodeDocuments episodes = report::read_episodes(loaded, request);
  if (arguments.json) {
    put("{}\n", report::page_data(loaded.benchmark, loaded.tables, loaded.options).dump(1));
    if (arguments.out.empty()) return exit_of(loaded.benchmark);
  }
  const std::string page = report::page_text(loaded, std::move(episodes));
  PROBE_TRY(write_file(arguments.out, std::as_bytes(std::span(page))));
  say_notes(loaded.benchmark.notes);
  say("{}: {} {}, {} episodes, {:.1f} MB\n", arguments.out, loaded.benchmark.policies.size(),
      loaded.benchmark.policies.size() == 1 ? "policy" : "policies",
      loaded.benchmark.episodes.size(), static_cast<double>(page.size()) / 1e6);
  return exit_of(loaded.benchmark);
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
  const auto exit = write_report(arguments);
  return exit ? *exit : report(exit.failure());
}

}  // namespace

void add_report(Verb app, int& exit) {
  auto arguments = std::make_shared<ReportArguments>();
  Verb verb = app.add_subcommand(
      "report", "one page of runs: tables with intervals, charts, every episode; or of searches");
  verb.footer(
      "the page opens from disk, offline; videos are linked, so keep them where they are\n"
      "example: vlaprobe report runs/expert runs/null runs/pi0 -o page.html");
  verb.add_option("DIR", arguments->dirs, "results folders, or folders of searches").required();
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
  verb.add_option("--assets", arguments->assets,
                  "asset folder of a search's pictures, and again for the next")
      .no_extra_values();
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = report_verb(*arguments); });
}

}  // namespace probe::cli
