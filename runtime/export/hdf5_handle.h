// What HDF5 hands out, closed when it goes.
#pragma once

#include <hdf5.h>

namespace probe::exporting {

// Any HDF5 identifier; closed by the function of its kind. Negative ones are failures.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: it stands for the identifier everywhere

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

}  // namespace probe::exporting
