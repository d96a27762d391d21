// A file that is written from its beginning to its end, and then is on the disk.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "runtime/base/result.h"

namespace probe {

// All of it fails with kIo, where = path.
class FileStream {
 public:
  // Makes the file, or empties the one that is there.
  static Result<FileStream> create(const std::string& path);
  FileStream(FileStream&& from) noexcept;
  FileStream& operator=(FileStream&&) = delete;
  ~FileStream();

  Status write(std::string_view bytes);
  // Closes the file; its bytes are then on the disk.
  Status finish();

 private:
  FileStream(std::FILE* file, std::string path) : file_(file), path_(std::move(path)) {}

  std::FILE* file_;  // null behind finish()
  std::string path_;
};

}  // namespace probe
