// vlaprobe draw
#include "runtime/cli/draw.h"

#include <fmt/format.h>

#include <span>

#include "runtime/base/asset_root.h"
#include "runtime/base/file.h"
#include "runtime/base/say.h"
#include "runtime/inspect/svg.h"
#include "runtime/inspect/top_view.h"

namespace probe::cli {
namespace {

int draw_verb(const DrawArguments& arguments, PhraseDrawing draw_phrases) {
  if (arguments.phrases && draw_phrases == nullptr) return kHandOver;
  AssetOptions assets = arguments.assets;
  assets.tasks = arguments.task;
  LoadedPlan loaded = load_plan(arguments.file, assets);
  if (!loaded.plan) return loaded.exit;
  if (auto spared = check_output(arguments.out, loaded); !spared) return report(spared.failure());
  if (arguments.phrases) return draw_phrases(loaded, arguments);
  const auto task = find_task(*loaded.plan, arguments.task, loaded.exit);
  if (!task) return loaded.exit;
  auto root = find_asset_root(loaded.assets);
  if (!root) return report(root.failure());
  auto view = inspect::top_view(*loaded.plan, *task, *root);
  if (!view) return report(view.failure());
  const std::string svg = inspect::to_svg(*view);
  if (arguments.out.empty()) {
    put("{}", svg);
    return kFine;
  }
  const auto written = write_file(arguments.out, std::as_bytes(std::span(svg)));
  if (!written) return report(written.failure());
  put("{}\n", arguments.out);
  return kFine;
}

}  // namespace

void add_draw(Verb app, int& exit, PhraseDrawing draw_phrases) {
  auto arguments = std::make_shared<DrawArguments>();
  Verb verb = app.add_subcommand("draw", "all starts of a task from above, as SVG");
  verb.footer(
      "table, cells, footprints, reach and the camera's frame; no simulator\n"
      "example: vlaprobe draw suite/intact.probe carrot_on_plate -o starts.svg");
  verb.add_option("F", arguments->file, ".probe text or .plan file").required();
  verb.add_option("TASK", arguments->task, "task name, with or without its suite's prefix")
      .required();
  verb.add_option("-o,--out", arguments->out, "SVG to write (default: stdout)");
  verb.add_flag("--phrases", arguments->phrases,
                "instead, a PNG of what each referring phrase means; TASK may be a glob");
  add_asset_option(verb, arguments->assets);
  verb.callback([arguments, draw_phrases, &exit] { exit = draw_verb(*arguments, draw_phrases); });
}

}  // namespace probe::cli
