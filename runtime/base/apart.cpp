// fork, limits, a file in memory for the answer, and a pipe that ends with the process.
#include "runtime/base/apart.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <utility>

#include "runtime/base/large.h"

namespace probe {
namespace {

// Behind a whole answer.
constexpr std::string_view kDone = "whole\n\n\n";

Failure apart_failure(std::string what) { return {Fault::kIo, std::move(what), ""}; }

class Handle {
 public:
  explicit Handle(int file = -1) : file_(file) {}
  ~Handle() { close(); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  int get() const { return file_; }
  void reset(int file) {
    close();
    file_ = file;
  }
  int release() { return std::exchange(file_, -1); }
  void close() {
    if (file_ >= 0) ::close(std::exchange(file_, -1));
  }

 private:
  int file_;
};

// ---- in the child: nothing here may throw or wait for a lock

std::size_t address_space() {
  char text[64] = {};
  const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  const ssize_t got = file < 0 ? -1 : ::read(file, text, sizeof text - 1);
  if (file >= 0) ::close(file);
  std::size_t pages = 0;
  for (const char* c = text; got > 0 && *c >= '0' && *c <= '9'; ++c)
    pages = 10 * pages + static_cast<std::size_t>(*c - '0');
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void set_limit(int which, std::size_t most) {
  rlimit now{};
  if (::getrlimit(static_cast<__rlimit_resource>(which), &now) != 0) return;
  now.rlim_cur = std::min<rlim_t>(now.rlim_max, most);
  ::setrlimit(static_cast<__rlimit_resource>(which), &now);
}

void close_but(int a, int b) {
  const auto close_range_of = [](unsigned first, unsigned last) {
    if (first <= last) ::close_range(first, last, 0);
  };
  const auto low = static_cast<unsigned>(std::min(a, b)),
             high = static_cast<unsigned>(std::max(a, b));
  close_range_of(3, low - 1);
  close_range_of(low + 1, high - 1);
  close_range_of(high + 1, ~0U);
}

bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::write(file, bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(put));
  }
  return true;
}

// What every child begins with; it keeps two files.
void begin_child(pid_t parent, int a, int b, const ApartLimits& limits) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // of the thread that waits
  if (::getppid() != parent) ::_exit(1);
  // Whoever catches signals in this program has nothing to say here.
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGTERM, SIGINT})
    ::signal(signal, SIG_DFL);
  ::signal(SIGXFSZ, SIG_IGN);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  if (const int nothing = ::open("/dev/null", O_RDWR); nothing >= 0) {
    for (const int stream : {0, 1, 2}) ::dup2(nothing, stream);
  }
  close_but(a, b);
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, static_cast<std::size_t>(limits.cpu_s));
  set_limit(RLIMIT_FSIZE, limits.answer + kDone.size());
#ifndef __SANITIZE_ADDRESS__  // whose shadow is larger than any limit
  set_limit(RLIMIT_AS, address_space() + limits.memory);
#endif
}

[[noreturn]] void work_as_child(const std::function<bool(const AnswerWriter&)>& work,
                                const AnswerWriter& write, std::string_view end) {
  try {
    if (work(write) && (end.empty() || write(end))) ::_exit(0);
  } catch (const std::exception&) {
  }
  ::_exit(1);
}

[[noreturn]] void be_child(const std::function<bool(const AnswerWriter&)>& work,
                           const ApartLimits& limits, int answer, int pipe, pid_t parent) {
  begin_child(parent, answer, pipe, limits);
  work_as_child(
      work, [answer](std::string_view bytes) { return write_all(answer, bytes); }, kDone);
}

// The limit of computing counts from the last piece on.
[[noreturn]] void be_stream(const std::function<bool(const AnswerWriter&)>& work,
                            const ApartLimits& limits, int pipe, pid_t parent) {
  begin_child(parent, pipe, pipe, limits);
  ::signal(SIGPIPE, SIG_DFL);  // nobody reads any more
  work_as_child(work,
                [&](std::string_view bytes) {
                  if (!write_all(pipe, bytes)) return false;
                  rusage used{};
                  ::getrusage(RUSAGE_SELF, &used);
                  const auto both = used.ru_utime.tv_usec + used.ru_stime.tv_usec;
                  const auto seconds =
                      used.ru_utime.tv_sec + used.ru_stime.tv_sec + both / 1'000'000 + 1;
                  set_limit(RLIMIT_CPU, static_cast<std::size_t>(seconds + limits.cpu_s));
                  return true;
                },
                {});
}

// ---- in the parent

// Whether something was written, or the other end closed, in time.
bool wait_for_end(int pipe, int seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::seconds(seconds);
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) return false;
    pollfd about{pipe, POLLIN, 0};
    const int ready = ::poll(&about, 1, static_cast<int>(std::min<std::int64_t>(left, 1'000'000)));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return true;
  }
}

