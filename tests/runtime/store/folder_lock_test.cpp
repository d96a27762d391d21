// Locks that are taken, and file systems that give none.
#include "runtime/store/folder_lock.h"

#include <doctest/doctest.h>

#include <cerrno>

#include "tests/runtime/run/temporary_folder.h"

namespace probe::store {
namespace {

template <int kError>
int fails(int, int) {
  errno = kError;
  return -1;
}

std::string refusal(const std::string& dir, FolderLock::LockCall call = nullptr) {
  const auto lock = FolderLock::take(dir, call);
  if (lock.ok()) return "";
  CHECK(lock.failure().code == Fault::kStore);
  CHECK(lock.failure().where == dir);
  return lock.failure().message;
}

TEST_CASE("a second lock of a folder is refused until the first is gone") {
  const run::TemporaryFolder folder;
  {
    const auto first = FolderLock::take(folder.path);
    REQUIRE(first.ok());
    CHECK(refusal(folder.path) == "another run is writing into this folder");
  }
  CHECK(refusal(folder.path).empty());
}

TEST_CASE("a file system without locks is not taken for another run") {
  const run::TemporaryFolder folder;
  CHECK(refusal(folder.path, fails<ENOLCK>)
            .starts_with("its file system gives no locks (No locks available), so that"));
  CHECK(refusal(folder.path, fails<ENOSYS>)
            .starts_with("its file system gives no locks (Function not implemented)"));
  CHECK(refusal(folder.path, fails<EIO>) == "the folder cannot be locked: Input/output error");
  CHECK(refusal(folder / "absent") == "the folder cannot be written: No such file or directory");
}

TEST_CASE("a lock that a signal interrupts is asked for again") {
  const run::TemporaryFolder folder;
  static int asked = 0;
  asked = 0;
  const auto interrupted = [](int, int) {
    if (asked++ > 0) return 0;
    errno = EINTR;
    return -1;
  };
  CHECK(refusal(folder.path, interrupted).empty());
  CHECK(asked == 2);
}

}  // namespace
}  // namespace probe::store
