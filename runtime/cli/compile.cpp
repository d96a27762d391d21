#include "runtime/cli/compile.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "compiler/diag/json.h"
#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/assets/asset_check.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/glob.h"
#include "runtime/base/say.h"
#include "runtime/cli/library.h"

namespace probe::cli {

CompiledText compile_quietly(const std::vector<std::string>& files, const AssetOptions& assets,
                             const std::string& suite, bool want_plan, bool json,
                             bool chosen_only) {
  CompiledText text;
  auto root = find_asset_root(assets.root);
  if (!root) {
    text.exit = report(root.failure());
    return text;
  }
  auto library = find_library_folders(assets.library);
  if (!library) {
    text.exit = report(library.failure());
    return text;
  }
  auto inspect = assets::AssetCheck::open(*root);
  if (!inspect) {
    text.exit = report(inspect.failure());
    return text;
  }
  CompileOptions options{.asset_root = *root,
                         .suite = suite,
                         .library_folders = *library,
                         .inspect_asset = *std::move(inspect)};
  if (chosen_only) {
    options.wants_task = [glob = assets.tasks](std::string_view name) {
      // A task may be asked for with its suite's prefix before it.
      return matches_glob(glob, name) || glob.ends_with("_" + std::string(name));
    };
  }
  auto compiled = want_plan ? build(files, options) : check(files, options);
  if (!compiled) {
    text.exit = report(compiled.failure());
    return text;
  }
  const Diagnostics& diagnostics = compiled->diagnostics;
  text.errors = diagnostics.error_count();
  text.warnings = diagnostics.size() - text.errors;
  text.only_assets_missing =
      text.errors > 0 && std::all_of(diagnostics.items().begin(), diagnostics.items().end(),
                                     [](const Diagnostic& said) {
                                       return said.severity != Severity::kError ||
                                              said.code == Code::P0202;
                                     });
  for (std::size_t i = 0; i < compiled->sources.size(); ++i) {
    text.files.push_back(compiled->sources.file(FileId{static_cast<std::uint32_t>(i)}).name());
  }
  if (json) {
    text.said = render_json(diagnostics, compiled->sources) + "\n";
  } else if (!diagnostics.empty()) {
    const bool colour = isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr;
    text.said = render_text(diagnostics, compiled->sources, {.colour = colour});
  }
  text.exit = compiled->ok ? kFine : kUser;
  text.plan = std::move(compiled->plan);
  text.unused_phrases = std::move(compiled->unused_phrases);
  text.referring = std::move(compiled->referring);
  text.own_suites = std::move(compiled->own_suites);
  return text;
}

void print_diagnostics(const CompiledText& text, bool json) {
  if (!json) return say_drawn(text.said);
  put("{}", text.said);
  std::fflush(stdout);
}

CompiledText compile_text(const std::vector<std::string>& files, const AssetOptions& assets,
                          const std::string& suite, bool want_plan, bool json) {
  CompiledText text = compile_quietly(files, assets, suite, want_plan, json);
  if (text.only_assets_missing && !assets.tasks.empty() && assets.tasks != "*") {
    CompiledText chosen = compile_quietly(files, assets, suite, want_plan, json, true);
    if (chosen.exit == kFine) {
      say("note: the assets lack what other tasks need; compiled are only the tasks `{}`\n",
          assets.tasks);
    }
    text = std::move(chosen);
  }
  print_diagnostics(text, json);
  if (text.only_assets_missing) {
    say("note: --tasks GLOB takes only tasks that do not need these files\n");
  }
  return text;
}

}  // namespace probe::cli
