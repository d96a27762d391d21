#include "runtime/cli/compile.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "compiler/diag/json.h"
#include "compiler/diag/text.h"
#include "compiler/emit/compile.h"
#include "runtime/cli/library.h"
#include "runtime/run/assets.h"

namespace probe::cli {

CompiledText compile_quietly(const std::vector<std::string>& files, const AssetOptions& assets,
                             const std::string& suite, bool want_plan, bool json) {
  CompiledText text;
  auto root = run::find_asset_root(assets.root);
  if (!root) {
    text.exit = report(root.failure());
    return text;
  }
  auto library = find_library_folders(assets.library);
  if (!library) {
    text.exit = report(library.failure());
    return text;
  }
  const CompileOptions options{.asset_root = *root, .suite = suite, .library_folders = *library};
  auto compiled = want_plan ? build(files, options) : check(files, options);
  if (!compiled) {
    text.exit = report(compiled.failure());
    return text;
  }
  const Diagnostics& diagnostics = compiled->diagnostics;
  text.errors = diagnostics.error_count();
  text.warnings = diagnostics.size() - text.errors;
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
  return text;
}

void print_diagnostics(const CompiledText& text, bool json) {
  std::FILE* const stream = json ? stdout : stderr;
  fmt::print(stream, "{}", text.said);
  std::fflush(stream);
}

CompiledText compile_text(const std::vector<std::string>& files, const AssetOptions& assets,
                          const std::string& suite, bool want_plan, bool json) {
  CompiledText text = compile_quietly(files, assets, suite, want_plan, json);
  print_diagnostics(text, json);
  return text;
}

}  // namespace probe::cli
  text.unused_phrases = std::move(compiled->unused_phrases);
  text.own_suites = std::move(compiled->own_suites);
