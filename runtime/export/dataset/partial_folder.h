// A dataset's folder while it is made: OUT.partial, which gets its name when it is whole. What a
// killed export left is recognised and begun anew; what others put there is never touched.
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
  static Result<PartialFolder> create(const std::string& out);
  PartialFolder(PartialFolder&& other) noexcept = default;
  PartialFolder& operator=(PartialFolder&&) = delete;
  ~PartialFolder();  // removes what was not finished

  const std::string& path() const { return path_; }  // where files are written now
  // Gives the folder its name. Fails with kIo.
  Status finish();

 private:
  PartialFolder(std::string out, std::string path, store::FolderLock lock)
      : out_(std::move(out)), path_(std::move(path)), lock_(std::move(lock)) {}
  std::string out_, path_;
  std::optional<store::FolderLock> lock_;
};

}  // namespace probe::dataset
