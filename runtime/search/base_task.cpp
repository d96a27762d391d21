#include "runtime/search/base_task.h"

#include <algorithm>
#include <span>

#include "compiler/diag/text.h"
#include "compiler/space/points.h"
#include "runtime/base/sha256.h"
#include "runtime/base/spelling.h"
#include "runtime/compile/library.h"

namespace probe::search {
namespace {

Failure no_text(const std::string& message, const std::string& where) {
  return {Fault::kUsage, message, where};
}

}  // namespace

Result<std::unique_ptr<BaseTask>> BaseTask::open(const TextOptions& options, std::string& said) {
  if (!options.file.ends_with(".probe"))
    return no_text("a search varies a text, which ends in .probe; a plan is frozen", options.file);
  PROBE_ASSIGN(const AssetRoot root, find_asset_root(options.assets));
  PROBE_ASSIGN(std::vector<std::string> library, compile::find_library_folders(options.library));
  PROBE_ASSIGN(AnalyzedText text,
               analyze_text(std::span(&options.file, 1),
                            {.asset_root = root, .library_folders = std::move(library)}));
  if (!text.compilation.ok) {
    said = render_text(text.compilation.diagnostics, text.compilation.sources);
    return no_text("the text has mistakes", options.file);
  }
  auto base = std::unique_ptr<BaseTask>(new BaseTask(options, std::move(text)));
  const std::vector<sema::Space>& spaces = base->text_.model.spaces;
  std::vector<std::string> names;
  for (const sema::Space& space : spaces) names.push_back(space.name);
  if (spaces.empty())
    return no_text(
        "the text declares no space: `space around of TASK { light ambient 0.05 .. 0.6 }`",
        options.file);
  if (options.space.empty() && spaces.size() > 1) {
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
    return no_text("the text declares several spaces: " + known, "--space");
  }
  const auto found = options.space.empty()
                         ? spaces.begin()
                         : std::ranges::find(spaces, options.space, &sema::Space::name);
  if (found == spaces.end())
    return no_text(
        "no space is called `" + options.space + "`" + did_you_mean(options.space, names),
        "--space");
  base->space_ = &*found;
  base->is_seen_ =
      std::ranges::none_of(base->text_.compilation.diagnostics.items(),
                           [](const Diagnostic& one) { return one.code == Code::P0505; });
  const sema::Model& model = base->text_.model;
  base->ways_ = space::ways_of_fixtures(model, model.scenes[base->task().scene],
                                        base->text_.compilation.asset_root);
  Hasher hasher;
  hasher.text("search text").text(found->name);
  const SourceSet& sources = base->text_.compilation.sources;
  for (std::uint32_t i = 0; i < sources.size(); ++i) hasher.text(sources.file(FileId{i}).text());
  base->hash_ = to_hex(hasher.finish());
  return base;
}

}  // namespace probe::search
