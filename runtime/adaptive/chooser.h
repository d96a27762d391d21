// Which episode of a run that stops by what it finds is run next. Pure: places of an order and what
// became of them, no folders and no threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "runtime/adaptive/decision.h"
#include "runtime/adaptive/outcome.h"
#include "runtime/adaptive/rule.h"
#include "runtime/stats/without_replacement.h"

namespace probe::adaptive {

// One place of the order.
struct Planned {
  std::uint32_t task = 0;   // any number that tells tasks apart
  std::uint32_t start = 0;  // within the task; of a decision all of a start stand together
  Outcome outcome = Outcome::kAbsent;
  bool other = false;  // of a decision: whether the other run succeeded
};

// Hands out the first place that is still absent of the task (of all tasks, where the rule is not of
// each) whose interval is the widest, until none is too wide. Of what is under way it supposes that it
// ends as the others did, so that a task is not given more worlds than it seems to need; when they end
// otherwise it goes on. A task of which an episode is not attempted is run whole, since how many others
// would not be is not known. The same outcomes give the same choice, whoever ran them.
//
// What is counted is always a beginning of the order (sampled.h), for all of whose lengths the
// intervals hold together; so it does no harm that episodes end out of turn, or that those which are
// under way when the last one ends were not needed.
class Chooser {
 public:
  Chooser(const Rule& rule, std::vector<Planned> order);

  // Its place, which is under way from now on. Nothing: none is needed now; when some are under way,
  // one may be later.
  std::optional<std::size_t> next();
  bool wants_more() const { return !open_.empty(); }
  std::size_t under_way() const { return under_way_; }
  // How it ended; a place may be told again (an episode that was shown to be another policy's).
  void tell(std::size_t place, Outcome outcome);
  const std::vector<Planned>& order() const { return order_; }
  const Decision& decision() const { return decision_; }  // of the rule that is one

 private:
  // The places of one task, or all of them.
  struct List {
    std::vector<std::size_t> places;
    std::size_t next = 0;  // all before are ended or under way
    std::int64_t successes = 0, failures = 0, unknown = 0, not_attempted = 0;  // of these
    double width = 1;      // as it seems to become; none is needed where it is not in open_
  };
  void count(List& list, Outcome outcome, std::int64_t by);
  void advance(List& list);
  void measure(std::size_t list);
  void judge();

  Rule rule_;
  std::vector<Planned> order_;
  std::vector<List> lists_;
  std::vector<std::size_t> list_of_;    // by place
  std::vector<std::size_t> index_of_;   // by place: within its list
  std::set<std::pair<double, std::size_t>> open_;  // less width, list: the widest first
  std::size_t under_way_ = 0;
  Decision decision_;
  std::size_t judged_ = 0;  // places that the decision has
};

}  // namespace probe::adaptive
