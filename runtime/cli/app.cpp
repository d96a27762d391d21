#include "runtime/cli/app.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <system_error>

#include "compiler/diag/diagnostic.h"
#include "runtime/base/large.h"
#include "runtime/base/say.h"

namespace probe::cli {
namespace {

constexpr char kAbout[] =
    "vlaprobe: probing tasks for vision-language-action policies, compiled and judged";
constexpr char kExample[] =
    "example: vlaprobe run suite/intact.probe --policy expert -o runs/first\n"
    "for the first time: vlaprobe demo shows a task, its episodes, a video and a report in ten seconds\n"
    "exit codes: 0 fine, 1 your text or arguments, 2 files, network or policy, 3 our mistake";

}  // namespace

const char* version() { return VLAPROBE_VERSION; }

int report(const Failure& failure) {
  say("vlaprobe: {}\n", to_text(failure));
  if (failure.code == Fault::kUsage) return kUser;
  return failure.code == Fault::kInternal ? kOurs : kOutside;
}

void add_asset_option(Verb verb, AssetOptions& options, bool is_in_help) {
  const auto about = [&](const char* said) { return is_in_help ? said : ""; };
  verb.add_option("--assets", options.folders,
                  about("asset folder, and again for the next (default: beside F, then "
                        "$VLAPROBE_ASSETS or the program's)"))
      .no_extra_values();
  verb.add_option("--std", options.library,
                  about("folder that holds std/ (default: $VLAPROBE_STD, then dsl beside the "
                        "program)"));
}

AssetRoot root_of(const AssetOptions& options) { return AssetRoot::chosen(options.folders); }

void add_text_verbs(Verb program, int& exit, PhraseDrawing draw_phrases) {
  add_check(program, exit);
  add_build(program, exit);
  add_fmt(program, exit);
  add_list(program, exit);
  add_lsp(program, exit);
  add_show(program, exit);
  add_diff(program, exit);
  add_audit(program, exit);
  add_coverage(program, exit);
  add_graph(program, exit);
  add_draw(program, exit, draw_phrases);
  add_rephrase(program, exit);
  add_explain(program, exit);
  add_dis(program, exit);
  add_verify(program, exit);
}

int run_program(int argc, char** argv, AddVerbs add_verbs, bool is_whole) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an answer of write()
  CommandLine line(kAbout, kExample, version());
  line.program().add_flag("--allow-large", allow_large,
                          "files of others may be larger and take longer to read");
  int exit = kFine;
  add_verbs(line.program(), exit);

  const std::vector<std::string> names = line.verbs();
  const std::vector<std::string_view> verbs(names.begin(), names.end());
  const bool knows = argc > 1 && std::find(verbs.begin(), verbs.end(), argv[1]) != verbs.end();
  if (!knows && !is_whole) return kHandOver;
  if (!knows && argc > 1 && argv[1][0] != '-') {
    const auto close = nearest(argv[1], verbs);
    say("vlaprobe: unknown verb `{}`{}\n", argv[1],
        close ? fmt::format(", did you mean `{}`?", *close) : "");
    say("  `vlaprobe --help` lists the verbs\n");
    return kUser;
  }
  ParsedLine parsed;
  try {
    parsed = line.parse(argc, argv);
  } catch (const std::system_error& error) {  // fmt, when a stream takes no more
    return report({Fault::kIo, error.what(), "standard output"});
  } catch (const std::exception& error) {
    return report({Fault::kInternal, error.what(), ""});
  }
  if (parsed.finished) return parsed.exit;
  // A full disk behind a redirection shows only now.
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    return report({Fault::kIo, "cannot be written", "standard output"});
  }
  if (!parsed.has_verb) {
    put("{}", line.help());
    return kUser;
  }
  return exit;
}

}  // namespace probe::cli
