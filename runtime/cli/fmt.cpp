// vlaprobe fmt
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <span>

#include "compiler/diag/text.h"
#include "compiler/format/format.h"
#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/base/say.h"
#include "runtime/cli/verbs.h"

namespace probe::cli {
namespace {

namespace fs = std::filesystem;

// In place at once: through a link to the file itself, with the permissions it had.
Status rewrite(const std::string& path, const std::string& text) {
  std::error_code error;
  const fs::path real = fs::canonical(path, error);
  const std::string target = error ? path : real.string();
  const fs::perms permissions = fs::status(target, error).permissions();
  PROBE_TRY(write_file(target, std::as_bytes(std::span(text))));
  if (!error) fs::permissions(target, permissions, error);
  return {};
}

struct Tally {
  std::vector<std::string> changed;
};

// The exit code for this file.
int format_one(const std::string& path, bool check, Tally& tally) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto id = sources.load(path);
  if (!id) return report(id.failure());
  const auto text = format::format_file(sources, *id, diagnostics);
  if (!text) return report(text.failure());
  if (!text->has_value()) {
    const bool colour = isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr;
    say_drawn(render_text(diagnostics, sources, {.colour = colour}));
    return kUser;
  }
  if (**text == sources.file(*id).text()) return kFine;
  tally.changed.push_back(path);
  if (check) return kUser;
  const Status written = rewrite(path, **text);
  return written ? kFine : report(written.failure());
}

}  // namespace

void add_fmt(Verb app, int& exit) {
  struct FmtArguments {
    std::vector<std::string> files;
    bool check = false, json = false;
  };
  auto arguments = std::make_shared<FmtArguments>();
  Verb verb = app.add_subcommand("fmt", "canonical layout, in place");
  verb.footer(
      "prints the files that it changes; a file with syntax errors is left alone\n"
      "example: vlaprobe fmt suite/*.probe");
  verb.add_option("F", arguments->files, ".probe texts").required();
  verb.add_flag("--check", arguments->check, "write nothing; exit 1 if a file would change");
  verb.add_flag("--json", arguments->json, "those files as a JSON array");
  verb.callback([arguments, &exit] {
    Tally tally;
    for (const std::string& file : arguments->files) {
      exit = std::max(exit, format_one(file, arguments->check, tally));
    }
    if (arguments->json) {
      put("{}\n", Json(tally.changed).dump());
      return;
    }
    for (const std::string& file : tally.changed) put("{}\n", file);
    if (!tally.changed.empty()) {
      say("{} of {} files {}\n", tally.changed.size(), arguments->files.size(),
          arguments->check ? "not in canonical layout" : "laid out anew");
    }
  });
}

}  // namespace probe::cli
