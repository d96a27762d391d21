// Calls that last, and call Python back. They have a thread of their own, so that the caller's can
// look for Ctrl-C; callbacks take the GIL for as long as they last.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "runtime/api/python/wrapped.h"

namespace probe::python {

// What the callbacks of one call share.
struct Caller {
  std::atomic<bool> stop = false;
  // The first exception that ends the call; raised behind it. Under the GIL.
  std::optional<py::error_already_set> raised = {};

  void end_with(const py::error_already_set& error) {
    if (!raised) raised.emplace(error);
    stop = true;
  }
};

// Runs `body` without the GIL until it returns, and raises what ended it: Ctrl-C, what a callback
// raised, what failed. `body` ends early when `caller.stop` is set.
void call_watched(Caller& caller, const std::function<std::int32_t(vlaprobe_error*)>& body);

// A text of the library's, given back to it.
std::string taken(char* text);

}  // namespace probe::python
