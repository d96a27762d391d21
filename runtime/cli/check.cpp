// vlaprobe check
#include <fmt/format.h>

#include "runtime/cli/compile.h"

namespace probe::cli {

void add_check(CLI::App& app, int& exit) {
  struct Arguments {
    std::vector<std::string> files;
    bool json = false;
    AssetOptions assets;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = app.add_subcommand("check", "diagnose sources");
  verb->footer("example: vlaprobe check suite/intact.probe");
  verb->add_option("F", arguments->files, ".probe texts")->required();
  verb->add_flag("--json", arguments->json, "diagnostics as a JSON array on stdout");
  add_asset_option(*verb, arguments->assets);
  verb->callback([arguments, &exit] {
    const CompiledText text =
        compile_text(arguments->files, arguments->assets, "", false, arguments->json);
    exit = text.exit;
    if (text.errors + text.warnings > 0) {
      fmt::print(stderr, "{} errors, {} warnings\n", text.errors, text.warnings);
    }
  });
}

}  // namespace probe::cli
