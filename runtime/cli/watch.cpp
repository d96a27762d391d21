#include "runtime/cli/watch.h"

#include <signal.h>
#include <sys/stat.h>
#include <time.h>

#include <utility>

namespace probe::cli {
namespace {

// File times come from a clock that ticks every few milliseconds.
constexpr std::int64_t kClockTick_ns = 20'000'000;

std::int64_t to_ns(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

sigset_t leaving() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

}  // namespace

FileWatch::Stamp FileWatch::stamp_of(const std::string& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return {};
  return {to_ns(info.st_mtim), std::int64_t{info.st_size}, std::uint64_t{info.st_ino}};
}

void FileWatch::begin() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  begun_ns_ = to_ns(now);
}

void FileWatch::watch(const std::vector<std::string>& paths) {
  std::map<std::string, Stamp> stamps;
  for (const std::string& path : paths) {
    const auto known = stamps_.find(path);
    Stamp stamp = known != stamps_.end() ? known->second : stamp_of(path);
    if (known == stamps_.end() && stamp.time_ns > begun_ns_ - kClockTick_ns) stamp.inode = 0;
    stamps.emplace(path, stamp);
  }
  stamps_ = std::move(stamps);
}

std::vector<std::string> FileWatch::changed() {
  std::vector<std::string> found;
  for (auto& [path, stamp] : stamps_) {
    const Stamp now = stamp_of(path);
    if (!(now == stamp)) found.push_back(path);
    stamp = now;
  }
  return found;
}

Interrupt::Interrupt() {
  const sigset_t set = leaving();
  sigprocmask(SIG_BLOCK, &set, nullptr);
}

Interrupt::~Interrupt() {
  const sigset_t set = leaving();
  sigprocmask(SIG_UNBLOCK, &set, nullptr);
}

bool Interrupt::wait(std::chrono::milliseconds time) const {
  const sigset_t set = leaving();
  const timespec timeout{static_cast<time_t>(time.count() / 1000),
                         static_cast<long>(time.count() % 1000) * 1'000'000};
  return sigtimedwait(&set, nullptr, &timeout) > 0;
}

}  // namespace probe::cli
