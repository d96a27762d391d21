// When a run that does not do all its episodes stops: the words behind `--until`, and what a folder
// keeps of them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "runtime/base/result.h"
#include "runtime/base/sha256.h"

namespace probe::adaptive {

// The confidence of every interval, and 1 - the error of a decision.
inline constexpr double kConfidence = 0.95;

struct Rule {
  enum class Kind : std::uint8_t {
    kEachTask,  // the interval of each task's rate of success is at most so wide
    kAllTasks,  // that of all tasks together
    kDecided,   // that the run or the one in `dir` has more successes on the same starts is decided
  };
  Kind kind = Kind::kEachTask;
  double points = 0;     // of a width, in percent: above 0 and below 100
  std::string dir;       // as it was given, of no meaning to the folder
  std::string against;   // the policy of the run in `dir`
  std::string outcomes;  // 16 hexadecimal digits of a hash over what that run found

  // Ends of intervals are quotients: what is within 1e-9 of the width has it.
  bool is_narrow(double width) const { return width <= points / 100 + 1e-9; }
};

// "width 10%", "width 2.5% of all", "decided-against DIR". Fails (kUsage) on other words, and on a
// width that is none or needs no episode. `against` and `outcomes` stay empty.
Result<Rule> parse_rule(const std::string& text);

// RunIdentity::until: "width 10 % of each task", "decided against `expert` (outcomes 3f..)".
std::string to_text(const Rule& rule);
// For people: without the outcomes.
std::string in_words(const std::string& until);
// The same read again; fails (kStore, at `where`) on what no program of this version writes.
Result<Rule> rule_from_text(const std::string& text, const std::string& where);

// What the order is sorted by: a hash that nobody can know the outcome by, so that every beginning
// of the order is a sample drawn beforehand. Of a decision all seeds of a start stand together,
// since a start is what one side wins. Tasks may have the same episodes under other names, with the
// same outcomes: their orders are not to be the same.
Sha256 rank_of(Rule::Kind kind, std::string_view task, const Sha256& episode_id, int seed);

}  // namespace probe::adaptive
