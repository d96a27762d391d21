// What the system says of a file that cannot be opened, read or written.
#pragma once

#include <cerrno>
#include <cstring>
#include <string>

#include "runtime/base/result.h"

namespace probe {

// kIo, where = path: "what: the system's words for the error".
inline Failure io_failure(const std::string& what, int error, const std::string& path) {
  return {.code = Fault::kIo, .message = what + ": " + std::strerror(error), .where = path};
}
// Of the call that failed last, by errno.
inline Failure io_failure(const std::string& what, const std::string& path) {
  return io_failure(what, errno, path);
}

}  // namespace probe
