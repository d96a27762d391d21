#include "runtime/store/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace probe::store {
namespace {

std::string reason(int error) {
  switch (error) {
    case EWOULDBLOCK:
      return "another run is writing into this folder";
    // NFS without its lock service, Lustre without the mount option `flock`, some of FUSE.
    case ENOLCK:
    case ENOSYS:
    case ENOTSUP:
    case EINVAL:
      return std::string("its file system gives no locks (") + std::strerror(error) +
             "), so that nothing would keep two runs from writing into it at once; take a folder "
             "on another file system, or have this one mounted with locks";
    default:
      return std::string("the folder cannot be locked: ") + std::strerror(error);
  }
}

}  // namespace

Result<FolderLock> FolderLock::take(const std::string& dir, LockCall call) {
  const std::string path = dir + "/lock";
  const int file =
      ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0644);
  if (file < 0) {
    return Failure{Fault::kStore,
                   std::string("the folder cannot be written: ") + std::strerror(errno), dir};
  }
  FolderLock lock(file);
  const LockCall take = call == nullptr ? &::flock : call;
  int error = 0;
  do {
    error = take(file, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
  } while (error == EINTR);
  if (error != 0) return Failure{Fault::kStore, reason(error), dir};
  return lock;
}

FolderLock::~FolderLock() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace probe::store
