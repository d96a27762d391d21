// A dataset while it is made: OUT.partial/dataset, which becomes OUT when it is whole and on the
// disk; beside it a mark, a lock, and finished demonstrations. What a killed export left is
// recognised: its files are begun anew, of the demonstrations that it had finished one that makes
// the same goes on with them. What others put there is never touched.
#pragma once

#include <optional>
#include <string>

#include "runtime/base/result.h"
#include "runtime/store/folder_lock.h"

namespace probe::dataset {

class PartialFolder {
 public:
  // Fails with kUsage when `out` is there and not an empty folder, or OUT.partial is not an
  // export's; with kStore when another export is writing it.
  // `making`: all that finished demonstrations depend on beside their traces; those of another export are
  // removed.
  static Result<PartialFolder> create(const std::string& out, const std::string& making);
  PartialFolder(PartialFolder&& other) noexcept = default;
  PartialFolder& operator=(PartialFolder&&) = delete;
  ~PartialFolder();  // removes what was not finished

  std::string path() const;      // where files are written now
  std::string finished() const;  // where finished demonstrations are kept
  // Gives the dataset its name. Fails with kIo.
  Status finish();

 private:
  PartialFolder(std::string out, std::string path, store::FolderLock lock)
      : out_(std::move(out)), path_(std::move(path)), lock_(std::move(lock)) {}
  std::string out_, path_;
  std::optional<store::FolderLock> lock_;
};

}  // namespace probe::dataset
