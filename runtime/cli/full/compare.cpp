// vlaprobe compare
#include "runtime/report/compare_folders.h"

#include <fmt/format.h>

#include "runtime/base/file.h"
#include "runtime/base/put_words.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/notes.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/report/agreement.h"
#include "runtime/report/compare_searches.h"
#include "runtime/report/search_page.h"

namespace probe::cli {
namespace {

struct CompareArguments {
  std::vector<std::string> dirs;
  std::vector<std::string> metrics, sets;
  std::string with;
  bool json = false;
};

// Rates of simulations against real ones: those of the table, and of the runs.
int compare_rates(const CompareArguments& arguments) {
  const auto text = read_file(arguments.with);
  if (!text) return report(text.failure());
  auto table = report::parse_rate_table(*text, arguments.with);
  if (!table) return report(table.failure());
  int exit = kFine;
  if (!arguments.dirs.empty()) {
    const auto benchmark = report::load(arguments.dirs, {.prove = true});
    if (!benchmark) return report(benchmark.failure());
    say_notes(benchmark->notes);
    for (const std::string& left_out : report::add_runs(*table, *benchmark)) say("{}\n", left_out);
    exit = exit_of(*benchmark);
  }
  if (arguments.json) {
    put("{}\n", report::agreement_json(*table).dump(1));
  } else {
    put_words("{}", report::agreement_text(*table));
  }
  return exit;
}

int compare_two_searches(const CompareArguments& arguments) {
  if (!arguments.metrics.empty() || !arguments.sets.empty())
    return report(
        Failure{Fault::kUsage, "--metrics and --sets are of runs; these are searches", ""});
  const auto compared = report::compare_searches(arguments.dirs[0], arguments.dirs[1]);
  if (!compared) return report(compared.failure());
  if (arguments.json) {
    put("{}\n", report::to_json(*compared).dump(1));
  } else {
    put_words("{}", report::to_text(*compared));
  }
  return kFine;
}

int compare_verb(const CompareArguments& arguments) {
  if (!arguments.with.empty()) {
    if (arguments.metrics.empty() && arguments.sets.empty()) return compare_rates(arguments);
    return report(
        Failure{Fault::kUsage,
                "--with compares rates of success, of the sets that its rows name: give it "
                "without --metrics and --sets",
                ""});
  }
  if (arguments.dirs.size() != 2) {
    return report(
        Failure{Fault::kUsage,
                fmt::format("two results folders are compared, {} given; any number of them "
                            "against real rates: --with TABLE.csv",
                            arguments.dirs.size()),
                ""});
  }
  const auto are_searches = report::are_searches(arguments.dirs);
  if (!are_searches) return report(are_searches.failure());
  if (*are_searches) return compare_two_searches(arguments);
  const auto compared = report::compare_folders(
      arguments.dirs[0], arguments.dirs[1], {.metrics = arguments.metrics, .sets = arguments.sets});
  if (!compared) return report(compared.failure());
  // Rows that their traces do not bear are in no number, in JSON neither.
  for (const report::Note& note : compared->benchmark.notes) {
    if (note.level == "bad") say_notes({&note, 1});
  }
  if (arguments.json) {
    put("{}\n", report::to_json(compared->benchmark, compared->comparison).dump(1));
  } else {
    put_words("{}", report::to_text(compared->benchmark, compared->comparison));
  }
  return exit_of(compared->benchmark);
}

}  // namespace

void add_compare(Verb app, int& exit) {
  auto arguments = std::make_shared<CompareArguments>();
  Verb verb = app.add_subcommand("compare",
                                 "two runs, or two models' answers, on the same starts: which "
                                 "differences are real, how large; or two searches of boundaries");
  verb.footer("example: vlaprobe compare runs/step_10000 runs/step_20000");
  verb.add_option("DIR", arguments->dirs, "two results folders; behind --with any number");
  verb.add_option("--metrics", arguments->metrics, "A,B,...: of these only").delimiter(',');
  verb.add_option("--sets", arguments->sets, "A,B,...: sets of the plan that are the categories")
      .delimiter(',');
  verb.add_option("--with", arguments->with,
                  "TABLE.csv of published rates, real ones among them: MMRV and Pearson of each "
                  "protocol, and of the folders' runs; rates that no count gives");
  verb.add_flag("--json", arguments->json, "words and numbers as a JSON object");
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = compare_verb(*arguments); });
}

}  // namespace probe::cli
