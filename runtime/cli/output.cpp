#include "runtime/cli/output.h"

#include <fmt/format.h>

#include <filesystem>

#include "runtime/base/paths.h"

namespace probe::cli {
namespace {

namespace fs = std::filesystem;

bool is_part_of_a_run(std::string_view name) {
  return name.starts_with("results.sqlite") || name == "suite.plan" || name == "lock" ||
         name == "traces" || name == "videos";
}

}  // namespace

Status check_output(const std::string& out, std::span<const std::string> inputs) {
  if (out.empty()) return {};
  const auto refuse = [&](std::string why) { return Failure{Fault::kUsage, std::move(why), out}; };
  for (const std::string& input : inputs) {
    if (out == input || is_same(out, input)) {
      return refuse("is read by this command and is not written over; give -o another name");
    }
  }
  std::error_code error;
  const fs::path path = fs::weakly_canonical(absolute_path(out), error);
  if (error) return {};  // writing will say what is wrong
  if (path.extension() == ".probe" && is_there(path.string())) {
    return refuse("is Probe text and is not written over; give -o another name");
  }
  for (fs::path dir = path.parent_path(); dir.has_relative_path(); dir = dir.parent_path()) {
    if (!is_there((dir / "results.sqlite").string())) continue;
    if (is_part_of_a_run(path.lexically_relative(dir).begin()->string())) {
      return refuse(
          fmt::format("belongs to the run in `{}` and is not written over; give -o another name",
                      dir.string()));
    }
  }
  return {};
}

}  // namespace probe::cli
