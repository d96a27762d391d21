// How every exported function begins and ends: nothing thrown passes, what fails is written down
// for the caller, a handle is used by one thread of one process at a time.
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <exception>
#include <initializer_list>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/api/vlaprobe.h"
#include "runtime/base/result.h"

namespace probe::api {

std::int32_t code_of(Fault fault);

// Write `error`, which may be null, and return its code.
std::int32_t fail(vlaprobe_error* error, const Failure& failure);
std::int32_t fail(vlaprobe_error* error, std::int32_t code, std::string_view message,
                  std::string_view diagnostics);
std::int32_t fail_memory(vlaprobe_error* error);

// Null when there is no memory.
char* copy_text(std::string_view text);

inline Failure usage(std::string message, std::string where = "") {
  return {Fault::kUsage, std::move(message), std::move(where)};
}

// An argument that must be there, and what the header calls it.
struct Needed {
  const void* given;
  const char* name;
};
// Fails (kUsage) on the first that is NULL.
Status needs(std::initializer_list<Needed> arguments);

// `count` texts. Fails (kUsage) where the array or one of them is NULL.
Result<std::vector<std::string>> read_texts(const char* const* texts, std::size_t count,
                                            const char* name);

// Runs `body`, which returns a Status, and turns whatever comes of it into a code.
template <typename Body>
std::int32_t call(vlaprobe_error* error, Body&& body) noexcept {
  try {
    const Status status = body();
    return status ? static_cast<std::int32_t>(VLAPROBE_OK) : fail(error, status.failure());
  } catch (const std::bad_alloc&) {
    return fail_memory(error);
  } catch (const std::exception& exception) {
    return fail(error, VLAPROBE_INTERNAL, exception.what(), {});
  } catch (...) {
    return fail(error, VLAPROBE_INTERNAL, "an exception of unknown type", {});
  }
}

// The user of a handle for the time of one call.
class Use {
 public:
  // What handles have.
  struct Lock {
    std::atomic<bool> taken = false;
    pid_t process = ::getpid();
  };
  // Fails (kUsage) where another thread is in a call, or in a copy of the process that made it.
  static Result<Use> of(Lock& lock, const char* what) {
    if (lock.process != ::getpid()) {
      return usage(std::string("the ") + what +
                   " was made before this process was forked: make another one in the child");
    }
    if (lock.taken.exchange(true)) {
      return usage(std::string("another thread is using the ") + what +
                   ": use it from one at a time");
    }
    return Use(&lock);
  }
  Use(Use&& other) noexcept : lock_(std::exchange(other.lock_, nullptr)) {}
  Use& operator=(Use&&) = delete;
  ~Use() {
    if (lock_ != nullptr) lock_->taken = false;
  }

 private:
  explicit Use(Lock* lock) : lock_(lock) {}
  Lock* lock_;
};

// Options of a program that was compiled with an older or newer header: what it does not have is
// zero. Fails (kUsage) where it has what this library does not know and does not leave at zero.
template <typename Options>
Result<Options> read_options(const Options* given) {
  Options options{};
  if (given == nullptr) return options;
  constexpr std::size_t kLargest = 4096;
  const std::size_t size = given->size;
  // A size that is no multiple of the alignment would end within a field.
  if (size < sizeof given->size || size > kLargest || size % alignof(Options) != 0)
    return usage("`size` of the options is their size in bytes; found " + std::to_string(size));
  const auto* from = reinterpret_cast<const unsigned char*>(given);
  auto* to = reinterpret_cast<unsigned char*>(&options);
  for (std::size_t i = 0; i < size; ++i) {
    if (i < sizeof options) {
      to[i] = from[i];
    } else if (from[i] != 0) {
      return usage(
          "the options have what this library does not know: it is older than the "
          "program's header");
    }
  }
  return options;
}

}  // namespace probe::api
