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

[[noreturn]] void be_child(const std::function<bool(const AnswerWriter&)>& work,
                           const ApartLimits& limits, int answer, int pipe, pid_t parent) {
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
  close_but(answer, pipe);
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, static_cast<std::size_t>(limits.cpu_s));
  set_limit(RLIMIT_FSIZE, limits.answer + kDone.size());
#ifndef __SANITIZE_ADDRESS__  // whose shadow is larger than any limit
  set_limit(RLIMIT_AS, address_space() + limits.memory);
#endif
  try {
    const AnswerWriter write = [answer](std::string_view bytes) {
      return write_all(answer, bytes);
    };
    if (work(write) && write(kDone)) ::_exit(0);
  } catch (const std::exception&) {
  }
  ::_exit(1);
}

// ---- in the parent

// Whether the other end was closed in time.
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

std::string ended_by(int status, const ApartLimits& limits) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU || signal == SIGKILL) {
      return signal == SIGXCPU
                 ? "takes more than " + std::to_string(limits.cpu_s) + " s of computing"
                 : "was killed, perhaps because the memory ran out";
    }
    const char* name = ::sigabbrev_np(signal);
    return "makes its reader crash (" +
           (name == nullptr ? std::to_string(signal) : "SIG" + std::string(name)) + ")";
  }
  return "cannot be read within " + std::to_string(limits.memory >> 20) + " MiB of memory";
}

}  // namespace

Answer::~Answer() {
  if (data_ != nullptr) ::munmap(const_cast<char*>(data_), mapped_);
}

Answer::Answer(Answer&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), mapped_(other.mapped_), size_(other.size_) {}

Result<Answer> run_apart(const std::function<bool(const AnswerWriter&)>& work,
                         const ApartLimits& limits) {
  const auto refused = [](const char* what) {
    return apart_failure(std::string("needs a process of its own, and ") + what + ": " +
                         std::strerror(errno));
  };
  const Handle answer(::memfd_create("vlaprobe", MFD_CLOEXEC));
  if (answer.get() < 0) return refused("no memory file can be made");
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return refused("no pipe can be made");
  const Handle reading(ends[0]);
  Handle writing(ends[1]);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) return refused("none can be started");
  if (child == 0) be_child(work, limits, answer.get(), writing.get(), parent);
  writing.close();

  const bool in_time = wait_for_end(reading.get(), limits.clock_s);
  if (!in_time) ::kill(child, SIGKILL);
  int status = 0;
  pid_t waited = 0;
  do {
    waited = ::waitpid(child, &status, 0);
  } while (waited < 0 && errno == EINTR);
  if (!in_time) return apart_failure("takes more than " + std::to_string(limits.clock_s) + " s");
  // Where a host collects the children of its process, the answer alone tells.
  if (waited == child && (!WIFEXITED(status) || WEXITSTATUS(status) != 0)) {
    return apart_failure(ended_by(status, limits));
  }
  struct stat about {};
  if (::fstat(answer.get(), &about) != 0) return refused("its answer cannot be read");
  const auto size = static_cast<std::size_t>(about.st_size);
  if (size < kDone.size()) return apart_failure(ended_by(W_EXITCODE(1, 0), limits));
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, answer.get(), 0);
  if (data == MAP_FAILED) return refused("its answer cannot be read");
  const auto* bytes = static_cast<const char*>(data);
  Answer result(bytes, size, size - kDone.size());
  if (std::string_view(bytes + size - kDone.size(), kDone.size()) != kDone)
    return apart_failure("makes its reader end in the middle");
  return result;
}

}  // namespace probe
