#include "runtime/cli/load.h"

#include <fmt/format.h>

#include "compiler/diag/diagnostic.h"
#include "runtime/assets/output_file.h"
#include "runtime/base/asset_root.h"
#include "runtime/cli/compile.h"
#include "runtime/compile/files.h"
#include "runtime/inspect/task_json.h"
#include "runtime/plan/asset_files.h"

namespace probe::cli {
namespace {

void report_unknown(const char* kind, const std::string& name,
                    const std::vector<std::string_view>& known, int& exit) {
  const auto close = nearest(name, known);
  exit = report({Fault::kUsage,
                 fmt::format("no {} `{}` here{}", kind, name,
                             close ? fmt::format(", did you mean `{}`?", *close) : ""),
                 ""});
}

// Abstract tasks are no part of a plan, but the texts that it was made from are.
bool is_abstract(const plan::Plan& plan, const std::string& name) {
  const std::string head = "abstract task " + name;
  for (const plan::TextRecord& record : plan.texts()) {
    const std::string_view text = plan.tables().source(record);
    for (std::size_t at = text.find(head); at != std::string_view::npos;
         at = text.find(head, at + 1)) {
      const char after = at + head.size() < text.size() ? text[at + head.size()] : ' ';
      if (after == ' ' || after == '{' || after == '\n') return true;
    }
  }
  return false;
}

}  // namespace

LoadedPlan load_plan(const std::string& path, const AssetOptions& assets,
                     const std::string& suite) {
  LoadedPlan loaded;
  Result<plan::Plan> plan = Failure{};
  if (path.ends_with(".probe")) {
    CompiledText text = compile_text({path}, assets, suite, true, false, true);
    if (text.exit != kFine) {
      loaded.exit = text.exit;
      return loaded;
    }
    plan = plan::Plan::from_bytes(std::move(text.plan));
    loaded.is_text = true;
    loaded.files = std::move(text.files);
    if (plan) loaded.assets = compile::root_for(*plan, text.asset_root);
    loaded.unused_phrases = std::move(text.unused_phrases);
    loaded.referring = std::move(text.referring);
    loaded.only_used_suites = plan && !plan->suites().empty() && text.own_suites.empty();
  } else {
    plan = plan::Plan::open(path);
    loaded.files = {path};
    if (plan) loaded.assets = compile::root_for_file(*plan, path, root_of(assets));
  }
  if (!plan) {
    loaded.exit = report(plan.failure());
    return loaded;
  }
  loaded.plan = std::move(plan).value();
  return loaded;
}

Status check_output(const std::string& out, const LoadedPlan& loaded) {
  std::vector<std::string> inputs = loaded.files;
  if (const auto root = find_asset_root(loaded.assets); root && loaded.plan) {
    for (std::string& file : plan::asset_files(*loaded.plan, *root))
      inputs.push_back(std::move(file));
  }
  return assets::check_output(out, inputs);
}

std::optional<std::uint32_t> find_task(const plan::Plan& plan, const std::string& name, int& exit) {
  const auto index = plan.find_task(name);
  if (index) return index;
  if (is_abstract(plan, name)) {
    exit = report({Fault::kUsage,
                   "task `" + name + "` is abstract: it is copied with `like` and has no episodes",
                   ""});
    return std::nullopt;
  }
  std::vector<std::string_view> known;
  for (const plan::TaskRecord& task : plan.tasks()) known.push_back(plan.text(task.name));
  report_unknown("task", name, known, exit);
  return std::nullopt;
}

std::optional<std::uint32_t> find_suite(const plan::Plan& plan, const std::string& name,
                                        int& exit) {
  const auto index = plan.find_suite(name);
  if (index) return index;
  std::vector<std::string_view> known;
  for (const plan::SuiteRecord& suite : plan.suites()) known.push_back(plan.text(suite.name));
  report_unknown("suite", name, known, exit);
  return std::nullopt;
}

std::optional<std::vector<std::uint32_t>> select_tasks(const plan::Plan& plan,
                                                       const std::string& suite, int& exit) {
  if (suite.empty()) return inspect::all_tasks(plan);
  const auto index = find_suite(plan, suite, exit);
  if (!index) return std::nullopt;
  return inspect::members(plan, *index);
}

}  // namespace probe::cli
