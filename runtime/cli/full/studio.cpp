// vlaprobe studio
#include <fmt/format.h>

#include <cstdio>

#include "runtime/base/say.h"
#include "runtime/cli/full/until_ended.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/studio/studio.h"

namespace probe::cli {
namespace {

int studio_verb(const studio::StudioOptions& options) {
  const EndSignals ends;
  const auto served = studio::Studio::start(options);
  if (!served) return report(served.failure());
  put("{}\n", (*served)->address());
  std::fflush(stdout);
  say("open this address in a browser of this machine; it ends with Ctrl+C\n");
  ends.wait();
  return kFine;
}

}  // namespace

void add_studio(Verb app, int& exit) {
  auto options = std::make_shared<studio::StudioOptions>();
  auto assets = std::make_shared<AssetOptions>();
  Verb verb = app.add_subcommand(
      "studio", "write a task and see it: text, starts, picture and verdict on a page");
  verb.footer(
      "a page on 127.0.0.1 for whoever has its address, of the texts in F's folder alone\n"
      "example: vlaprobe studio my.probe");
  verb.add_option("F", options->file, ".probe text, which need not be there yet").required();
  verb.add_option("--port", options->port, "to listen at; 0: any free one");
  add_asset_option(verb, *assets);
  verb.refuse_empty_values();
  verb.callback([options, assets, &exit] {
    options->assets = root_of(*assets);
    options->library = assets->library;
    exit = studio_verb(*options);
  });
}

}  // namespace probe::cli
