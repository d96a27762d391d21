// Before the C library: a file system that gives no locks.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <cerrno>
#include <cstdarg>
#include <cstdlib>

namespace {

bool is_of_locks(int command) {
  return command == F_SETLK || command == F_SETLKW || command == F_GETLK ||
         command == F_OFD_SETLK || command == F_OFD_SETLKW || command == F_OFD_GETLK;
}

// PROBE_ERRNO, as different file systems say it.
int error() {
  const char* said = std::getenv("PROBE_ERRNO");
  return said == nullptr ? ENOLCK : std::atoi(said);
}

}  // namespace

extern "C" int flock(int, int) noexcept {
  errno = error();
  return -1;
}

extern "C" int fcntl64(int file, int command, ...) {
  if (is_of_locks(command)) {
    errno = error();
    return -1;
  }
  std::va_list rest;
  va_start(rest, command);
  void* const argument = va_arg(rest, void*);
  va_end(rest);
  using Call = int (*)(int, int, ...);
  static const Call real = reinterpret_cast<Call>(dlsym(RTLD_NEXT, "fcntl64"));
  return real(file, command, argument);
}

extern "C" int fcntl(int file, int command, ...) __attribute__((alias("fcntl64")));
