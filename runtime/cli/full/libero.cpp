// vlaprobe libero import
#include "runtime/base/asset_root.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/libero/import.h"

namespace probe::cli {
namespace {

int import_libero(libero::ImportOptions& options) {
  auto own = find_asset_root();
  if (!own) return report(own.failure());
  options.own = *own;
  const auto imported = libero::import_libero(options);
  if (!imported) return report(imported.failure());
  for (const libero::ImportLine& line : imported->lines) put("{:<8} {}\n", line.word, line.text);
  say("{}: {} tasks, {} starts; {} files, {:.1f} MB\n", options.to, imported->tasks,
      imported->starts, imported->files, static_cast<double>(imported->bytes) / 1e6);
  if (imported->broken > 0) {
    say("vlaprobe: {}: the lines above that begin with `broken` are errors of the texts\n",
        options.to);
    return kOutside;
  }
  say("next: vlaprobe check {}/libero_goal.probe --assets {}\n", options.to, options.to);
  return kFine;
}

}  // namespace

void add_libero(Verb app, int& exit) {
  auto options = std::make_shared<libero::ImportOptions>();
  Verb verb = app.add_subcommand("libero", "LIBERO's tasks from a folder of your own");
  verb.require_subcommand();
  Verb import = verb.add_subcommand(
      "import", "its problems, stored starts and models as texts, tables and assets");
  import.footer(
      "one line a suite, an object and a fixture, and for all that is odd or missing\n"
      "FILE has the header suite,task,fixture,x_m,y_m,z_m,qw,qx,qy,qz\n"
      "example: vlaprobe libero import LIBERO --robosuite robosuite -o libero");
  import.add_option("DIR", options->from, "LIBERO's repository, or libero/libero in it").required();
  import.add_option("-o,--out", options->to, "folder to make").required();
  import.add_option("--robosuite", options->robosuite,
                    "robosuite's repository, or models/assets in it");
  import.add_option("--poses", options->poses,
                    "table of where fixtures stand (default: the middle of their regions)");
  import.refuse_empty_values();
  import.callback([options, &exit] { exit = import_libero(*options);
});
}  // namespace probe::cli

}  // namespace probe::cli
