// vlaprobe libero import, vlaprobe libero fidelity
#include "runtime/base/asset_root.h"
#include "runtime/base/counted.h"
#include "runtime/base/put_words.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/libero/fidelity.h"
#include "runtime/libero/import.h"

namespace probe::cli {
namespace {

int import_libero(libero::ImportOptions& options) {
  auto own = find_asset_root();
  if (!own) return report(own.failure());
  options.own = own->folders().front();
  const auto imported = libero::import_libero(options);
  if (!imported) return report(imported.failure());
  for (const libero::ImportLine& line : imported->lines)
    put_words("{:<8} {}\n", line.word, line.text);
  say("{}: {}, {}; {} files, {:.1f} MB\n", options.to, counted(imported->tasks, "task"),
      counted(imported->starts, "start"), imported->files, static_cast<double>(imported->bytes) / 1e6);
  if (imported->broken > 0) {
    say("vlaprobe: {}: the lines above that begin with `broken` are errors of the texts\n",
        options.to);
    return kOutside;
  }
  say("next: vlaprobe check {}/{}.probe --assets {}\n", options.to, imported->suites.front(),
      options.to);
  return kFine;
}

int tell_fidelity(const libero::FidelityOptions& options, bool lists_all) {
  const auto rows = libero::measure_fidelity(options);
  if (!rows) return report(rows.failure());
  bool is_held = true;
  for (const libero::FidelityRow& row : *rows) {
    put_words("{:<38} {:<13} bar {}\n", row.what, libero::to_text(row.held), row.bar);
    if (!row.figure.empty()) put_words("  {}\n", row.figure);
    put_words("  {}\n", row.how);
    constexpr std::size_t kFew = 5;
    const std::size_t shown = lists_all ? row.others.size() : std::min(kFew, row.others.size());
    for (std::size_t i = 0; i < shown; ++i) put_words("    {}\n", row.others[i]);
    if (shown < row.others.size())
      put_words("    and {} more: `--all`\n", row.others.size() - shown);
    is_held = is_held && row.held != libero::Held::kNo;
  }
  return is_held ? kFine : kOutside;
}

}  // namespace

void add_libero(Verb app, int& exit) {
  auto options = std::make_shared<libero::ImportOptions>();
  Verb verb = app.add_subcommand("libero", "LIBERO's tasks from a folder of your own");
  verb.require_subcommand();
  Verb imported = verb.add_subcommand(
      "import", "its problems, stored starts and models as texts, tables and assets");
  imported.footer(
      "one line a suite, an object and a fixture, and for all that is odd or missing\n"
      "FILE has the header suite,task,fixture,x_m,y_m,z_m,qw,qx,qy,qz\n"
      "example: vlaprobe libero import LIBERO --robosuite robosuite -o libero");
  imported.add_option("DIR", options->from, "LIBERO's repository, or libero/libero in it")
      .required();
  imported.add_option("-o,--out", options->to, "folder to make").required();
  imported.add_option("--robosuite", options->robosuite,
                      "robosuite's repository, or models/assets in it");
  imported.add_option("--poses", options->poses,
                      "table of where fixtures stand (default: the middle of their regions)");
  imported.refuse_empty_values();
  imported.callback([options, &exit] { exit = import_libero(*options); });

  auto measured = std::make_shared<libero::FidelityOptions>();
  auto lists_all = std::make_shared<bool>(false);
  Verb fidelity = verb.add_subcommand(
      "fidelity",
      "how an import compares with the original, row by row: bar, figure, how measured");
  fidelity.footer(
      "what has no files to be measured against says so; exit 2 where a bar is missed\n"
      "example: vlaprobe libero fidelity libero --libero LIBERO --records recorded");
  fidelity.add_option("DIR", measured->import, "folder that `libero import` made").required();
  fidelity.add_option("--libero", measured->original,
                      "LIBERO's repository, or libero/libero in it: problems and stored starts");
  fidelity.add_option("--records", measured->records,
                      "what was recorded of LIBERO's own program: libero_tasks.json and others");
  fidelity.add_option("--starts", measured->starts, "of a task that come to rest (default: 50)");
  fidelity.add_option("--sheets", measured->sheets,
                      "folder for pictures: theirs, ours, four times what differs");
  fidelity.add_flag("--all", *lists_all, "all that is beyond a bar, not the first few");
  fidelity.refuse_empty_values();
  fidelity.callback([measured, lists_all, &exit] { exit = tell_fidelity(*measured, *lists_all); });
}

}  // namespace probe::cli
