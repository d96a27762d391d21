// A run that somebody writes, seen while it grows: counts, rates, pace, time left, newest failures.
// Reads folders and nothing else, so it works on another machine than the run does.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <unordered_set>
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
  int shards = 0, begun = 0;           // below DIR/shards; 0: it is one run
  std::vector<std::pair<std::string, stats::Count>> rates;  // truths of valid episodes
  std::vector<Failure> newest;                              // the newest first
  double per_s = 0;                                         // episodes, of the last minutes; 0: unknown

  // Never while something is written: rows of earlier calls count, too.
  bool is_done() const {
    return chosen && !is_about && !is_written && rows >= *chosen && begun == shards;
  }
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
  struct Folder {
    std::string stamp;  // of its database when it was read
    std::int64_t rows = 0, invalid = 0, not_attempted = 0;
    std::vector<std::pair<std::string, stats::Count>> rates;
  };
  Status read(const std::string& dir, Folder& folder);
  void add_failure(const std::string& dir, store::EpisodeKey key, std::string why,
                   const std::string& trace);

  std::string dir_;
  std::map<std::string, Folder> folders_;
  std::unordered_set<std::string> known_;  // failures
  std::vector<Failure> newest_;
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
