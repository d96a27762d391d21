#include "runtime/base/paths.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "runtime/base/io_failure.h"

namespace probe {
namespace {

namespace fs = std::filesystem;

bool has_type(const std::string& path, fs::file_type type) {
  std::error_code error;
  return fs::status(path, error).type() == type;
}

}  // namespace

bool is_there(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error) && !error;
}

bool is_file(const std::string& path) { return has_type(path, fs::file_type::regular); }

bool is_folder(const std::string& path) { return has_type(path, fs::file_type::directory); }

bool is_link(const std::string& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() == fs::file_type::symlink;
}

bool is_same(const std::string& a, const std::string& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) && !error;
}

std::string absolute_path(const std::string& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  return (error ? fs::path(path) : absolute).lexically_normal().string();
}

Result<std::vector<std::string>> list_folder(const std::string& path) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator at(path, error), end; !error && at != end; at.increment(error)) {
    names.push_back(at->path().filename().string());
  }
  if (error) return io_failure("cannot be listed", error.value(), path);
  std::sort(names.begin(), names.end());
  return names;
}

Status make_folders(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) return io_failure("the folder cannot be made", error.value(), path);
  return {};
}

Status sync_folder(const std::string& path) {
  const int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return io_failure("the folder cannot be opened", errno, path);
  const int error = ::fsync(folder) == 0 ? 0 : errno;
  ::close(folder);
  // Some file systems (a few of FUSE) cannot be asked, and then there is nothing to wait for.
  if (error == 0 || error == EINVAL || error == ENOTSUP) return {};
  return io_failure("the folder cannot be forced to the disk", error, path);
}

Status make_lasting_folders(const std::string& path) {
  const fs::path whole = fs::path(absolute_path(path));
  std::vector<fs::path> missing;
  for (fs::path at = whole; !is_folder(at.string()) && at.has_relative_path();
       at = at.parent_path()) {
    missing.push_back(at);
  }
  PROBE_TRY(make_folders(whole.string()));
  for (const fs::path& made : missing) PROBE_TRY(sync_folder(made.parent_path().string()));
  return {};
}

}  // namespace probe
