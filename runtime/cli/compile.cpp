#include "runtime/cli/compile.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "compiler/diag/json.h"
#include "compiler/diag/text.h"
#include "runtime/base/say.h"
#include "runtime/compile/files.h"

namespace probe::cli {

CompiledText compile_quietly(const std::vector<std::string>& files, const AssetOptions& assets,
                             const std::string& suite, bool want_plan, bool json,
                             bool chosen_only) {
  CompiledText text;
  auto compiled = compile::compile_files(files, {.assets = assets.root,
                                                 .library = assets.library,
                                                 .suite = suite,
                                                 .tasks = chosen_only ? assets.tasks : "",
                                                 .wants_plan = want_plan});
  if (!compiled) {
    text.exit = report(compiled.failure());
    return text;
  }
  const Diagnostics& diagnostics = compiled->diagnostics;
  text.errors = diagnostics.error_count();
  text.warnings = diagnostics.size() - text.errors;
  text.only_assets_missing = compile::lacks_only_assets(diagnostics);
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
  text.tasks = compiled->tasks;
  text.starts = compiled->starts;
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
