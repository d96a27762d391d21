// vlaprobe export
#include "runtime/export/export.h"
#include "runtime/base/put_words.h"
#include "runtime/base/say.h"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <utility>

#include "runtime/assets/output_file.h"
#include "runtime/base/clock.h"
#include "runtime/cli/full/drawn_line.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/export/dataset/check.h"
#include "runtime/export/dataset/dataset.h"

namespace probe::cli {
namespace {

struct ExportArguments {
  std::vector<std::string> runs, assets;
  std::string out, format, tasks = "*", size, only, check;
  std::optional<int> wordings, fps;
  bool no_redraw = false;
  dataset::DatasetOptions dataset;
};

// "224x224", in pixels.
Status read_size(const std::string& text, dataset::DatasetOptions& options) {
  if (text.empty()) return {};
  int end = 0;
  const bool is_size =
      std::sscanf(text.c_str(), "%4dx%4d%n", &options.width, &options.height, &end) == 2 &&
      static_cast<std::size_t>(end) == text.size() && options.width > 0 && options.height > 0;
  if (is_size) return {};
  return Failure{Fault::kUsage, "expected WIDTHxHEIGHT such as 224x224, found `" + text + "`",
                 "--size"};
}

int say_refused(const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences) say("vlaprobe: {}\n", sentence);
  return sentences.empty() ? kFine : kOutside;
}

// What has a meaning for datasets alone is not ignored elsewhere.
Status of_traces(const ExportArguments& arguments) {
  const std::pair<const char*, bool> given[] = {{"--only", !arguments.only.empty()},
                                                {"--size", !arguments.size.empty()},
                                                {"--camera", !arguments.dataset.cameras.empty()},
                                                {"--rephrase", !arguments.dataset.rephrase.empty()},
                                                {"--wordings", arguments.wordings.has_value()},
                                                {"--fps", arguments.fps.has_value()}};
  for (const auto& [option, is_given] : given) {
    if (is_given)
      return Failure{Fault::kUsage, "is of datasets: with --format lerobot, robomimic or rlds",
                     option};
  }
  return {};
}

int export_traces(const ExportArguments& arguments) {
  if (const auto fits = of_traces(arguments); !fits) return report(fits.failure());
  if (arguments.runs.size() != 1)
    return report(
        {Fault::kUsage, "traces of one run go into a file; datasets take several", "RUN"});
  using Form = exporting::ExportOptions::Form;
  exporting::ExportOptions options;
  options.tasks = arguments.tasks;
  if (arguments.format == "jsonl") options.form = Form::kJsonLines;
  if (arguments.format == "hdf5") options.form = Form::kHdf5;
  const auto done = exporting::export_run(arguments.runs.front(), arguments.out, options);
  if (!done) return report(done.failure());
  for (const std::string& sentence : done->refused) say("vlaprobe: {}\n", sentence);
  say("{}: {} episodes, {} steps\n", arguments.out, done->episodes, done->steps);
  return done->refused.empty() ? kFine : kOutside;
}

int export_dataset(const ExportArguments& arguments, dataset::Format format) {
  dataset::DatasetOptions options = arguments.dataset;
  options.tasks = arguments.tasks;
  options.only_success = arguments.only == "success";
  if (arguments.wordings && options.rephrase.empty())
    return report(
        {Fault::kUsage, "takes words from a table, which --rephrase names", "--wordings"});
  options.wordings = arguments.wordings.value_or(options.wordings);
  if (arguments.fps && (*arguments.fps < 1 || *arguments.fps > 1000))
    return report({Fault::kUsage, "1 to 1000 frames a second", "--fps"});
  options.fps = arguments.fps.value_or(options.fps);
  if (auto sized = read_size(arguments.size, options); !sized) return report(sized.failure());
  const auto begun = std::chrono::steady_clock::now();
  constexpr double kRedrawEvery = 0.2;
  DrawnLine line;
  double drawn = 0;
  options.progress = [&](std::size_t done, std::size_t total) {
    const double now = seconds_since(begun);
    if (!DrawnLine::columns() || (now - drawn < kRedrawEvery && done < total)) return;
    drawn = now;
    line.draw(fmt::format("{} of {} demonstrations", done, total));
  };
  const auto done = dataset::export_dataset(arguments.runs, arguments.out, format, options);
  line.clear();
  if (!done) return report(done.failure());
  for (const std::string& sentence : done->left_out) say("left out: {}\n", sentence);
  if (done->kept > 0)
    say("{} of {} demonstrations were drawn by the export before, which did not end\n", done->kept,
        done->demonstrations);
  const double seconds = seconds_since(begun);
  say("{}: {} episodes of {} demonstrations, {} frames, {:.0f} a second\n", arguments.out,
      done->episodes, done->demonstrations, done->frames,
      static_cast<double>(done->frames) / std::max(seconds, 1e-9));
  return done->refused.empty() ? kFine : kOutside;
}

int check_dataset(const ExportArguments& arguments) {
  const auto checked = dataset::check_dataset(
      arguments.check, {arguments.runs, arguments.dataset.assets, !arguments.no_redraw});
  if (!checked) return report(checked.failure());
  if (say_refused(checked->problems) != kFine) return kOutside;
  const std::string unseen =
      checked->not_redrawn == 0
          ? ""
          : fmt::format(", but for the pictures of {}, which were not drawn again",
                        checked->not_redrawn);
  put_words("{}: {} episodes of {} demonstrations, {} frames are as their traces{}\n",
            arguments.check, checked->episodes, checked->demonstrations, checked->frames, unseen);
  return kFine;
}

int export_verb(const ExportArguments& arguments) {
  if (!arguments.check.empty()) {
    if (arguments.out.empty() && arguments.format.empty()) return check_dataset(arguments);
    return report(
        {Fault::kUsage, "reads a dataset and writes none: without -o and --format", "--check"});
  }
  if (arguments.no_redraw) return report({Fault::kUsage, "is of --check", "--no-redraw"});
  if (arguments.runs.empty()) return report({Fault::kUsage, "which run is exported?", "RUN"});
  if (arguments.out.empty()) return report({Fault::kUsage, "where to write to?", "-o"});
  if (auto spared = assets::check_output(arguments.out, arguments.runs); !spared)
    return report(spared.failure());
  if (arguments.format == "lerobot") return export_dataset(arguments, dataset::Format::kLerobot);
  if (arguments.format == "robomimic")
    return export_dataset(arguments, dataset::Format::kRobomimic);
  if (arguments.format == "rlds") return export_dataset(arguments, dataset::Format::kRlds);
  return export_traces(arguments);
}

}  // namespace

