// vlaprobe audit
#include "compiler/audit/audit.h"

#include <fmt/format.h>

#include "compiler/audit/table.h"
#include "compiler/diag/text.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/file.h"
#include "runtime/base/say.h"
#include "runtime/compile/library.h"
#include "runtime/cli/load.h"

namespace probe::cli {
namespace {

struct AuditArguments {
  std::string file, suite, table;
  bool json = false;
  AssetOptions assets;
};

int audit_verb(const AuditArguments& arguments) {
  const auto root = find_asset_root(root_of(arguments.assets));
  if (!root) return report(root.failure());
  const auto library = compile::find_library_folders(arguments.assets.library);
  if (!library) return report(library.failure());
  const std::span<const std::string> files(&arguments.file, 1);
  auto compiled = build(
      files, {.asset_root = *root, .library_folders = *library, .wants_unheld = true});
  if (!compiled) return report(compiled.failure());
  if (!compiled->ok) {
    say("{}", render_text(compiled->diagnostics, compiled->sources));
    return kUser;
  }
  auto plan = plan::Plan::from_bytes(std::move(compiled->plan));
  if (!plan) return report(plan.failure());
  if (plan->suites().empty())
    return report({Fault::kUsage, "no suite to audit: `suite` lists tasks", arguments.file});
  int exit = kFine;
  std::uint32_t suite = 0;
  if (!arguments.suite.empty()) {
    const auto found = find_suite(*plan, arguments.suite, exit);
    if (!found) return exit;
    suite = *found;
  }
  auto audited = audit::audit(*compiled, *plan, suite, files);
  if (!audited) return report(audited.failure());
  if (!arguments.table.empty()) {
    const auto text = read_file(arguments.table);
    if (!text) return report(text.failure());
    const auto checked =
        audit::check_table(*audited, *compiled, *plan, suite, *text, arguments.table);
    if (!checked) return report(checked.failure());
  }
  put("{}", arguments.json ? audit::to_json(*audited) : audit::to_text(*audited));
  return kFine;
}

}  // namespace

void add_audit(Verb app, int& exit) {
  auto arguments = std::make_shared<AuditArguments>();
  Verb verb = app.add_subcommand("audit", "what is irregular in a suite, allowed or not");
  verb.add_option("F", arguments->file, ".probe text").required();
  verb.add_option("--suite", arguments->suite, "which suite (default: the first of the file)");
  verb.add_option("--table", arguments->table,
                  "CSV of published percentages, a column a set: can they be averages over it?");
  verb.add_flag("--json", arguments->json, "as a JSON object");
  add_asset_option(verb, arguments->assets);
  verb.footer("example: vlaprobe audit suite/intact.probe");
  verb.callback([arguments, &exit] { exit = audit_verb(*arguments); });
}

}  // namespace probe::cli
