// vlaprobe export
#include "runtime/export/export.h"
#include "runtime/base/say.h"

#include <fmt/format.h>

#include "runtime/cli/full/verbs.h"
#include "runtime/cli/output.h"

namespace probe::cli {

void add_export(Verb app, int& exit) {
  struct ExportArguments {
    std::string dir, out;
    exporting::ExportOptions options;
  };
  auto arguments = std::make_shared<ExportArguments>();
  Verb verb = app.add_subcommand("export", "stored traces for other tools");
  verb.footer(
      "X.jsonl holds a line for each episode and each step, X.h5 a group for each episode\n"
      "example: vlaprobe export runs/expert -o expert.h5");
  verb.add_option("DIR", arguments->dir, "results folder").required();
  verb.add_option("-o,--out", arguments->out, "file to write: .jsonl, .h5 or .hdf5").required();
  verb.add_option("--tasks", arguments->options.tasks, "glob over task names");
  verb.callback([arguments, &exit] {
    if (auto spared = check_output(arguments->out); !spared) {
      exit = report(spared.failure());
      return;
    }
    auto done = exporting::export_run(arguments->dir, arguments->out, arguments->options);
    exit = done ? kFine : report(done.failure());
    if (done) {
      for (const std::string& sentence : done->refused) say("vlaprobe: {}\n", sentence);
      if (!done->refused.empty()) exit = kOutside;
      say("{}: {} episodes, {} steps\n", arguments->out, done->episodes, done->steps);
    }
  });
}

}  // namespace probe::cli
