#include "runtime/base/file_stream.h"

#include <unistd.h>

#include <cerrno>
#include <utility>

#include "runtime/base/io_failure.h"

namespace probe {

Result<FileStream> FileStream::create(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return io_failure("cannot be made", path);
  return FileStream(file, path);
}

FileStream::FileStream(FileStream&& from) noexcept
    : file_(std::exchange(from.file_, nullptr)), path_(std::move(from.path_)) {}

FileStream::~FileStream() {
  if (file_ != nullptr) std::fclose(file_);
}

Status FileStream::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size())
    return io_failure("cannot be written", path_);
  return {};
}

Status FileStream::finish() {
  const bool is_there = std::fflush(file_) == 0 && ::fsync(::fileno(file_)) == 0;
  const int error = errno;
  const bool is_closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (!is_there) return io_failure("cannot be written", error, path_);
  if (!is_closed) return io_failure("cannot be written", path_);
  return {};
}

}  // namespace probe
