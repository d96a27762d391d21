// vlaprobe draw
#include <fmt/format.h>

#include <map>
#include <span>

#include "runtime/base/file.h"
#include "runtime/base/glob.h"
#include "runtime/cli/load.h"
#include "runtime/inspect/svg.h"
#include "runtime/inspect/top_view.h"
#include "runtime/show/phrase_sheet.h"
#include "runtime/stage/assets.h"

namespace probe::cli {
namespace {

struct DrawArguments {
  std::string file, task, out;
  bool phrases = false;
  AssetOptions assets;
};

// Each pair of words and object once, where it is first said, with the number of tasks that say it.
Result<std::vector<show::PhraseRow>> phrase_rows(const LoadedPlan& loaded,
                                                 const std::string& glob) {
  std::vector<show::PhraseRow> rows;
  std::map<std::pair<std::string, std::string>, std::pair<std::size_t, int>> known;
  for (const ReferringWords& said : loaded.referring) {
    const auto task = loaded.plan->find_task(said.task);
    if (!task || !(matches_glob(glob, said.task) || loaded.plan->find_task(glob) == task)) {
      continue;
    }
    const auto [at, is_new] = known.try_emplace({said.words, said.object}, rows.size(), 0);
    ++at->second.second;
    if (is_new) rows.push_back({*task, said.words, said.object, said.task});
  }
  if (rows.empty())
    return Failure{Fault::kUsage, "no task `" + glob + "` that names an object", ""};
  for (const auto& [said, place] : known) {
    show::PhraseRow& row = rows[place.first];
    row.note = fmt::format("`{}` in {}{}", row.object, row.note,
                           place.second == 1 ? "" : fmt::format(" and {} more", place.second - 1));
  }
  return rows;
}

int draw_phrases(const DrawArguments& arguments, const LoadedPlan& loaded) {
  if (!loaded.is_text) {
    return report({Fault::kUsage,
                   "a plan does not keep which words mean which object; give the text",
                   arguments.file});
  }
  if (arguments.out.empty()) return report({Fault::kUsage, "--phrases needs -o X.png", ""});
  auto rows = phrase_rows(loaded, arguments.task);
  if (!rows) return report(rows.failure());
  const auto written =
      show::write_phrases(*loaded.plan, *rows, arguments.out, arguments.assets.root);
  if (!written) return report(written.failure());
  fmt::print("{}\n", arguments.out);
  return kFine;
}

int draw_verb(const DrawArguments& arguments) {
  AssetOptions assets = arguments.assets;
  assets.tasks = arguments.task;
  LoadedPlan loaded = load_plan(arguments.file, assets);
  if (!loaded.plan) return loaded.exit;
  if (arguments.phrases) return draw_phrases(arguments, loaded);
  const auto task = find_task(*loaded.plan, arguments.task, loaded.exit);
  if (!task) return loaded.exit;
  auto root = stage::find_asset_root(arguments.assets.root);
  if (!root) return report(root.failure());
  auto view = inspect::top_view(*loaded.plan, *task, *root);
  if (!view) return report(view.failure());
  const std::string svg = inspect::to_svg(*view);
  if (arguments.out.empty()) {
    fmt::print("{}", svg);
    return kFine;
  }
  const auto written = write_file(arguments.out, std::as_bytes(std::span(svg)));
  if (!written) return report(written.failure());
  fmt::print("{}\n", arguments.out);
  return kFine;
}

}  // namespace

void add_draw(CLI::App& app, int& exit) {
  auto arguments = std::make_shared<DrawArguments>();
  CLI::App* verb = app.add_subcommand("draw", "all starts of a task from above, as SVG");
  verb->footer(
      "table, cells, footprints, reach and the camera's frame; no simulator\n"
      "example: vlaprobe draw suite/intact.probe carrot_on_plate -o starts.svg");
  verb->add_option("F", arguments->file, ".probe text or .plan file")->required();
  verb->add_option("TASK", arguments->task, "task name, with or without its suite's prefix")
      ->required();
  verb->add_option("-o,--out", arguments->out, "SVG to write (default: stdout)");
  verb->add_flag("--phrases", arguments->phrases,
                 "instead, a PNG of what each referring phrase means; TASK may be a glob");
  add_asset_option(*verb, arguments->assets);
  verb->callback([arguments, &exit] { exit = draw_verb(*arguments); });
}

}  // namespace probe::cli
