#include "runtime/store/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

namespace probe::store {
namespace {

// Empty of another error. NFS without its lock service, Lustre without the mount option `flock`,
// some of FUSE.
std::string no_locks(int error) {
  if (error != ENOLCK && error != ENOSYS && error != ENOTSUP && error != EINVAL) return {};
  return std::string("its file system gives no locks (") + std::strerror(error) + ")";
}

std::string reason(int error) {
  if (error == EWOULDBLOCK) return "another run is writing into this folder";
  if (const std::string lack = no_locks(error); !lack.empty()) {
    return lack +
           ", so that nothing would keep two runs from writing into it at once; take a folder on "
           "another file system, or have this one mounted with locks";
  }
  return std::string("the folder cannot be locked: ") + std::strerror(error);
}

}  // namespace

Result<FolderLock> FolderLock::take(const std::string& dir, LockCall call) {
  const std::string path = dir + "/lock";
  const int file =
      ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
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

// "1: FLOCK  ADVISORY  WRITE 4711 fd:01:123456 0 EOF"
bool FolderLock::is_taken(const std::string& dir) {
  struct stat file {};
  if (::stat((dir + "/lock").c_str(), &file) != 0) return false;
  const std::string wanted = fmt::format("{:02x}:{:02x}:{}", major(file.st_dev), minor(file.st_dev),
                                         static_cast<std::uint64_t>(file.st_ino));
  std::ifstream locks("/proc/locks");
  std::string number, kind, advisory, access, process, place;
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    words >> number >> kind >> advisory >> access >> process >> place;
    if (kind == "FLOCK" && place == wanted) return true;
  }
  return false;
}

// Asked at another file than the database: whoever closes that gives away all locks that the
// process has on it.
std::string FolderLock::lack(const std::string& dir) {
  int file = -1;
  for (const char* name : {"/lock", "/suite.plan"}) {
    if (file < 0)
      file = ::open((dir + name).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  }
  if (file < 0) return {};
  struct flock asked {};
  asked.l_type = F_RDLCK;
  asked.l_whence = SEEK_SET;
  asked.l_len = 1;
  const int error = ::fcntl(file, F_SETLK, &asked) == 0 ? 0 : errno;
  ::close(file);
  return no_locks(error);
}

FolderLock::~FolderLock() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace probe::store
