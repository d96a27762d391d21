#include "runtime/base/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace probe {
namespace {

Failure io_failure(const std::string& what, const std::string& path) {
  return {.code = Fault::kIo, .message = what + ": " + std::strerror(errno), .where = path};
}

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

Result<std::string> read_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return Failure{.code = Fault::kIo, .message = "there is no such file", .where = path};
  }
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = stream ? static_cast<std::streamoff>(stream.tellg()) : -1;
  if (size < 0) return Failure{.code = Fault::kIo, .message = "cannot be opened", .where = path};
  std::string bytes(static_cast<std::size_t>(size), '\0');
  stream.seekg(0);
  stream.read(bytes.data(), size);
  if (!stream) return Failure{.code = Fault::kIo, .message = "cannot be read", .where = path};
  return bytes;
}

}  // namespace probe
