// Before the C library: a disk that keeps what was forced to it, and a power cut. Of the files
// below PROBE_DISK the contents that fsync and fdatasync forced are kept in PROBE_KEPT, of its
// folders the names that were forced; at the PROBE_CUT-th of these calls the process ends at once.
// A call for a file whose name ends with PROBE_FORGET does nothing: a mistake to be found.
// power_cut.py makes of it what a machine finds when it is switched on again.
#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <string_view>

namespace {

std::string text_of(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

struct Disk {
  std::string root = text_of("PROBE_DISK"), kept = text_of("PROBE_KEPT"),
              forget = text_of("PROBE_FORGET");
  long cut = std::atol(text_of("PROBE_CUT").c_str());
  long calls = 0;
  std::mutex mutex;
};
Disk& disk() {
  static Disk disk;
  return disk;
}

std::string path_of(int file) {
  char path[4096] = "";
  const ssize_t size =
      ::readlink(("/proc/self/fd/" + std::to_string(file)).c_str(), path, sizeof path - 1);
  return {path, size > 0 ? static_cast<std::size_t>(size) : 0};
}

// A file, whatever it is called: its number and when it was made, as numbers are used again.
std::string key_of(int folder, const char* name, int flags, bool& is_folder) {
  struct statx about {};
  if (::statx(folder, name, flags | AT_SYMLINK_NOFOLLOW, STATX_INO | STATX_BTIME | STATX_TYPE,
              &about) != 0)
    return "";
  is_folder = S_ISDIR(about.stx_mode);
  return std::to_string(about.stx_ino) + "-" + std::to_string(about.stx_btime.tv_sec) + "." +
         std::to_string(about.stx_btime.tv_nsec);
}

void keep(const std::string& name, const std::string& content) {
  const std::string at = disk().kept + "/" + name, beside = at + "~";
  std::FILE* const out = std::fopen(beside.c_str(), "wb");
  if (out == nullptr) std::abort();
  std::fwrite(content.data(), 1, content.size(), out);
  std::fclose(out);
  if (std::rename(beside.c_str(), at.c_str()) != 0) std::abort();
}

// Not through another descriptor where this one will do: whoever closes one gives away the locks
// that the process has on the file.
std::string content_of(int file) {
  std::string content;
  char block[1 << 16];
  int from = file;
  if ((::fcntl(file, F_GETFL) & O_ACCMODE) == O_WRONLY)
    from = ::open(("/proc/self/fd/" + std::to_string(file)).c_str(), O_RDONLY | O_CLOEXEC);
  for (;;) {
    const ssize_t size = ::pread(from, block, sizeof block, static_cast<off_t>(content.size()));
    if (size <= 0) break;
    content.append(block, static_cast<std::size_t>(size));
  }
  if (from != file) ::close(from);
  return content;
}

// "f KEY NAME" and "d KEY NAME", a line each.
std::string names_in(const std::string& path) {
  std::string lines;
  DIR* const folder = ::opendir(path.c_str());
  while (const dirent* entry = folder == nullptr ? nullptr : ::readdir(folder)) {
    const std::string_view name = entry->d_name;
    if (name == "." || name == "..") continue;
    bool is_folder = false;
    const std::string key = key_of(::dirfd(folder), entry->d_name, 0, is_folder);
    if (!key.empty()) lines += (is_folder ? "d " : "f ") + key + " " + entry->d_name + "\n";
  }
  if (folder != nullptr) ::closedir(folder);
  return lines;
}

int force(int file) {
  Disk& now = disk();
  const std::string path = path_of(file);
  if (now.root.empty() || !(path + "/").starts_with(now.root + "/")) return 0;
  const std::lock_guard lock(now.mutex);
  if (++now.calls == now.cut) ::kill(::getpid(), SIGKILL);
  if (!now.forget.empty() && path.ends_with(now.forget)) return 0;
  bool is_folder = false;
  const std::string key = key_of(file, "", AT_EMPTY_PATH, is_folder);
  if (is_folder) {
    keep("names " + key, names_in(path));
  } else {
    keep("bytes " + key, content_of(file));
  }
  return 0;
}

}  // namespace

extern "C" {
int fsync(int file) { return force(file); }
int fdatasync(int file) { return force(file); }
int syncfs(int) noexcept {
  errno = ENOSYS;  // then each file is forced by itself
  return -1;
}
}
