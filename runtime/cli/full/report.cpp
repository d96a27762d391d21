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

Status write_report(const ReportArguments& arguments) {
  std::vector<std::string> inputs = arguments.published;
  inputs.push_back(arguments.floors);
  PROBE_TRY(assets::check_output(arguments.out, inputs));
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
    if (!arguments.out.empty()) return write_file(arguments.out, std::as_bytes(std::span(text)));
    put("{}", text);
    return {};
  }
  report::EpisodeDocuments episodes = report::read_episodes(loaded, request);
  if (arguments.json) {
    put("{}\n", report::page_data(loaded.benchmark, loaded.tables, loaded.options).dump(1));
    if (arguments.out.empty()) return {};
  }
  const std::string page = report::page_text(loaded, std::move(episodes));
  PROBE_TRY(write_file(arguments.out, std::as_bytes(std::span(page))));
  say_notes(loaded.benchmark.notes);
  say("{}: {} {}, {} episodes, {:.1f} MB\n", arguments.out, loaded.benchmark.policies.size(),
      loaded.benchmark.policies.size() == 1 ? "policy" : "policies",
      loaded.benchmark.episodes.size(), static_cast<double>(page.size()) / 1e6);
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