// Its status, where no host collects the children of its process.
std::pair<bool, int> collect(pid_t child) {
  int status = 0;
  pid_t waited = 0;
  do {
    waited = ::waitpid(child, &status, 0);
  } while (waited < 0 && errno == EINTR);
  return {waited == child, status};
}

ApartLimits allowed_limits(const ApartLimits& usual) {
  return {allowed(usual.memory), allowed(usual.answer), allowed(usual.cpu_s),
          allowed(usual.clock_s)};
}

Failure not_started(const char* what) {
  return apart_failure(std::string("needs a process of its own, and ") + what + ": " +
                       std::strerror(errno));
}

Failure too_slow(const ApartLimits& limits) {
  return apart_failure("takes more than " + std::to_string(limits.clock_s) + " s" + large_hint());
}

std::string ended_by(int status, const ApartLimits& limits) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU || signal == SIGKILL) {
      return signal == SIGXCPU ? "takes more than " + std::to_string(limits.cpu_s) +
                                     " s of computing" + large_hint()
                               : "was killed, perhaps because the memory ran out";
    }
    const char* name = ::sigabbrev_np(signal);
    return "makes its reader crash (" +
           (name == nullptr ? std::to_string(signal) : "SIG" + std::string(name)) + ")";
  }
  return "cannot be read within " + std::to_string(limits.memory >> 20) + " MiB of memory" +
         large_hint();
}

}  // namespace

Answer::~Answer() {
  if (data_ != nullptr) ::munmap(const_cast<char*>(data_), mapped_);
}

Answer::Answer(Answer&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), mapped_(other.mapped_), size_(other.size_) {}

Result<Answer> run_apart(const std::function<bool(const AnswerWriter&)>& work,
                         const ApartLimits& usual) {
  const ApartLimits limits = allowed_limits(usual);
  const Handle answer(::memfd_create("vlaprobe", MFD_CLOEXEC));
  if (answer.get() < 0) return not_started("no memory file can be made");
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return not_started("no pipe can be made");
  const Handle reading(ends[0]);
  Handle writing(ends[1]);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) return not_started("none can be started");
  if (child == 0) be_child(work, limits, answer.get(), writing.get(), parent);
  writing.close();

  const bool in_time = wait_for_end(reading.get(), limits.clock_s);
  if (!in_time) ::kill(child, SIGKILL);
  const auto [has_status, status] = collect(child);
  if (!in_time) return too_slow(limits);
  // Where a host collects the children of its process, the answer alone tells.
  if (has_status && (!WIFEXITED(status) || WEXITSTATUS(status) != 0)) {
    return apart_failure(ended_by(status, limits));
  }
  struct stat about {};
  if (::fstat(answer.get(), &about) != 0) return not_started("its answer cannot be read");
  const auto size = static_cast<std::size_t>(about.st_size);
  if (size < kDone.size()) return apart_failure(ended_by(W_EXITCODE(1, 0), limits));
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, answer.get(), 0);
  if (data == MAP_FAILED) return not_started("its answer cannot be read");
  const auto* bytes = static_cast<const char*>(data);
  Answer result(bytes, size, size - kDone.size());
  if (std::string_view(bytes + size - kDone.size(), kDone.size()) != kDone)
    return apart_failure("makes its reader end in the middle");
  return result;
}

Result<std::unique_ptr<ApartStream>> ApartStream::start(
    const std::function<bool(const AnswerWriter&)>& work, const ApartLimits& usual) {
  const ApartLimits limits = allowed_limits(usual);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return not_started("no pipe can be made");
  Handle reading(ends[0]), writing(ends[1]);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) return not_started("none can be started");
  if (child == 0) be_stream(work, limits, writing.get(), parent);
  return std::unique_ptr<ApartStream>(new ApartStream(reading.release(), child, limits));
}

ApartStream::~ApartStream() {
  if (pipe_ >= 0) ::close(pipe_);
  if (child_ < 0) return;
  ::kill(child_, SIGKILL);
  collect(child_);
}

Status ApartStream::read(std::span<char> bytes) {
  while (!bytes.empty()) {
    if (pipe_ < 0) return apart_failure("has been read to its end");
    if (!wait_for_end(pipe_, limits_.clock_s)) {
      ::close(std::exchange(pipe_, -1));
      return too_slow(limits_);
    }
    const ssize_t got = ::read(pipe_, bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) continue;
    if (got > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(got));
      continue;
    }
    ::close(std::exchange(pipe_, -1));
    const auto [has_status, status] = collect(std::exchange(child_, -1));
    const bool is_well = has_status && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    return apart_failure(is_well || !has_status ? "makes its reader end in the middle"
                                                : ended_by(status, limits_));
  }
  return {};
}

}  // namespace probe
