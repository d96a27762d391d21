// Which of the changes in a failing case are needed for it to fail: delta debugging over the axes,
// each set of them judged by a sequential test, because a policy need not fail every time.
//
//   Minimal method({.axes = 6});                            // the axes that the case changes
//   while (!method.done()) method.tell(run(method.ask()));  // sets of changed axes in
//   const MinimalFinding found = method.finding();
//   if (found.status == MinimalStatus::kFound) say(found.set);
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "runtime/search/method/outcome.h"
#include "runtime/stats/intervals.h"

namespace probe::search {

using AxisSet =
    std::uint64_t;  // bit i: the i-th of the case's axes is changed, the others are put back

struct MinimalOptions {
  int axes = 0;  // 1..63
  // A set fails reliably at a failure rate of `fails` or more and does not at `passes` or less; of
  // rates between the two either may be said. `passes` lies above the failure rate of the own
  // point, `fails` below that of the case, as `confirm.h` found them.
  double passes = 0.3, fails = 0.7;
  double error = 0.05;   // that any set at all is judged wrongly
  int batch = 4;         // trials at once, at least
  int test_budget = 80;  // trials of one set; what is open then is kUnclear
  int budget = 1000;     // trials of all
};

enum class Verdict : std::uint8_t { kFails, kPasses, kUnclear, kLeftOut };

struct SetTried {
  AxisSet set = 0;
  stats::Count failures = {};
  int left_out = 0;
  Verdict verdict = Verdict::kUnclear;
  double log_ratio = 0;  // of the likelihoods at `fails` and at `passes`
};

enum class MinimalStatus : std::uint8_t {
  kRunning,
  kFound,            // fails, and with any one of its axes put back does not
  kFailsAtOwnPoint,  // fails with nothing changed
  kNotReliable,      // the case itself does not fail reliably
  kBudgetSpent,      // `set` still fails, but may be smaller; 0: it is not yet known whether the
                     // case itself fails reliably
};

struct MinimalFinding {
  MinimalStatus status = MinimalStatus::kRunning;
  AxisSet set = 0;  // the smallest that was judged to fail; 0 while none was
  // Of kFound: with some axis put back it was unclear or left out, not seen to pass, and so that
  // axis is needed only as far as one knows.
  AxisSet doubtful = 0;
  int trials = 0, left_out = 0;
  std::vector<SetTried> tried;  // in order
};

// ddmin (Zeller and Hildebrandt 2002, IEEE Transactions on Software Engineering 28:183), which ends
// with a set of which no single axis can be spared (1-minimal); of several such sets it finds one.
// A set is judged by Wald's sequential probability ratio test (1945, Annals of Mathematical
// Statistics 16:117) between the two rates. The k-th set has error / (k (k + 1)) of the error for
// either mistake: the sum is never more than `error`, however many sets there are, and by Ville's
// inequality it may be looked at after any batch.
class Minimal {
 public:
  explicit Minimal(const MinimalOptions& options);

  bool done() const { return finding_.status != MinimalStatus::kRunning; }
  std::span<const AxisSet> ask() const { return ask_; }  // one set, as often as it is to be tried
  void tell(std::span<const Outcome> outcomes);
  const MinimalFinding& finding() const { return finding_; }

 private:
  void go_on();
  const SetTried* judged(AxisSet set);
  void end(MinimalStatus status);
  std::vector<AxisSet> parts() const;

  MinimalOptions options_;
  MinimalFinding finding_;
  std::map<AxisSet, std::size_t> index_;  // into finding_.tried
  std::vector<AxisSet> ask_;
  int granularity_ = 2;      // ddmin's n
  bool open_ = false;        // the last of finding_.tried is being judged
  bool is_cutting_ = false;  // the case fails and the own point does not
};

}  // namespace probe::search
