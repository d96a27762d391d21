// Work on files of strangers by code of others, in a process of its own with limits: where it
// crashes, hangs or eats the memory, that is a Failure here. The process is a copy of this one, so
// programs, tests and callers of the library need no second program.
//
// A copy has only the thread that asked for it. The C library keeps malloc and stdio usable there;
// whatever else could be locked by another thread is not to be used in `work` (OpenMP, getaddrinfo,
// tables that are made at first use). The time on the clock ends what waits nevertheless.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "runtime/base/result.h"

namespace probe {

// Usual ones: `--allow-large` (runtime/base/large.h) multiplies each.
struct ApartLimits {
  std::size_t memory = std::size_t{1} << 30;  // bytes of address space beyond this process' own
  std::size_t answer = std::size_t{1} << 30;  // bytes
  int cpu_s = 10;                             // seconds of computing
  int clock_s = 120;                          // seconds on the clock
};

// Appends to the answer; false when it takes no more.
using AnswerWriter = std::function<bool(std::string_view)>;

// The bytes that came back, mapped.
class Answer {
 public:
  Answer() = default;
  Answer(const char* data, std::size_t mapped, std::size_t size)
      : data_(data), mapped_(mapped), size_(size) {}
  ~Answer();
  Answer(Answer&& other) noexcept;
  Answer& operator=(Answer&&) = delete;
  std::string_view bytes() const { return {data_, size_}; }

 private:
  const char* data_ = nullptr;
  std::size_t mapped_ = 0, size_ = 0;
};

// What `work` wrote when it returned true. Fails (kIo, no place) when it returned false, ended by a
// signal or a limit, or no process could be started; the message is a clause: "takes more than 10 s
// of computing". Exceptions end the process. `work` sees this process' memory, not its files.
Result<Answer> run_apart(const std::function<bool(const AnswerWriter&)>& work,
                         const ApartLimits& limits = {});

// A process of its own that goes on writing as it is read, so that what it has to say need not fit
// anywhere. The seconds are of what it does between two pieces that it writes. Ended with this.
class ApartStream {
 public:
  // Fails (kIo, no place) where no process can be started.
  static Result<std::unique_ptr<ApartStream>> start(
      const std::function<bool(const AnswerWriter&)>& work, const ApartLimits& limits = {});
  ~ApartStream();
  ApartStream(const ApartStream&) = delete;
  ApartStream& operator=(const ApartStream&) = delete;

  // The next bytes, all of them. Fails as run_apart does, and where the process ended before.
  Status read(std::span<char> bytes);

 private:
  ApartStream(int pipe, int child, const ApartLimits& limits)
      : pipe_(pipe), child_(child), limits_(limits) {}
  int pipe_, child_;  // negative: closed, waited for
  ApartLimits limits_;
};

}  // namespace probe
