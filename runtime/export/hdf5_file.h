// A new HDF5 file. HDF5 1.10 takes a write that fails badly: it goes on with a cache that it cannot
// empty, and ends the program when the file or the library is closed. So its writes never fail: from
// the first that the system refuses on they stay in memory, and `status` tells.
#pragma once

#include <hdf5.h>

#include <memory>
#include <string>

#include "runtime/base/result.h"

namespace probe::exporting {

class WrittenBytes;

class Hdf5File {
 public:
  // Fails with kIo.
  static Result<Hdf5File> create(const std::string& path);
  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&&) = delete;
  ~Hdf5File();

  operator hid_t() const { return id_; }  // NOLINT: it stands for the identifier everywhere
  // kIo with the system's words since a write was refused, or where `library_ok` is false.
  Status status(bool library_ok) const;
  // Everything that HDF5 still keeps is handed over.
  Status flush(bool library_ok);
  // As flush, and nothing can be written any more.
  Status close(bool library_ok);

 private:
  Hdf5File(hid_t id, std::string path, std::unique_ptr<WrittenBytes> bytes);
  hid_t id_;
  std::string path_;
  std::unique_ptr<WrittenBytes> bytes_;  // which outlives the file that is open
};

}  // namespace probe::exporting
