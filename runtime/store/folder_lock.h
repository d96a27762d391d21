// One process writes a run's folder at a time.
#pragma once

#include <string>
#include <utility>

#include "runtime/base/result.h"

namespace probe::store {

class FolderLock {
 public:
  // As flock(2): 0, or -1 with errno.
  using LockCall = int (*)(int file, int operation);

  // Makes DIR/lock and locks it until the end of this object or of the process, however that ends.
  // Fails (kStore, where = dir) saying whether another run has the lock, the file system gives
  // none, or the folder cannot be written. `call`: the system's, unless a test has its own.
  static Result<FolderLock> take(const std::string& dir, LockCall call = nullptr);
  ~FolderLock();
  // Whether a process of this machine has it now, as /proc/locks says; nobody is kept from taking
  // it.
  static bool is_taken(const std::string& dir);
  // "its file system gives no locks (No locks available)", of the locks on parts of files that a
  // database takes; empty: it gives them, or the folder has no file to ask at.
  static std::string lack(const std::string& dir);
  FolderLock(FolderLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  FolderLock& operator=(FolderLock&&) = delete;

 private:
  explicit FolderLock(int file) : file_(file) {}
  int file_;
};

}  // namespace probe::store
