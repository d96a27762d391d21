#include "runtime/export/dataset/partial_folder.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>

#include "runtime/base/file.h"
#include "runtime/base/paths.h"
#include "runtime/base/sha256.h"

namespace probe::dataset {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = ".vlaprobe-export";
constexpr const char* kDataset = "dataset";
constexpr const char* kLock = "lock";  // FolderLock's
constexpr const char* kFinished = "finished";

// Nothing but what is there before the mark is, or the mark before it has its name (PendingFile): a
// cut may leave that.
bool is_only_begun(const std::vector<std::string>& names) {
  return std::ranges::all_of(names, [](const std::string& name) {
    return name == kLock || (name.starts_with(std::string(kMark) + ".") && name.ends_with(".tmp"));
  });
}

// What a disk is mounted on: it can be neither removed nor replaced. No where that cannot be asked.
bool is_mount_point(const std::string& path) {
  struct statx about {};
  return ::statx(AT_FDCWD, path.c_str(), 0, STATX_TYPE, &about) == 0 &&
         (about.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
}

Status sync_folders(const std::string& root) {
  std::error_code error;
  for (auto at = fs::recursive_directory_iterator(root, error);
       !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
    if (at->is_directory()) PROBE_TRY(sync_folder(at->path().string()));
  }
  if (error) return Failure{Fault::kIo, "cannot be listed: " + error.message(), root};
  return sync_folder(root);
}

Status clear(const std::string& path, bool with_finished) {
  PROBE_ASSIGN(const auto names, list_folder(path));
  std::error_code error;
  for (const std::string& name : names) {
    if (name == kLock || name == kMark || (name == kFinished && !with_finished)) continue;
    fs::remove_all(fs::path(path) / name, error);
    if (error)
      return Failure{Fault::kIo, "cannot be removed: " + error.message(), path + "/" + name};
  }
  return {};
}

}  // namespace

Result<PartialFolder> PartialFolder::create(const std::string& out, const std::string& making) {
  std::string target = absolute_path(out);
  while (target.size() > 1 && target.ends_with('/')) target.pop_back();
  // An empty folder behind a link, as on a larger disk: the dataset goes there.
  std::error_code unresolved;
  if (is_link(target) && is_folder(target)) target = fs::canonical(target, unresolved).string();
  if (unresolved) return Failure{Fault::kUsage, "a link that leads nowhere", out};
  if (is_there(target) || is_link(target)) {
    const auto names = is_folder(target)
                           ? list_folder(target)
                           : Result<std::vector<std::string>>(Failure{Fault::kUsage, "", out});
    if (!names || !names->empty())
      return Failure{Fault::kUsage, "is there already; a dataset is written to a new folder", out};
    if (is_mount_point(target))
      return Failure{Fault::kUsage,
                     "is where a disk is mounted, which no dataset can take the place of; name a "
                     "folder in it",
                     out};
  }
  const std::string path = target + ".partial";
  if (is_there(path) || is_link(path)) {
    // Nobody who sent it has us write behind a link.
    const bool is_ours = !is_link(path) && is_file(path + "/" + kMark) &&
                         !is_link(path + "/" + kMark) && !is_link(path + "/" + kFinished);
    const auto names = is_folder(path)
                           ? list_folder(path)
                           : Result<std::vector<std::string>>(Failure{Fault::kUsage, "", path});
    if (!is_ours && !(names && is_only_begun(*names)))
      return Failure{Fault::kUsage, "is there and is not what an export left; move it away", path};
  }
  PROBE_TRY(make_folders(path));
  auto lock = store::FolderLock::take(path);
  if (!lock) return lock.failure();
  PartialFolder folder(target, path, std::move(*lock));  // from here on a failure removes it
  const std::string mark = path + "/" + kMark, now = to_hex(sha256(making));
  const auto before = read_file(mark);
  const bool goes_on = before.ok() && *before == now;
  PROBE_TRY(clear(path, !goes_on));
  if (!goes_on) {
    PROBE_TRY(write_file(mark, std::as_bytes(std::span(now))));
    PROBE_TRY(sync_folder(path));  // before anything else of it is on the disk
  }
  PROBE_TRY(make_folders(folder.path()));
  PROBE_TRY(make_folders(folder.finished()));
  return folder;
}

std::string PartialFolder::path() const { return path_ + "/" + kDataset; }

std::string PartialFolder::finished() const { return path_ + "/" + kFinished; }

PartialFolder::~PartialFolder() {
  if (!lock_ || path_.empty()) return;
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

Status PartialFolder::finish() {
  PROBE_TRY(sync_folders(path()));
  std::error_code error;
  fs::remove(out_, error);  // an empty folder of that name
  fs::rename(path(), out_, error);
  if (error) return {Failure{Fault::kIo, "cannot be given its name: " + error.message(), out_}};
  const fs::path parent = fs::path(out_).parent_path();
  PROBE_TRY(sync_folder(parent.empty() ? "." : parent.string()));
  fs::remove_all(path_, error);  // the mark, the lock and what had been finished
  path_.clear();
  return {};
}

}  // namespace probe::dataset
