// Two integrals over time: of "some query is in flight" and of how many are.
#include "runtime/policy/query_meter.h"

#include <algorithm>

namespace probe::policy {
namespace {

double seconds(QueryMeter::Clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

void QueryMeter::advance(QueryFigures& figures, Clock::time_point now) const {
  // Two threads may read the clock in one order and come here in the other.
  const double passed = std::max(0.0, seconds(now - changed_));
  if (in_flight_ > 0) figures.busy_s += passed;
  figures.waiting_s += passed * in_flight_;
}

void QueryMeter::begin(Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  advance(figures_, now);
  changed_ = std::max(changed_, now);
  figures_.most_at_once = std::max(figures_.most_at_once, ++in_flight_);
}

void QueryMeter::end(Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  advance(figures_, now);
  changed_ = std::max(changed_, now);
  --in_flight_;
  ++figures_.queries;
}

void QueryMeter::add_batch(int queries, double gathering_s) {
  const std::lock_guard lock(mutex_);
  ++figures_.batches;
  figures_.most_in_batch = std::max(figures_.most_in_batch, queries);
  figures_.gathering_s += gathering_s;
}

QueryFigures QueryMeter::figures(Clock::time_point now) const {
  const std::lock_guard lock(mutex_);
  QueryFigures figures = figures_;
  advance(figures, now);
  figures.elapsed_s = std::max(0.0, seconds(std::max(now, changed_) - made_));
  return figures;
}

}  // namespace probe::policy
