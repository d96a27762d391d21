// vlaprobe gate
#include "runtime/report/gate.h"

#include <span>

#include "runtime/assets/output_file.h"
#include "runtime/base/file.h"
#include "runtime/base/put_words.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/share.h"
#include "runtime/cli/full/verbs.h"

namespace probe::cli {
namespace {

struct GateArguments {
  std::string now, before, allow = "0%", error = "5%", junit, markdown;
  report::GateOptions options;
  bool json = false, decided = false;
};

Status write_text(const std::string& path, const std::string& text) {
  return write_file(path, std::as_bytes(std::span(text)));
}

Result<report::Gate> measured(GateArguments& arguments) {
  PROBE_ASSIGN(arguments.options.allow, read_share("--allow", arguments.allow));
  PROBE_ASSIGN(arguments.options.error, read_share("--error", arguments.error));
  for (const std::string& out : {arguments.junit, arguments.markdown})
    PROBE_TRY(assets::check_output(out, {}));
  PROBE_ASSIGN(report::Gate gate,
               report::gate_folders(arguments.now, arguments.before, arguments.options));
  if (!arguments.junit.empty()) PROBE_TRY(write_text(arguments.junit, to_junit(gate)));
  if (!arguments.markdown.empty()) PROBE_TRY(write_text(arguments.markdown, to_markdown(gate)));
  return gate;
}

int gate_verb(GateArguments& arguments) {
  const auto gate = measured(arguments);
  if (!gate) {
    // 1 is for a drop alone.
    report(gate.failure());
    return kOutside;
  }
  if (arguments.json) {
    put("{}\n", to_json(*gate).dump(1));
  } else {
    put_words("{}", to_text(*gate));
  }
  if (gate->is_worse() || (arguments.decided && !gate->is_decided())) return kUser;
  return gate->unborne == 0 ? kFine : kOutside;
}

}  // namespace

void add_gate(Verb app, int& exit) {
  auto arguments = std::make_shared<GateArguments>();
  Verb verb = app.add_subcommand(
      "gate", "may this run's policy take the place of that one's: exit 1 only for a drop that the "
              "data show, 2 where nothing can be said");
  verb.footer(
      "exit 2 as well where rows were left out, because their traces do not show them\n"
      "example: vlaprobe gate runs/new --against runs/old --allow 2% --junit gate.xml");
  verb.add_option("NEW", arguments->now, "results folder").required();
  verb.add_option("--against", arguments->before, "results folder").required();
  verb.add_option("--allow", arguments->allow, "how many more episodes may fail (default: 0%)");
  verb.add_option("--metric", arguments->options.metric, "what is held to it (default: success)");
  verb.add_option("--error", arguments->error,
                  "chance of calling an allowed drop too large (default: 5%)");
  verb.add_flag("--categories", arguments->options.categories, "each of them is held to it, too");
  verb.add_option("--sets", arguments->options.sets,
                  "A,B,...: sets of the plan that are the categories")
      .delimiter(',');
  verb.add_flag("--decided", arguments->decided,
                "exit 1 as well where the data do not show that it is no more");
  verb.add_option("--junit", arguments->junit, "JUnit XML file to write");
  verb.add_option("--markdown", arguments->markdown, "Markdown file to write");
  verb.add_flag("--json", arguments->json, "the numbers as a JSON object");
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = gate_verb(*arguments); });
}

}  // namespace probe::cli
