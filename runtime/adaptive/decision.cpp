#include "runtime/adaptive/decision.h"

#include <algorithm>
#include <cmath>

#include "runtime/adaptive/rule.h"

namespace probe::adaptive {

void Decision::add(Start start) {
  std::int64_t net = 0, unknown = 0;
  for (const auto& [outcome, other] : start) {
    if (outcome != Outcome::kSuccess && outcome != Outcome::kFailure) ++unknown;
    net += (outcome == Outcome::kSuccess ? 1 : 0) - (other ? 1 : 0);
  }
  ++starts_;
  if (unknown == 0) {
    won_ += net > 0 ? 1 : 0;
    lost_ += net < 0 ? 1 : 0;
  }
  better_.add(net, true);
  worse_.add(net + unknown, false);
  const double limit = -std::log(1 - kConfidence);
  if (verdict_ != Verdict::kOpen) return;
  if (better_.largest >= limit) verdict_ = Verdict::kBetter;
  if (worse_.largest >= limit) verdict_ = Verdict::kWorse;
}

// One start more multiplies 2^n B(w + 1/2, l + 1/2) by 2 (w + 1/2) / (w + l + 1) where it is won.
void Decision::Evidence::add(std::int64_t net, bool for_won) {
  if (net == 0) return;
  std::int64_t& side = net > 0 ? won : lost;
  log += std::log((2 * static_cast<double>(side) + 1) / (static_cast<double>(won + lost) + 1));
  ++side;
  now = (for_won ? won > lost : lost > won) ? std::max(0.0, log) : 0;
  largest = std::max(largest, now);
}

namespace {

Decision::Claim claim_of(double better, double worse) {
  const double most = std::max(better, worse);
  return {std::exp(-most), most == 0 ? 0 : better >= worse ? 1 : -1};
}

}  // namespace

Decision::Claim Decision::ever() const { return claim_of(better_.largest, worse_.largest); }
Decision::Claim Decision::now() const { return claim_of(better_.now, worse_.now); }

}  // namespace probe::adaptive
