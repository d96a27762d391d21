// A run that somebody writes, seen while it grows: counts, rates, pace, time left, newest failures.
// Reads folders and nothing else, so it works on another machine than the run does.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/base/result.h"
#include "runtime/stats/intervals.h"
#include "runtime/store/episode_key.h"

namespace probe::follow {

struct Failure {
  std::string dir;  // whose row it is
  store::EpisodeKey key;
  std::string why;     // invalid: the reason; else that it did not succeed
  double ended_s = 0;  // since 1970, when its trace was written
};

struct Seen {
  std::string dir;
  std::int64_t rows = 0, invalid = 0, not_attempted = 0;
  std::optional<std::int64_t> chosen;  // by the newest calls; not of folders of older programs
  bool is_about = false;               // some shards have not begun: `chosen` is scaled up
  bool is_written = false;             // by a process of this machine
  std::string until;                   // what it stops by: rates have no interval then
  int shards = 0, begun = 0;           // below DIR/shards; 0: it is one run
  int merged = 0;                      // of them, whose folders are gone: their rows are DIR's own
  std::vector<std::pair<std::string, stats::Count>> rates;  // truths of valid episodes
  std::vector<Failure> newest;                              // the newest first
  double per_s = 0;                                         // episodes, of the last minutes; 0: unknown

  // Never while something is written: rows of earlier calls count, too.
  bool is_done() const {
    return chosen && !is_about && !is_written && rows >= *chosen && begun == shards;
  }
  // Not of a run that stops by what it finds.
  std::optional<double> left_s() const;
};

class Following {
 public:
  // A run's folder, or one with `shards/I-of-N` below it.
  explicit Following(std::string dir) : dir_(std::move(dir)) {}

  // What is there now; `now` in seconds of a clock that goes forward. Folders whose database is as
  // it was are not read again. A folder that is not there yet has no rows. Fails as read_results().
  Result<Seen> look(double now);

 private:
  // Of a row what counts, since one of a shard may stand in the merged run as well.
  struct Row {
    std::uint64_t episode = 0;  // of the hash of its key
    enum class Is : std::uint8_t { kValid, kInvalid, kNotAttempted } is = Is::kValid;
    std::uint64_t known = 0, true_ = 0;  // by metric of names_
  };
  struct Folder {
    std::string stamp;  // of its database when it was read
    std::string until;  // RunIdentity::until
    std::vector<Row> rows;
    std::vector<Failure> newest;                      // as of that reading
    std::unordered_map<std::string, double> written;  // when, by trace of a failure
  };
  Status read(const std::string& dir, Folder& folder);
  void count(const Row& row, Seen& seen) const;

  std::string dir_;
  std::vector<std::string> names_;  // of metrics that are truths
  std::map<std::string, Folder> folders_;
  std::deque<std::pair<double, std::int64_t>> pace_;  // when, rows
};

// For people: a line with counts, pace and time left; one a rate; the newest failures with the
// command that explains each.
std::vector<std::string> to_lines(const Seen& seen);
// For the page, and `--json`.
Json to_json(const Seen& seen);

// "40 s", "12 min", "3 h 05 min".
std::string duration_text(double seconds);

}  // namespace probe::follow
