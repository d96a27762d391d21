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
                             const std::string& suite, bool want_plan, bool json, bool chosen_only,
                             const PlanTaker& plans) {
  CompiledText text;
  auto compiled = compile::compile_files(files, {.assets = root_of(assets),
                                                 .library = assets.library,
                                                 .suite = suite,
                                                 .tasks = chosen_only ? assets.tasks : "",
                                                 .wants_plan = want_plan,
                                                 .plans = plans});
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
  text.chosen = std::move(compiled->chosen);
  text.own_suites = std::move(compiled->own_suites);
  text.asset_root = std::move(compiled->asset_root);
  text.tasks = compiled->tasks;
  text.starts = compiled->starts;
  return text;
}

void print_diagnostics(const CompiledText& text, bool json) {
  if (!json) return say_drawn(text.said);
  put("{}", text.said);
  std::fflush(stdout);
}

namespace {

void say_count(std::size_t warnings, const std::string& file) {
  if (warnings == 0) return;
  say("note: {} warning{}; `vlaprobe check {}` shows {}\n", warnings, warnings == 1 ? "" : "s", file,
      warnings == 1 ? "it" : "them");
}

}  // namespace

void say_briefly(const CompiledText& text, const std::string& file) {
  if (text.exit != kFine) return print_diagnostics(text, false);
  say_count(text.warnings, file);
}

void say_briefly(const Compilation& compilation, const std::string& file) {
  if (!compilation.ok) return say("{}", render_text(compilation.diagnostics, compilation.sources));
  say_count(compilation.diagnostics.size() - compilation.diagnostics.error_count(), file);
}

CompiledText compile_text(const std::vector<std::string>& files, const AssetOptions& assets,
                          const std::string& suite, bool want_plan, bool json, bool brief,
                          const PlanTaker& plans) {
  CompiledText text = compile_quietly(files, assets, suite, want_plan, json, false, plans);
  if (text.only_assets_missing && !assets.tasks.empty() && assets.tasks != "*") {
    if (plans.forget) plans.forget();
    CompiledText chosen = compile_quietly(files, assets, suite, want_plan, json, true, plans);
    if (chosen.exit == kFine) {
      say("note: the assets lack what other tasks need; compiled are only the tasks `{}`\n",
          assets.tasks);
    }
    text = std::move(chosen);
  }
  if (brief) {
    say_briefly(text, files.front());
  } else {
    print_diagnostics(text, json);
  }
  if (text.only_assets_missing) {
    say("note: --tasks GLOB takes only tasks that do not need these files\n");
  }
  return text;
}

}  // namespace probe::cli
