// vlaprobe draw
#include <fmt/format.h>

#include <span>

#include "runtime/cli/load.h"
#include "runtime/inspect/svg.h"
#include "runtime/inspect/top_view.h"
#include "runtime/plan/writer.h"
#include "runtime/run/assets.h"

namespace probe::cli {
namespace {

struct Arguments {
  std::string file, task, out;
  AssetOptions assets;
};

int draw_verb(const Arguments& arguments) {
  LoadedPlan loaded = load_plan(arguments.file, arguments.assets);
  if (!loaded.plan) return loaded.exit;
  const auto task = find_task(*loaded.plan, arguments.task, loaded.exit);
  if (!task) return loaded.exit;
  auto root = run::find_asset_root(arguments.assets.root);
  if (!root) return report(root.failure());
  auto view = inspect::top_view(*loaded.plan, *task, *root);
  if (!view) return report(view.failure());
  const std::string svg = inspect::to_svg(*view);
  if (arguments.out.empty()) {
    fmt::print("{}", svg);
    return kFine;
  }
  const auto written = plan::write_file(arguments.out, std::as_bytes(std::span(svg)));
  if (!written) return report(written.failure());
  fmt::print("{}\n", arguments.out);
  return kFine;
}

}  // namespace

void add_draw(CLI::App& app, int& exit) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = app.add_subcommand("draw", "all starts of a task from above, as SVG");
  verb->footer(
      "table, cells, footprints, reach and the camera's frame; no simulator\n"
      "example: vlaprobe draw suite/intact.probe carrot_on_plate -o starts.svg");
  verb->add_option("F", arguments->file, ".probe text or .plan file")->required();
  verb->add_option("TASK", arguments->task, "task name, with or without its suite's prefix")
      ->required();
  verb->add_option("-o,--out", arguments->out, "SVG to write (default: stdout)");
  add_asset_option(*verb, arguments->assets);
  verb->callback([arguments, &exit] { exit = draw_verb(*arguments); });
}

}  // namespace probe::cli
