// Notices that files changed, by asking for their times: works on any file system and with editors
// that write a new file and rename it. Knows nothing of what the files are.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace probe::cli {

class FileWatch {
 public:
  // Before the files are read: what changes from now on counts as a change.
  void begin();
  // After they were read: these are watched from now on, folders included. One that is new here and
  // was written after begin() counts as changed, as it may have been read before that.
  void watch(const std::vector<std::string>& paths);
  // Those that differ from when they were last looked at here; takes the new state over.
  std::vector<std::string> changed();

 private:
  struct Stamp {
    std::int64_t time_ns = -1;  // -1: not there
    std::int64_t size = 0;
    std::uint64_t inode = 0;
    bool operator==(const Stamp&) const = default;
  };
  static Stamp stamp_of(const std::string& path);

  std::int64_t begun_ns_ = 0;
  std::map<std::string, Stamp> stamps_;
};

// Blocks SIGINT and SIGTERM while it lives, so that a loop can ask for them between two steps.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  // Sleeps for that long; true, and at once, when the user wants to leave.
  bool wait(std::chrono::milliseconds time) const;
};

}  // namespace probe::cli
