// vlaprobe doctor
#include <fmt/format.h>

#include "runtime/base/say.h"
#include "runtime/cli/compile.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/doctor/doctor.h"

namespace probe::cli {
namespace {

struct DoctorArguments {
  bool json = false;
  AssetOptions assets;
};

// The shipped suites with the assets at hand.
Result<plan::Plan> compile_suite(const AssetRoot& asset_root) {
  const std::vector<std::string> files = doctor::golden_suites();
  if (files.empty()) return Failure{Fault::kUsage, "the suite's text is not here", ""};
  AssetOptions assets;
  assets.folders = asset_root.folders();
  CompiledText text = compile_quietly(files, assets, {}, true);
  if (text.plan.empty())
    return Failure{Fault::kAsset, "the suite does not compile with these assets", files.front()};
  return plan::Plan::from_bytes(std::move(text.plan));
}

int examine(const DoctorArguments& arguments) {
  const auto report = doctor::examine(root_of(arguments.assets), compile_suite);
  if (!report) return cli::report(report.failure());
  if (arguments.json) {
    put("{}\n", doctor::to_json(*report, version()));
  } else {
    put("{}", doctor::to_text(*report, version()));
  }
  return report->fine() ? kFine : kOutside;
}

}  // namespace

void add_doctor(Verb app, int& exit) {
  auto arguments = std::make_shared<DoctorArguments>();
  Verb verb = app.add_subcommand(
      "doctor", "what is installed, and whether it draws and settles as it should");
  verb.footer(
      "golden pictures are compared byte for byte on the build that made them, within a tolerance "
      "elsewhere\nexample: vlaprobe doctor --json");
  verb.add_flag("--json", arguments->json, "as JSON");
  add_asset_option(verb, arguments->assets);
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = examine(*arguments); });
}

}  // namespace probe::cli
