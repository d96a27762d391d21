#include "runtime/compile/grafted.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "runtime/base/asset_root.h"
#include "runtime/compile/library.h"

namespace probe::compile {
namespace {

namespace fs = std::filesystem;

// As it is named, else below one of the library's folders.
std::string find_text(const std::string& path, const std::vector<std::string>& folders) {
  std::error_code error;
  if (fs::exists(path, error)) return path;
  for (const std::string& folder : folders) {
    const fs::path inside = fs::path(folder) / path;
    if (fs::exists(inside, error)) return inside.lexically_normal().string();
  }
  return path;
}

}  // namespace

std::optional<AnalyzedText> metrics_text(const std::string& path, const AssetRoot& assets,
                                         const std::string& library) {
  if (!path.ends_with(".probe")) return std::nullopt;
  const auto folders = find_library_folders(library);
  if (!folders) return std::nullopt;
  const auto root = find_asset_root(assets);  // of metrics alone no asset is read
  const std::string file = find_text(path, *folders);
  auto text = analyze_text(std::span(&file, 1), {.asset_root = root ? *root : AssetRoot(),
                                                 .library_folders = *folders});
  if (!text || !text->compilation.ok || !is_metrics_alone(*text)) return std::nullopt;
  return std::move(text).value();
}

Result<GraftedPlan> graft(const plan::Plan& stored, AnalyzedText text) {
  rejudge::EventMetrics metrics;
  for (DeclaredMetrics& set : declared_metrics(text)) {
    auto& names = set.name == "progress" ? metrics.subgoals : metrics.events;
    for (std::string& name : set.metrics) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
    }
  }
  PROBE_ASSIGN(Grafted grafted, graft_metrics(stored, std::move(text)));
  PROBE_ASSIGN(plan::Plan plan, plan::Plan::from_bytes(std::move(grafted.plan)));
  return GraftedPlan{std::move(plan), std::move(metrics), std::move(grafted.left_out)};
}

std::vector<MetricLeftOut> of_tasks(std::vector<MetricLeftOut> left_out,
                                    const std::set<std::string>& tasks) {
  for (MetricLeftOut& out : left_out)
    std::erase_if(out.tasks, [&](const auto& task) { return !tasks.contains(task.name); });
  std::erase_if(left_out, [](const MetricLeftOut& out) { return out.tasks.empty(); });
  return left_out;
}

std::string to_text(const MetricLeftOut& out) {
  const MetricLeftOut::Task& first = out.tasks.front();
  return out.tasks.size() == 1
             ? fmt::format("metric `{}` is left out of {}: {}", out.metric, first.name, first.why)
             : fmt::format("metric `{}` is left out of {} tasks, such as {}: {}", out.metric,
                           out.tasks.size(), first.name, first.why);
}

}  // namespace probe::compile
