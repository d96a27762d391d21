// vlaprobe lsp
#include <unistd.h>

#include "runtime/cli/verbs.h"
#include "runtime/lsp/stdio.h"

namespace probe::cli {

void add_lsp(Verb app, int& exit) {
  auto assets = std::make_shared<AssetOptions>();
  Verb verb = app.add_subcommand("lsp", "answer an editor: the language server on stdin and stdout");
  verb.footer("example: vim.lsp.start({ cmd = { 'vlaprobe', 'lsp' } }); dsl/editor has the set-ups");
  add_asset_option(verb, *assets);
  // What editors say of themselves; there is no other way to talk.
  auto by_stdio = std::make_shared<bool>(true);
  verb.add_flag("--stdio", *by_stdio, "as without it");
  verb.callback([assets, by_stdio, &exit] {
    const auto code = lsp::serve(STDIN_FILENO, STDOUT_FILENO,
                                 {.assets = root_of(*assets), .library = assets->library});
    exit = code ? *code : report(code.failure());
  });
}

}  // namespace probe::cli
