// Episodes that a policy of ours has no skill for: a status of its own, since asking again changes
// nothing and no start was failed. Its reasons as data, for everyone who tells of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/store/results.h"

namespace probe::store {

// How `invalid` begins in their rows; the reason follows.
inline constexpr std::string_view kNotAttempted = "not attempted: ";
bool is_not_attempted(const ResultRow& row);
bool is_not_attempted(std::string_view invalid);  // what a row has there
// Whether doing the episode again could change the row: it is neither valid nor not attempted.
bool is_open(const ResultRow& row);

class NotAttempted {
 public:
  struct Reason {
    std::string text;
    int episodes = 0;
  };

  // Counts the row if it was not attempted.
  void add(const ResultRow& row);
  void add(const NotAttempted& others);
  int count() const { return count_; }
  // The most frequent first, equal ones in the order of their first episodes.
  std::vector<Reason> reasons() const;

 private:
  void add(std::string_view reason, int episodes);

  std::vector<Reason> reasons_;
  int count_ = 0;
};

// The reason; where there are several, the first few with their counts:
// "3: no solution in skills for this goal; 1: skill 1 `open chest.drawer`: ...; 5 for other ones".
std::string to_text(const NotAttempted& episodes);

}  // namespace probe::store
