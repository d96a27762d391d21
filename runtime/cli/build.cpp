// vlaprobe build
#include <fmt/format.h>

#include "runtime/assets/output_file.h"
#include "runtime/base/counted.h"
#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/base/say.h"
#include "runtime/cli/compile.h"
#include "runtime/plan/plan.h"
#include "runtime/plan/writer.h"

namespace probe::cli {
namespace {

// Tasks that stand in the plan of one suite without being its members.
std::size_t only_baselines(const plan::Plan& plan, const std::string& suite) {
  const auto index = plan.find_suite(suite);
  return index ? plan.tasks().size() - plan.members(plan.suites()[*index]).size() : 0;
}

// ", of which suite `few` runs 20"
std::string drawn_text(const plan::Plan& plan) {
  std::string text;
  for (const plan::SuiteRecord& suite : plan.suites()) {
    if (suite.episodes.count > 0)
      text +=
          fmt::format(", of which suite `{}` runs {}", plan.text(suite.name), suite.episodes.count);
  }
  return text;
}

}  // namespace

void add_build(Verb app, int& exit) {
  struct BuildArguments {
    std::vector<std::string> files;
    std::string out, suite;
    bool json = false;
    AssetOptions assets;
  };
  auto arguments = std::make_shared<BuildArguments>();
  Verb verb = app.add_subcommand("build", "check, lower, verify and write one frozen plan");
  verb.footer(
      "prints the plan's root, the hash that names it\n"
      "example: vlaprobe build suite/intact.probe -o intact.plan");
  verb.add_option("F", arguments->files, ".probe texts").required();
  verb.add_option("-o,--out", arguments->out, "plan file to write").required();
  verb.add_option("--suite", arguments->suite,
                  "only this suite's tasks, and the baselines that they are compared with");
  verb.add_option("--tasks", arguments->assets.tasks,
                  "glob: only these tasks, where the assets lack what others need");
  verb.add_flag("--json", arguments->json, "root and sizes as a JSON object");
  add_asset_option(verb, arguments->assets);
  verb.callback([arguments, &exit] {
    CompiledText text = compile_text(arguments->files, arguments->assets, arguments->suite, true);
    exit = text.exit;
    if (exit != kFine) return;
    if (auto spared = assets::check_output(arguments->out, text.files, assets::Writes::kPlan);
        !spared) {
      exit = report(spared.failure());
      return;
    }
    if (auto written = write_file(arguments->out, text.plan); !written) {
      exit = report(written.failure());
      return;
    }
    auto plan = plan::Plan::open(arguments->out);
    if (!plan) {
      exit = report(plan.failure());
      return;
    }
    if (arguments->json) {
      const Json json = {{"root", to_hex(plan->root())},
                         {"tasks", plan->tasks().size()},
                         {"only_baselines", only_baselines(*plan, arguments->suite)},
                         {"episodes", plan->episodes().size()},
                         {"bytes", plan->bytes().size()}};
      put("{}\n", json.dump(2));
      return;
    }
    put("{}\n", to_hex(plan->root()));
    const std::size_t more = only_baselines(*plan, arguments->suite);
    say("{}: {}{}, {}{}, {} bytes\n", arguments->out, counted(plan->tasks().size(), "task"),
        more == 0 ? "" : fmt::format(", {} of them only baselines of the others", more),
        counted(plan->episodes().size(), "episode"), drawn_text(*plan), plan->bytes().size());
  });
}

}  // namespace probe::cli
