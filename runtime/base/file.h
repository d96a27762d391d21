// Files that are whole or absent: written beside their place under another name, forced to the disk
// and renamed. Bytes of whole files in memory.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "runtime/base/result.h"

namespace probe {

// A file in the making, in place of what a symbolic link at `path` points to. Whoever writes does
// so at temporary(); keep() puts the file into its place, and without it nothing is left.
class PendingFile {
 public:
  // `path` with a suffix that ends in ".tmp": in the same folder, so that renaming is one step.
  explicit PendingFile(std::string path);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::string& path() const { return path_; }
  const std::string& temporary() const { return temporary_; }

  // After the last byte was written and the file closed. Fails (kIo, where = path); the file
  // is then gone. What is no regular file (a device, a pipe, a folder) is never replaced.
  Status keep();

 private:
  std::string path_, target_, temporary_;
  bool kept_ = false;
};

// Fails (kIo, where = path) on a folder that is not there or a full disk.
Status write_file(const std::string& path, std::span<const std::byte> bytes);

// Fails (kIo, where = path) when the file is missing, no regular file or cannot be read.
Result<std::string> read_file(const std::string& path);

}  // namespace probe
