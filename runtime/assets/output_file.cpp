#include "runtime/assets/output_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <string_view>

#include "runtime/assets/manifest.h"
#include "runtime/base/asset_path.h"
#include "runtime/base/file.h"
#include "runtime/base/paths.h"
#include "runtime/plan/format.h"
#include "runtime/base/folder_kind.h"

namespace probe::assets {
namespace {

namespace fs = std::filesystem;

// Kinds of files that people make and no verb writes.
bool is_only_read(const fs::path& path) {
  constexpr std::string_view kKinds[] = {".urdf", ".profile"};
  std::string kind = path.extension().string();
  for (char& c : kind) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::ranges::find(kKinds, kind) != std::end(kKinds) ||
         std::ranges::find(kMeshExtensions, kind) != kMeshExtensions.end();
}

bool is_plan(const std::string& path) {
  const auto head = read_file(path, {.most = plan::kMagic.size(), .only_begin = true});
  return head && std::ranges::equal(*head, plan::kMagic, [](char a, std::uint8_t b) {
           return static_cast<std::uint8_t>(a) == b;
         });
}

// Of a folder that has this database.
bool is_part_of_results(std::string_view name, const char* database) {
  return name.starts_with(database) || name == "suite.plan" || name == "lock" || name == "traces" ||
         name == "videos";
}

}  // namespace

Status check_output(const std::string& out, std::span<const std::string> inputs, Writes writes) {
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
  if (is_only_read(path) && is_there(path.string())) {
    return refuse("is no file that a verb writes and is not written over; give -o another name");
  }
  for (fs::path dir = path.parent_path(); dir.has_relative_path(); dir = dir.parent_path()) {
    const std::string below = path.lexically_relative(dir).generic_string();
    if (is_there((dir / "manifest.json").string()) && is_there(path.string())) {
      const auto manifest = assets::read_manifest(dir.string());
      if (manifest && (below == "manifest.json" || manifest->find(below) != nullptr)) {
        return refuse(
            fmt::format("belongs to the assets in `{}` and is not written over; give -o another "
                        "name",
                        dir.string()));
      }
    }
    for (const char* database : {probe::kRunDatabase, probe::kAnswersDatabase}) {
      if (!is_there(probe::path_in(dir.string(), database)) ||
          !is_part_of_results(below.substr(0, below.find('/')), database))
        continue;
      const bool is_run = database == probe::kRunDatabase;
      return refuse(
          fmt::format("belongs to the {} in `{}` and is not written over; give -o another name",
                      is_run ? "run" : "answers", dir.string()));
    }
  }
  if (writes != Writes::kPlan && is_plan(path.string())) {
    return refuse("is a plan and is not written over by anything else; give -o another name");
  }
  return {};
}

}  // namespace probe::assets
