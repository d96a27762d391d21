// vlaprobe compare
#include "runtime/report/compare_folders.h"

#include <fmt/format.h>

#include "runtime/base/say.h"
#include "runtime/cli/full/notes.h"
#include "runtime/cli/full/verbs.h"

namespace probe::cli {
namespace {

struct CompareArguments {
  std::string a, b;
  std::vector<std::string> metrics, sets;
  bool json = false;
};

int compare_verb(const CompareArguments& arguments) {
  const auto compared = report::compare_folders(
      arguments.a, arguments.b, {.metrics = arguments.metrics, .sets = arguments.sets});
  if (!compared) return report(compared.failure());
  // Rows that their traces do not bear are in no number, in JSON neither.
  for (const report::Note& note : compared->benchmark.notes) {
    if (note.level == "bad") say_notes({&note, 1});
  }
  if (arguments.json) {
    put("{}\n", report::to_json(compared->benchmark, compared->comparison).dump(1));
  } else {
    put("{}", report::to_text(compared->benchmark, compared->comparison));
  }
  return kFine;
}

}  // namespace

void add_compare(Verb app, int& exit) {
  auto arguments = std::make_shared<CompareArguments>();
  Verb verb = app.add_subcommand("compare",
                                 "two runs, or two models' answers, on the same starts: which "
                                 "differences are real, how large");
  verb.footer("example: vlaprobe compare runs/step_10000 runs/step_20000");
  verb.add_option("A", arguments->a, "results folder").required();
  verb.add_option("B", arguments->b, "results folder").required();
  verb.add_option("--metrics", arguments->metrics, "A,B,...: of these only").delimiter(',');
  verb.add_option("--sets", arguments->sets, "A,B,...: sets of the plan that are the categories")
      .delimiter(',');
  verb.add_flag("--json", arguments->json, "words and numbers as a JSON object");
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = compare_verb(*arguments); });
}

}  // namespace probe::cli
