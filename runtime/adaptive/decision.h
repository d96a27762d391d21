// Whether a run has more successes than another one on the same starts, looked at after every start.
#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "runtime/adaptive/outcome.h"

namespace probe::adaptive {

// Starts, with all their seeds, are outcomes: the sign of the difference of successes. The evidence is
// that of stats/sequential.h, which may be looked at at any time, start by start instead of from the
// sums: a run looks after every episode. An episode that is invalid or was not attempted counts
// against whatever is to be decided.
class Decision {
 public:
  // One start: how each episode ended, and whether the other run's succeeded.
  using Start = std::span<const std::pair<Outcome, bool>>;
  void add(Start start);

  enum class Verdict : std::uint8_t { kOpen, kBetter, kWorse };
  // The first that was reached; at an error of 5 % it stays so.
  Verdict verdict() const { return verdict_; }
  // Anytime-valid p, and whose it is: 1 of more successes, -1 of fewer, 0 of neither.
  struct Claim {
    double p = 1;
    int side = 0;
  };
  Claim ever() const;  // 1 / the largest evidence so far: starts came in an order of their own
  Claim now() const;   // 1 / the evidence there is, in whatever order
  std::int64_t starts() const { return starts_; }
  // Starts that the run won and lost, those with an unknown episode in neither.
  std::int64_t won() const { return won_; }
  std::int64_t lost() const { return lost_; }

 private:
  struct Evidence {
    std::int64_t won = 0, lost = 0;
    double log = 0;      // of the two sides alike
    double largest = 0;  // while the side in question leads
    double now = 0;      // 0 while it does not
    void add(std::int64_t net, bool for_won);
  };
  Evidence better_, worse_;  // with what is unknown against either
  std::int64_t starts_ = 0, won_ = 0, lost_ = 0;
  Verdict verdict_ = Verdict::kOpen;
};

}  // namespace probe::adaptive
