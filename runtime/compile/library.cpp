#include "runtime/compile/library.h"

#include <cstdlib>
#include <filesystem>

#include "runtime/base/own_folder.h"

namespace probe::compile {
namespace {

namespace fs = std::filesystem;

bool holds_library(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder / "std", error);
}

// The folder itself for "std/..."; beside it, where there is one, for "suite/...".
std::vector<std::string> with_suite(const fs::path& folder) {
  std::vector<std::string> folders = {folder.lexically_normal().string()};
  const fs::path beside = (folder / "..").lexically_normal();
  std::error_code error;
  if (fs::is_directory(beside / "suite", error)) folders.push_back(beside.string());
  return folders;
}

// A place that somebody named is the only one looked at.
Result<std::vector<std::string>> only(std::string_view folder, const char* who) {
  if (holds_library(folder)) return with_suite(folder);
  return Failure{Fault::kUsage, std::string("the folder given by ") + who + " holds no std/",
                 std::string(folder)};
}

}  // namespace

Result<std::vector<std::string>> find_library_folders(std::string_view chosen) {
  if (!chosen.empty()) return only(chosen, "--std");
  if (const char* named = std::getenv("VLAPROBE_STD"); named != nullptr && *named != '\0') {
    return only(named, "VLAPROBE_STD");
  }
  for (const fs::path& place : own_places("dsl")) {
    if (holds_library(place)) return with_suite(place);
  }
  return std::vector<std::string>();
}

}  // namespace probe::compile
