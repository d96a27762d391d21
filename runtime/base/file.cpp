#include "runtime/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "runtime/base/io_failure.h"
#include "runtime/base/large.h"

namespace probe {
namespace {

// Two threads may write one file.
std::string next_suffix() {
  static std::atomic<unsigned> count{0};
  return "." + std::to_string(::getpid()) + "-" + std::to_string(count++) + ".tmp";
}

// Where a symbolic link leads, also one whose file is not there yet.
std::string without_links(const std::string& path) {
  constexpr int kMostLinks = 40;  // as Linux follows
  std::filesystem::path place = path;
  std::error_code error;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(place, error); ++i) {
    const auto next = std::filesystem::read_symlink(place, error);
    if (error) break;
    place = next.is_absolute() ? next : place.parent_path() / next;
  }
  return place.string();
}

constexpr std::size_t kCopied = std::size_t{1} << 20;  // bytes at once

class Descriptor {
 public:
  explicit Descriptor(int file) : file_(file) {}
  ~Descriptor() {
    if (file_ >= 0) ::close(file_);
  }
  Descriptor(Descriptor&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  int get() const { return file_; }

 private:
  int file_;
};

// For reading; what is no regular file is not waited for.
Result<Descriptor> open_regular(const std::string& path, Fault code) {
  const auto refuse = [&](std::string message) { return Failure{code, std::move(message), path}; };
  // Without O_NONBLOCK a pipe would be waited for until somebody writes into it.
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (file.get() < 0) {
    if (errno == ENOENT) return refuse("there is no such file");
    return refuse(std::string("cannot be opened: ") + std::strerror(errno));
  }
  struct stat about {};
  if (::fstat(file.get(), &about) != 0)
    return refuse(std::string("cannot be read: ") + std::strerror(errno));
  if (!S_ISREG(about.st_mode)) return refuse("is no file but a folder, a device or a pipe");
  return file;
}

std::string bytes_text(std::size_t bytes) {
  constexpr std::size_t kMebi = std::size_t{1} << 20;
  return bytes % kMebi == 0 ? std::to_string(bytes / kMebi) + " MiB"
                            : std::to_string(bytes) + " bytes";
}

}  // namespace

PendingFile::PendingFile(std::string path)
    : path_(std::move(path)), target_(without_links(path_)), temporary_(target_ + next_suffix()) {}

PendingFile::~PendingFile() {
  if (!kept_) std::remove(temporary_.c_str());
}

Status PendingFile::keep() {
  const int file = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return io_failure("cannot be written", path_);
  const bool synced = ::fsync(file) == 0;
  const int error = errno;
  ::close(file);
  errno = error;
  if (!synced) return io_failure("cannot be forced to the disk", path_);
  std::error_code ignored;
  const auto present = std::filesystem::status(target_, ignored).type();
  if (present != std::filesystem::file_type::regular &&
      present != std::filesystem::file_type::not_found) {
    return {Failure{.code = Fault::kIo,
                    .message = "is a folder, a device or a pipe and is not replaced",
                    .where = path_}};
  }
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) {
    return io_failure("cannot be renamed", path_);
  }
  kept_ = true;
  return {};
}

Status write_file(const std::string& path, std::span<const std::byte> bytes) {
  PendingFile pending(path);
  std::FILE* file = std::fopen(pending.temporary().c_str(), "wb");
  if (file == nullptr) return io_failure("cannot be created", path);
  bool fine = bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  fine = fine && std::fflush(file) == 0;
  const int error = errno;
  if (std::fclose(file) != 0 && fine) return io_failure("cannot be written", path);
  errno = error;
  if (!fine) return io_failure("cannot be written", path);
  return pending.keep();
}

Status copy_bytes(const std::string& from, const std::string& to) {
  PROBE_ASSIGN(const Descriptor in, open_regular(from, Fault::kIo));
  const int made = ::open(to.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0644);
  if (made < 0) return io_failure("cannot be created", to);
  const Descriptor out(made);
  // Only touched by as many bytes as there are.
  const std::unique_ptr<char[]> buffer(new char[kCopied]);
  for (;;) {
    const ssize_t got = ::read(in.get(), buffer.get(), kCopied);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return io_failure("cannot be read", from);
    if (got == 0) return {};
    for (ssize_t done = 0; done < got;) {
      const ssize_t put =
          ::write(out.get(), buffer.get() + done, static_cast<std::size_t>(got - done));
      if (put < 0 && errno == EINTR) continue;
      if (put < 0) return io_failure("cannot be written", to);
      done += put;
    }
  }
}

Status copy_to_disk(const std::string& from, const std::string& to) {
  PROBE_TRY(copy_bytes(from, to));
  return sync_disk(std::span(&to, 1));
}

Status sync_disk(std::span<const std::string> paths) {
  constexpr std::size_t kFew = 16;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Descriptor file(::open(paths[i].c_str(), O_RDONLY | O_CLOEXEC));
    if (file.get() < 0) return io_failure("cannot be opened", paths[i]);
    // Where that cannot be asked, each is.
    if (i == 0 && paths.size() > kFew && ::syncfs(file.get()) == 0) return {};
    if (::fsync(file.get()) != 0) return io_failure("cannot be forced to the disk", paths[i]);
  }
  return {};
}

Result<std::string> read_file(const std::string& path, const ReadRules& rules) {
  const auto refuse = [&](std::string message) {
    return Failure{rules.code, std::move(message), path};
  };
  // Of a file whose beginning is enough nothing is refused.
  const std::size_t most = rules.only_begin ? rules.most : allowed(rules.most);
  PROBE_ASSIGN(const Descriptor file, open_regular(path, rules.code));
  struct stat about {};
  if (::fstat(file.get(), &about) != 0)
    return refuse(std::string("cannot be read: ") + std::strerror(errno));
  const auto too_large = [&] {
    return refuse("has more than the " + bytes_text(most) + " that are read" + large_hint());
  };
  const auto stated = static_cast<std::uintmax_t>(about.st_size);
  if (stated > most && !rules.only_begin) return too_large();
  // One byte more than it says, which ends the reading at once; /proc says 0 of everything.
  std::string bytes(static_cast<std::size_t>(std::min<std::uintmax_t>(stated, most)) + 1, '\0');
  std::size_t size = 0;
  for (;;) {
    if (size == bytes.size()) bytes.resize(2 * size + 4096);
    const ssize_t got = ::read(file.get(), bytes.data() + size, bytes.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return refuse(std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
    if (size <= most) continue;
    if (!rules.only_begin) return too_large();
    size = most;
    break;
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace probe
