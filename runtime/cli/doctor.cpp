// vlaprobe doctor
#include <fmt/format.h>

#include "runtime/cli/filled.h"
#include "runtime/cli/verbs.h"
#include "runtime/run/doctor.h"

namespace probe::cli {
namespace {

struct Arguments {
  bool json = false;
  AssetOptions assets;
};

int examine(const Arguments& arguments) {
  const auto report = run::examine(arguments.assets.root);
  if (!report) return cli::report(report.failure());
  if (arguments.json) {
    fmt::print("{}\n", run::to_json(*report, VLAPROBE_VERSION));
  } else {
    fmt::print("{}", run::to_text(*report, VLAPROBE_VERSION));
  }
  return report->fine() ? kFine : kOutside;
}

}  // namespace

void add_doctor(CLI::App& app, int& exit) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = app.add_subcommand(
      "doctor", "what is installed, and whether it draws and settles as it should");
  verb->footer(
      "golden pictures are compared byte for byte on the build that made them, within a tolerance "
      "elsewhere\nexample: vlaprobe doctor --json");
  verb->add_flag("--json", arguments->json, "as JSON");
  add_asset_option(*verb, arguments->assets);
  refuse_empty_values(*verb);
  verb->callback([arguments, &exit] { exit = examine(*arguments); });
}

}  // namespace probe::cli
