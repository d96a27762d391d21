// vlaprobe merge
#include "runtime/store/merge.h"
#include "runtime/base/say.h"

#include <fmt/format.h>

#include "runtime/ask/answers.h"
#include "runtime/ask/merge.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/search/merge_searches.h"
#include "runtime/search/search.h"

namespace probe::cli {
namespace {

int merge_verb(const store::MergeOptions& options) {
  const bool are_answers = !options.dirs.empty() && ask::holds_answers(options.dirs.front());
  const bool are_searches = !options.dirs.empty() && search::is_search(options.dirs.front());
  const auto summary = are_answers    ? ask::merge(options)
                       : are_searches ? search::merge_searches(options)
                                      : store::merge(options);
  if (!summary) return report(summary.failure());
  for (const std::string& note : summary->notes) say("note: {}\n", note);
  say("{} {} in {}: {} added now, {} duplicates dropped, {} invalid\n", summary->rows,
      are_answers ? "answers" : "episodes", options.out, summary->added, summary->duplicates,
      summary->invalid);
  if (summary->not_attempted.count() > 0)
    say("{} of them were not attempted: {}\n", summary->not_attempted.count(),
        store::to_text(summary->not_attempted));
  if (summary->unvouched > 0) {
    say("vlaprobe: {} answers count neither way, because they do not follow from what they hold\n",
        summary->unvouched);
    return kOutside;
  }
  if (summary->left_out == 0) return kFine;
  say("vlaprobe: {} rows were left out, because their traces do not show them\n",
      summary->left_out);
  return kOutside;
}

}  // namespace

void add_merge(Verb app, int& exit) {
  auto options = std::make_shared<store::MergeOptions>();
  Verb verb = app.add_subcommand(
      "merge", "join the folders of shards, of runs, answers or searches, exactly once");
  verb.footer("example: vlaprobe merge runs/shard-1 runs/shard-2 -o runs/all");
  verb.add_option("DIR", options->dirs, "folders of one run, one asking or one search").required();
  verb.add_option("-o,--out", options->out, "results folder; what it holds stays").required();
  verb.add_flag("--mixed-builds", options->mixed_builds,
                "also join what other builds and machines made");
  verb.refuse_empty_values();
  verb.callback([options, &exit] { exit = merge_verb(*options); });
}

}  // namespace probe::cli
