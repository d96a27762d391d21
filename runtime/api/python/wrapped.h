// Handles of vlaprobe.h as Python objects that give them back, and its errors as exceptions.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vlaprobe.h"

namespace probe::python {

namespace py = pybind11;

// vlaprobe_error for the time of one call.
class Error {
 public:
  Error() = default;
  ~Error() { vlaprobe_error_clear(&error_); }
  Error(const Error&) = delete;
  Error& operator=(const Error&) = delete;
  vlaprobe_error* get() { return &error_; }
  // With the GIL: raises the exception of vlaprobe.errors that the code stands for.
  [[noreturn]] void raise() const;

 private:
  vlaprobe_error error_{};
};

// Runs `body`, which gets the vlaprobe_error and returns a code, without the GIL, and raises.
template <typename Body>
void call_free(Body&& body) {
  Error error;
  std::int32_t code = VLAPROBE_OK;
  {
    const py::gil_scoped_release release;
    code = body(error.get());
  }
  if (code != VLAPROBE_OK) error.raise();
}

// The same with the GIL, for what takes no time.
template <typename Body>
void call(Body&& body) {
  Error error;
  if (body(error.get()) != VLAPROBE_OK) error.raise();
}

[[noreturn]] void raise_closed(const char* what);

// A handle for as long as somebody uses it: one that is closed during a call of another thread is
// given back behind it.
template <typename Handle>
class Held {
 public:
  explicit Held(std::shared_ptr<Handle> handle) : handle_(std::move(handle)) {}
  operator Handle*() const { return handle_.get(); }

 private:
  std::shared_ptr<Handle> handle_;
};

// Owns a handle until it is closed. Raises vlaprobe.errors.ClosedError when used after that.
template <typename Handle, void (*Release)(Handle*)>
class Owned {
 public:
  explicit Owned(Handle* handle) : handle_(handle, Release) {}
  Held<Handle> get(const char* what) const {
    if (!handle_) raise_closed(what);
    return Held<Handle>(handle_);
  }
  void close() { handle_.reset(); }

 private:
  std::shared_ptr<Handle> handle_;
};

// The array itself, read-only; `owner` lives as long as it does.
py::array view_of(const vlaprobe_array& array, const py::handle& owner);
// Its numbers in an array of their own.
py::array copy_of(const vlaprobe_array& array);

// (kind, low (n,), high (n,))
py::tuple told_of(const vlaprobe_action_space& space);

// C-contiguous doubles of this many in all, whatever numbers were given. Raises TypeError for what
// is no array of numbers and ValueError for another shape, naming both.
using Numbers = py::array_t<double, py::array::c_style>;
Numbers numbers_of(const py::handle& given, const std::vector<py::ssize_t>& shape,
                   const char* what);

void add_plan(py::module_& module);
void add_stage(py::module_& module);
void add_batch(py::module_& module);
void add_run(py::module_& module);
void add_ask(py::module_& module);

struct Plan {
  Owned<vlaprobe_plan, vlaprobe_plan_release> handle;
  Held<vlaprobe_plan> get() const { return handle.get("plan"); }
};
struct Stage {
  Owned<vlaprobe_stage, vlaprobe_stage_release> handle;
  Held<vlaprobe_stage> get() const { return handle.get("stage"); }
};

}  // namespace probe::python
