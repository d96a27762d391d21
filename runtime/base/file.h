// Files that are whole or absent: written beside their place under another name, forced to the disk
// and renamed. Bytes of whole files in memory; every reader of a whole file is read_file.
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

// The bytes of a regular file into another one, made or replaced, which then are on the disk; its
// name is not, see sync_folder. Fails (kIo, where = the path at fault).
Status copy_to_disk(const std::string& from, const std::string& to);

// The same without waiting for the disk: sync_disk does, for many at once.
Status copy_bytes(const std::string& from, const std::string& to);

// Waits until the disk has all of these files. More than a few: all that its file system has yet to
// write, in one. Fails (kIo, where = the path at fault).
Status sync_disk(std::span<const std::string> paths);

// What read_file refuses, and how.
struct ReadRules {
  std::size_t most = std::size_t{1} << 30;  // bytes
  Fault code = Fault::kIo;                  // of a failure
  bool only_begin = false;                  // of a larger file that many bytes are enough
};

// All bytes of a regular file. Fails (rules.code, where = path) when there is none, when it is a
// folder, a device or a pipe (which is not waited for), has more than the most bytes, or cannot be
// read.
Result<std::string> read_file(const std::string& path, const ReadRules& rules = {});

}  // namespace probe
