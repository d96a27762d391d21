// A driver of HDF5's for files, as its own `sec2` but for what happens where the disk is full.
#include "runtime/export/hdf5_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "runtime/base/io_failure.h"
#include "runtime/export/hdf5_handle.h"

namespace probe::exporting {

// The file's bytes: on the disk, and behind the first refusal in pages of memory over it.
class WrittenBytes {
 public:
  explicit WrittenBytes(int file) : file_(file) {}
  ~WrittenBytes() { ::close(file_); }
  WrittenBytes(const WrittenBytes&) = delete;
  WrittenBytes& operator=(const WrittenBytes&) = delete;

  const std::optional<int>& error() const { return error_; }

  // False where the disk cannot be read.
  bool read(std::uint64_t at, std::size_t size, std::uint8_t* to) const {
    if (!from_disk(at, size, to)) return false;
    each_page(at, size, [&](std::uint64_t page, std::size_t from, std::size_t done, std::size_t n) {
      const auto kept = pages_.find(page);
      if (kept != pages_.end()) std::memcpy(to + done, kept->second.data() + from, n);
    });
    return true;
  }

  void write(std::uint64_t at, std::size_t size, const std::uint8_t* bytes) {
    while (size > 0 && !error_) {
      const ssize_t done = ::pwrite(file_, bytes, size, static_cast<off_t>(at));
      if (done < 0 && errno == EINTR) continue;
      if (done <= 0) {
        error_ = done < 0 ? errno : ENOSPC;
        break;
      }
      at += static_cast<std::uint64_t>(done);
      bytes += done;
      size -= static_cast<std::size_t>(done);
    }
    each_page(at, size, [&](std::uint64_t page, std::size_t from, std::size_t done, std::size_t n) {
      const auto [kept, is_new] = pages_.try_emplace(page);
      if (is_new) from_disk(page * kPage, kPage, kept->second.data());
      std::memcpy(kept->second.data() + from, bytes + done, n);
    });
  }

  void resize(std::uint64_t size) {
    if (!error_ && ::ftruncate(file_, static_cast<off_t>(size)) != 0) error_ = errno;
  }

 private:
  static constexpr std::size_t kPage = 4096;
  using Page = std::array<std::uint8_t, kPage>;

  // of(page, first byte in it, bytes before, bytes)
  template <class Of>
  static void each_page(std::uint64_t at, std::size_t size, Of of) {
    for (std::size_t done = 0; done < size;) {
      const std::size_t from = static_cast<std::size_t>((at + done) % kPage);
      const std::size_t n = std::min(kPage - from, size - done);
      of((at + done) / kPage, from, done, n);
      done += n;
    }
  }

  // Behind the end there are zeros.
  bool from_disk(std::uint64_t at, std::size_t size, std::uint8_t* to) const {
    while (size > 0) {
      const ssize_t done = ::pread(file_, to, size, static_cast<off_t>(at));
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) return false;
      if (done == 0) {
        std::memset(to, 0, size);
        return true;
      }
      at += static_cast<std::uint64_t>(done);
      to += done;
      size -= static_cast<std::size_t>(done);
    }
    return true;
  }

  int file_;
  std::optional<int> error_;  // errno of the first refusal
  std::map<std::uint64_t, Page> pages_;
};

