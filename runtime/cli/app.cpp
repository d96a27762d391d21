#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <span>
#include <system_error>

#include "compiler/diag/diagnostic.h"
#include "runtime/cli/verbs.h"

namespace probe::cli {
namespace {

constexpr char kExample[] =
    "example: vlaprobe run suite/intact.probe --policy expert -o runs/first\n"
    "exit codes: 0 fine, 1 your text or arguments, 2 files, network or policy, 3 our mistake";

// CLI11 says "was not expected" for an unknown word; people want to know which word was meant.
int report_unknown(const CLI::App& app, const CLI::ParseError& error, std::span<char*> words) {
  const CLI::App* verb = &app;
  for (const CLI::App* chosen : app.get_subcommands()) verb = chosen;
  std::vector<std::string> names;
  for (const CLI::Option* option : verb->get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  const std::vector<std::string_view> known(names.begin(), names.end());
  fmt::print(stderr, "vlaprobe: {}\n", error.what());
  for (const char* word : words) {
    const std::string flag(word, std::strcspn(word, "="));
    if (flag.rfind("--", 0) != 0 || std::find(known.begin(), known.end(), flag) != known.end())
      continue;
    const auto close = nearest(flag, known);
    if (close) fmt::print(stderr, "  did you mean `{}`?\n", *close);
  }
  fmt::print(stderr, "  `vlaprobe {}--help` lists what it takes\n",
             verb == &app ? "" : verb->get_name() + " ");
  return kUser;
}

}  // namespace

int report(const Failure& failure) {
  fmt::print(stderr, "vlaprobe: {}\n", to_text(failure));
  if (failure.code == Fault::kUsage) return kUser;
  return failure.code == Fault::kInternal ? kOurs : kOutside;
}

void add_asset_option(CLI::App& verb, AssetOptions& options) {
  verb.add_option("--assets", options.root,
                  "asset folder (default: $VLAPROBE_ASSETS, then the one beside the program)");
  verb.add_option("--std", options.library,
                  "folder that holds std/ (default: $VLAPROBE_STD, then dsl beside the program)");
}

int main(int argc, char** argv) {
  CLI::App app("vlaprobe: probing tasks for vision-language-action policies, compiled and judged");
  app.footer(kExample);
  app.require_subcommand(0, 1);
  app.set_version_flag("--version", VLAPROBE_VERSION);
  app.get_formatter()->column_width(28);

  int exit = kFine;
  add_check(app, exit);
  add_build(app, exit);
  add_fmt(app, exit);
  add_list(app, exit);
  add_show(app, exit);
  add_diff(app, exit);
  add_audit(app, exit);
  add_coverage(app, exit);
  add_graph(app, exit);
  add_draw(app, exit);
  add_explain(app, exit);
  add_dis(app, exit);
  add_verify(app, exit);
  add_preview(app, exit);
  add_sheet(app, exit);
  add_run(app, exit);
  add_sweep(app, exit);
  add_merge(app, exit);
  add_slurm(app, exit);
  add_policy(app, exit);
  add_results(app, exit);
  add_replay(app, exit);
  add_judge(app, exit);
  add_why(app, exit);
  add_report(app, exit);
  add_compare(app, exit);
  add_export(app, exit);
  add_assets(app, exit);
  add_doctor(app, exit);

  if (argc > 1 && argv[1][0] != '-') {
    std::vector<std::string> names;
    for (const CLI::App* verb : app.get_subcommands({})) names.push_back(verb->get_name());
    const std::vector<std::string_view> verbs(names.begin(), names.end());
    if (std::find(verbs.begin(), verbs.end(), argv[1]) == verbs.end()) {
      const auto close = nearest(argv[1], verbs);
      fmt::print(stderr, "vlaprobe: unknown verb `{}`{}\n", argv[1],
                 close ? fmt::format(", did you mean `{}`?", *close) : "");
      fmt::print(stderr, "  `vlaprobe --help` lists the verbs\n");
      return kUser;
    }
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    return report_unknown(app, error, std::span(argv + 1, static_cast<std::size_t>(argc - 1)));
  } catch (const std::system_error& error) {  // fmt, when a stream takes no more
    return report({Fault::kIo, error.what(), "standard output"});
  } catch (const std::exception& error) {
    return report({Fault::kInternal, error.what(), ""});
  }
  // A full disk behind a redirection shows only now.
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    return report({Fault::kIo, "cannot be written", "standard output"});
  }
  if (app.get_subcommands().empty()) {
    fmt::print("{}", app.help());
    return kUser;
  }
  return exit;
}

}  // namespace probe::cli
