// vlaprobe mcp
#include <unistd.h>

#include <csignal>

#include "runtime/base/own_folder.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/mcp/server.h"

namespace probe::cli {

void add_mcp(Verb app, int& exit) {
  Verb verb = app.add_subcommand(
      "mcp", "tools for coding agents over stdin and stdout (Model Context Protocol)");
  verb.footer(
      "check, explain, list, show, draw, preview, run, results, why, compare, gate\n"
      "example: claude mcp add vlaprobe -- vlaprobe mcp");
  verb.callback([&exit] {
    std::signal(SIGPIPE, SIG_IGN);
    const auto tools = mcp::Tools::make((folder_of_program() / "vlaprobe").string());
    mcp::serve(STDIN_FILENO, STDOUT_FILENO, *tools);
    exit = kFine;
  });
}

}  // namespace probe::cli