void add_export(Verb app, int& exit) {
  auto arguments = std::make_shared<ExportArguments>();
  dataset::DatasetOptions& options = arguments->dataset;
  Verb verb = app.add_subcommand(
      "export", "stored traces for other tools, or with the pictures again as training data");
  verb.footer(
      "example: vlaprobe export runs/demos --format lerobot --size 224x224 --jobs 2 -o demos");
  verb.add_option("RUN", arguments->runs, "results folders");
  verb.add_option("-o,--out", arguments->out,
                  "file to write: .jsonl, .h5 or .hdf5; of a dataset a new folder");
  verb.add_option("--format", arguments->format, "default: by the file's ending")
      .one_of({"jsonl", "hdf5", "lerobot", "robomimic", "rlds"});
  verb.add_option("--tasks", arguments->tasks, "glob over task names");
  verb.add_option("--only", arguments->only, "episodes that did what was asked")
      .one_of({"success"});
  verb.add_option("--size", arguments->size,
                  "WIDTHxHEIGHT of a dataset's pictures (default: as the policy saw them)");
  verb.add_option(
          "--camera", options.cameras,
          "of a task's cameras this one; NAME=A,B: A or B, called NAME; several times: these")
      .one_each();
  verb.add_option("--rephrase", options.rephrase,
                  "X.jsonl of `vlaprobe rephrase`: tell in its words, split train");
  verb.add_option("--wordings", arguments->wordings,
                  "wordings a demonstration, an episode each (1)");
  verb.add_option("--fps", arguments->fps,
                  "frames a second, 1 to 1000, where the control rate is no whole number");
  verb.add_option("--jobs", options.jobs, "threads; the bytes do not depend on it")
      .between(1, 1024);
  verb.add_option("--check", arguments->check,
                  "DIR: hold this dataset against its traces (RUN: where its runs are now)");
  verb.add_flag("--no-redraw", arguments->no_redraw,
                "of --check: leaves out pictures that have to be drawn again to be compared");
  verb.add_option("--assets", arguments->assets, "").no_extra_values();
  verb.callback([arguments, &exit] {
    arguments->dataset.assets = AssetRoot::chosen(arguments->assets);
    exit = export_verb(*arguments);
  });
}

}  // namespace probe::cli
