// vlaprobe replay
#include "runtime/run/replay.h"
#include "runtime/base/put_words.h"
#include "runtime/base/say.h"

#include <fmt/format.h>

#include "runtime/assets/output_file.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/store/run_plan.h"

namespace probe::cli {
namespace {

struct ReplayArguments {
  std::string dir, task;
  int episode = 0;
  std::optional<int> seed;
  run::ReplayOptions options;
  AssetOptions assets;
};

int replay_verb(const ReplayArguments& arguments) {
  run::ReplayOptions options = arguments.options;
  options.assets = root_of(arguments.assets);
  const bool writes = !options.video.empty() || !options.png.empty();
  const auto inputs =
      writes ? store::files_of_run(arguments.dir, options.assets) : std::vector<std::string>();
  for (const std::string& out : {options.video, options.png}) {
    if (auto spared = assets::check_output(out, inputs); !spared) return report(spared.failure());
  }
  auto report_or =
      run::replay(arguments.dir, arguments.task, arguments.episode, arguments.seed, options);
  if (!report_or) return report(report_or.failure());
  for (const std::string& difference : report_or->fingerprint_differences) {
    say("not as recorded: {}\n", difference);
  }
  if (!options.video.empty()) say("video: {}\n", options.video);
  if (!options.png.empty()) say("picture: {}\n", options.png);
  const std::string name =
      fmt::format("{} episode {} seed {}", arguments.task, arguments.episode, report_or->seed);
  if (options.verify && !report_or->identical) {
    say("vlaprobe: {} differs from its trace: {}\n", name, report_or->difference);
    return kOutside;
  }
  put_words("{}: {} steps {}\n", name, report_or->steps,
            options.verify ? "identical, bit for bit" : "repeated");
  return kFine;
}

}  // namespace

void add_replay(Verb app, int& exit) {
  auto arguments = std::make_shared<ReplayArguments>();
  Verb verb = app.add_subcommand("replay", "a stored episode again, from its recorded actions");
  verb.footer(
      "example: vlaprobe replay runs/expert carrot_on_plate 3 --verify --video carrot3.mp4");
  verb.add_option("DIR", arguments->dir, "results folder").required();
  verb.add_option("TASK", arguments->task, "task name").required();
  verb.add_option("EPISODE", arguments->episode, "start, from 0").required();
  verb.add_option("SEED", arguments->seed, "seed (default: the lowest stored)");
  verb.add_flag("--verify", arguments->options.verify, "compare every measurement and hash");
  verb.add_option("--video", arguments->options.video, "write an mp4");
  verb.add_option("--png", arguments->options.png, "write the picture at --step");
  verb.add_option("--step", arguments->options.png_step,
                  "control step of --png, 0 is the first picture");
  verb.add_option("--camera", arguments->options.camera,
                  "of several cameras, the one to show (default: all, side by side)");
  add_asset_option(verb, arguments->assets);
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = replay_verb(*arguments); });
}

}  // namespace probe::cli