namespace {

// What HDF5 knows of a file that is open; its own part first, as it wants it.
struct DriverFile {
  H5FD_t of_library{};
  WrittenBytes* bytes = nullptr;
  haddr_t end_of_allocated = 0, end_of_file = 0;
};
DriverFile& ours(H5FD_t* file) { return *reinterpret_cast<DriverFile*>(file); }
const DriverFile& ours(const H5FD_t* file) { return *reinterpret_cast<const DriverFile*>(file); }

struct DriverInfo {
  WrittenBytes* bytes;
};

H5FD_t* open_bytes(const char*, unsigned, hid_t properties, haddr_t) {
  const auto* info = static_cast<const DriverInfo*>(H5Pget_driver_info(properties));
  if (info == nullptr) return nullptr;
  auto* file = new DriverFile;
  file->bytes = info->bytes;
  return &file->of_library;
}
herr_t close_bytes(H5FD_t* file) {
  delete &ours(file);
  return 0;
}
// As sec2, so that the library lays its files out in the same way.
herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}
haddr_t end_of_allocated(const H5FD_t* file, H5FD_mem_t) { return ours(file).end_of_allocated; }
herr_t set_end_of_allocated(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  ours(file).end_of_allocated = end;
  return 0;
}
haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t) { return ours(file).end_of_file; }
herr_t read_bytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* to) {
  return ours(file).bytes->read(at, size, static_cast<std::uint8_t*>(to)) ? 0 : -1;
}
herr_t write_bytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size,
                   const void* bytes) {
  DriverFile& written = ours(file);
  written.bytes->write(at, size, static_cast<const std::uint8_t*>(bytes));
  written.end_of_file = std::max<haddr_t>(written.end_of_file, at + size);
  return 0;
}
herr_t truncate_bytes(H5FD_t* file, hid_t, hbool_t) {
  DriverFile& written = ours(file);
  if (written.end_of_allocated == written.end_of_file) return 0;
  written.bytes->resize(written.end_of_allocated);
  written.end_of_file = written.end_of_allocated;
  return 0;
}

H5FD_class_t driver_class() {
  H5FD_class_t driver{};
  driver.name = "vlaprobe";
  driver.maxaddr = static_cast<haddr_t>(INT64_MAX);
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(DriverInfo);
  driver.open = open_bytes;
  driver.close = close_bytes;
  driver.query = query;
  driver.get_eoa = end_of_allocated;
  driver.set_eoa = set_end_of_allocated;
  driver.get_eof = end_of_file;
  driver.read = read_bytes;
  driver.write = write_bytes;
  driver.truncate = truncate_bytes;
  constexpr H5FD_mem_t kMap[] = H5FD_FLMAP_DICHOTOMY;
  std::ranges::copy(kMap, driver.fl_map);
  return driver;
}

}  // namespace

Result<Hdf5File> Hdf5File::create(const std::string& path) {
  // Failures are told by us, not by the library's own printing.
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) return io_failure("cannot be made", path);
  auto bytes = std::make_unique<WrittenBytes>(descriptor);
  static const H5FD_class_t kDriver = driver_class();
  // A file that is open holds its driver.
  const Hdf5Handle driver(H5FDregister(&kDriver), H5FDunregister);
  const Hdf5Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  const DriverInfo info{bytes.get()};
  if (H5Pset_driver(properties, driver, &info) < 0)
    return Failure{Fault::kIo, "cannot be made as HDF5", path};
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, properties);
  if (file < 0) return Failure{Fault::kIo, "cannot be made as HDF5", path};
  return Hdf5File(file, path, std::move(bytes));
}

Hdf5File::Hdf5File(hid_t id, std::string path, std::unique_ptr<WrittenBytes> bytes)
    : id_(id), path_(std::move(path)), bytes_(std::move(bytes)) {}
Hdf5File::Hdf5File(Hdf5File&& other) noexcept
    : id_(std::exchange(other.id_, H5I_INVALID_HID)),
      path_(std::move(other.path_)),
      bytes_(std::move(other.bytes_)) {}
Hdf5File::~Hdf5File() {
  if (id_ >= 0) H5Fclose(id_);
}

Status Hdf5File::status(bool library_ok) const {
  if (bytes_->error()) return io_failure("cannot be written", *bytes_->error(), path_);
  if (!library_ok) return Failure{Fault::kIo, "cannot be written as HDF5", path_};
  return {};
}

Status Hdf5File::flush(bool library_ok) {
  const bool is_flushed = H5Fflush(id_, H5F_SCOPE_GLOBAL) >= 0;
  return status(library_ok && is_flushed);
}

Status Hdf5File::close(bool library_ok) {
  const bool is_flushed = H5Fflush(id_, H5F_SCOPE_GLOBAL) >= 0;
  const bool is_closed = H5Fclose(std::exchange(id_, H5I_INVALID_HID)) >= 0;
  return status(library_ok && is_flushed && is_closed);
}

}  // namespace probe::exporting
