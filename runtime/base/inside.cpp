#include "runtime/base/inside.h"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "runtime/base/io_failure.h"
#include "runtime/base/paths.h"

namespace probe {
namespace {

namespace fs = std::filesystem;

}  // namespace

Status check_inside(const std::string& folder, const std::string& below) {
  fs::path place(folder);
  for (const fs::path& part : fs::path(below)) {
    place /= part;
    if (!is_link(place.string())) continue;
    return Failure{Fault::kIo,
                   "is a link: what is written here would land in another folder; put the folder "
                   "or file itself in its place",
                   place.string()};
  }
  return {};
}

Result<std::string> file_inside(const std::string& folder, const std::string& below) {
  PROBE_TRY(check_inside(folder, fs::path(below).parent_path().string()));
  const std::string file = (fs::path(folder) / below).string();
  if (is_link(file) && std::remove(file.c_str()) != 0)
    return io_failure("is a link and cannot be removed", errno, file);
  return file;
}

Status check_all_inside(const std::string& folder, const std::string& below) {
  PROBE_TRY(check_inside(folder, below));
  const std::string whole = (fs::path(folder) / below).string();
  const auto names = list_folder(whole);
  for (const std::string& name : names ? *names : std::vector<std::string>{})
    PROBE_TRY(check_inside(whole, name));
  return {};
}

}  // namespace probe
