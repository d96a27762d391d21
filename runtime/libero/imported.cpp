#include "runtime/libero/imported.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "runtime/compile/files.h"
#include "runtime/libero/suites.h"

namespace probe::libero {

std::string Imported::text_of(std::string_view suite) const {
  return folder_ + "/" + std::string(suite) + ".probe";
}

Status Imported::check() const {
  std::error_code error;
  const bool is_import = std::ranges::any_of(suites(), [&](const Suite& suite) {
    return std::filesystem::is_regular_file(text_of(suite.folder), error);
  });
  if (is_import) return {};
  return Failure{Fault::kUsage,
                 fmt::format("is no folder that `libero import` made: it has no {}.probe, nor the "
                             "text of another suite",
                             suites().front().folder),
                 folder_};
}

Result<bool> Imported::has(std::string_view suite, std::string_view task) {
  std::error_code error;
  if (!std::filesystem::exists(text_of(suite), error)) return false;
  PROBE_ASSIGN(const plan::Plan* of, plan(suite));
  return of->find_task(task).has_value();
}

Result<const plan::Plan*> Imported::plan(std::string_view suite) {
  if (const auto known = plans_.find(suite); known != plans_.end()) return known->second.get();
  const std::string text = text_of(suite);
  std::error_code error;
  if (!std::filesystem::is_regular_file(text, error))
    return Failure{Fault::kUsage, "the import has no such suite", text};
  compile::FilesRequest request;
  request.assets = folder_;
  PROBE_ASSIGN(Compilation made, compile::compile_files({text}, request));
  if (!made.ok)
    return Failure{Fault::kUsage, "the suite does not compile, `vlaprobe check` says why", text};
  PROBE_ASSIGN(plan::Plan opened, plan::Plan::from_bytes(std::move(made.plan)));
  return plans_.emplace(suite, std::make_unique<plan::Plan>(std::move(opened))).first->second.get();
}

Result<std::uint32_t> Imported::find(const plan::Plan& plan, std::string_view suite,
                                     std::string_view task) const {
  if (const auto index = plan.find_task(task)) return *index;
  return Failure{Fault::kUsage, "the suite has no task `" + std::string(task) + "`",
                 text_of(suite)};
}

Result<std::shared_ptr<const stage::SharedAssets>> Imported::assets(std::string_view suite,
                                                                    std::string_view task) {
  PROBE_ASSIGN(const plan::Plan* of, plan(suite));
  PROBE_ASSIGN(const std::uint32_t index, find(*of, suite, task));
  const std::uint32_t tasks[] = {index};
  return stage::SharedAssets::load(*of, folder_, tasks);
}

Result<std::unique_ptr<stage::Stage>> Imported::stage(std::string_view suite, std::string_view task,
                                                      const stage::StageOptions& options) {
  PROBE_ASSIGN(const plan::Plan* of, plan(suite));
  PROBE_ASSIGN(const std::uint32_t index, find(*of, suite, task));
  PROBE_ASSIGN(const auto loaded, assets(suite, task));
  return stage::Stage::create(*of, index, loaded, options);
}

}  // namespace probe::libero
