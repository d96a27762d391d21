// vlaprobe sheet, vlaprobe preview: pictures of many episodes on one page.
#include <fmt/format.h>

#include <optional>

#include "runtime/assets/output_file.h"
#include "runtime/base/put_words.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/cli/load.h"
#include "runtime/run/replay.h"
#include "runtime/show/preview.h"
#include "runtime/store/run_plan.h"

namespace probe::cli {
namespace {

struct SheetArguments {
  std::string input, task, out;
  std::optional<std::uint32_t> start;
  show::SheetOptions options;
  AssetOptions assets;
};

void add_camera_option(Verb verb, SheetArguments& arguments) {
  verb.add_option("--camera", arguments.options.camera,
                  "of several cameras, the one to show (default: all, side by side)");
}

// Before anything is drawn; false when `exit` says why not.
bool may_write(const Status& spared, int& exit) {
  if (!spared) exit = report(spared.failure());
  return spared.ok();
}

int written(const Status& status, const std::string& path) {
  if (!status) return report(status.failure());
  put_words("{}\n", path);
  return kFine;
}

}  // namespace

void add_sheet(Verb app, int& exit) {
  auto arguments = std::make_shared<SheetArguments>();
  Verb verb =
      app.add_subcommand("sheet", "first and last picture of every stored episode, as one PNG");
  verb.footer("green captions are successes\nexample: vlaprobe sheet runs/expert -o expert.png");
  verb.add_option("DIR", arguments->input, "results folder").required();
  verb.add_option("-o,--out", arguments->out, "PNG to write").required();
  verb.add_option("--tasks", arguments->options.tasks, "glob over task names");
  verb.add_option("--columns", arguments->options.columns, "episodes in a row").between(1, 64);
  add_camera_option(verb, *arguments);
  add_asset_option(verb, arguments->assets);
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] {
    arguments->options.assets = root_of(arguments->assets);
    auto inputs = store::files_of_run(arguments->input, arguments->options.assets);
    inputs.push_back(arguments->input);
    if (!may_write(assets::check_output(arguments->out, inputs), exit)) return;
    exit = written(show::write_contact_sheet(arguments->input, arguments->out, arguments->options),
                   arguments->out);
  });
}

void add_preview(Verb app, int& exit) {
  auto arguments = std::make_shared<SheetArguments>();
  Verb verb =
      app.add_subcommand("preview", "the first picture of every start of a task, as one PNG");
  verb.footer("example: vlaprobe preview suite/intact.probe carrot_on_plate -o starts.png");
  verb.add_option("--start", arguments->start,
                  "one start, counted from 0, in the camera's own size");
  verb.add_option("F", arguments->input, ".probe text or .plan file").required();
  verb.add_option("TASK", arguments->task, "task name").required();
  verb.add_option("-o,--out", arguments->out, "PNG to write").required();
  verb.add_option("--columns", arguments->options.columns, "starts in a row").between(1, 64);
  add_camera_option(verb, *arguments);
  add_asset_option(verb, arguments->assets);
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] {
    arguments->assets.tasks = arguments->task;
    LoadedPlan loaded = load_plan(arguments->input, arguments->assets);
    exit = loaded.exit;
    if (!loaded.plan || !may_write(check_output(arguments->out, loaded), exit)) return;
    const auto task = find_task(*loaded.plan, arguments->task, exit);
    if (!task) return;
    arguments->options.assets = loaded.assets;
    if (arguments->start) {
      exit = written(show::write_start(*loaded.plan, *task, *arguments->start, arguments->out,
                                       arguments->options.assets, arguments->options.camera),
                     arguments->out);
      return;
    }
    exit = written(show::write_preview(*loaded.plan, *task, arguments->out, arguments->options),
                   arguments->out);
  });
}

}  // namespace probe::cli
