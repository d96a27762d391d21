// How well a policy's server and the simulators are kept busy: all connections of a run report the
// begin and the end of each query here. Knows nothing of protocols.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>

namespace probe::policy {

// Times in seconds of wall clock since the meter was made.
struct QueryFigures {
  std::int64_t queries = 0;  // ended
  double elapsed_s = 0;
  double busy_s = 0;     // at least one query was at the server
  double waiting_s = 0;  // worlds that waited for an answer, summed over worlds
  int most_at_once = 0;
  // Of servers that are asked in batches: messages, and how long worlds waited for the others of
  // theirs before it went, summed over worlds; that time is not part of waiting_s.
  std::int64_t batches = 0;
  int most_in_batch = 0;
  double gathering_s = 0;
};

// Any thread may call any method at any time.
class QueryMeter {
 public:
  using Clock = std::chrono::steady_clock;

  explicit QueryMeter(Clock::time_point now = Clock::now()) : made_(now), changed_(now) {}

  // Each begin() is followed by one end(); InFlight sees to that.
  void begin(Clock::time_point now = Clock::now());
  void end(Clock::time_point now = Clock::now());
  // One message with that many queries, each of which has its own begin() and end().
  void add_batch(int queries, double gathering_s);

  // Queries that have not ended count as far as they got.
  QueryFigures figures(Clock::time_point now = Clock::now()) const;

  // From the first byte sent to the last one received of one message with some queries. Without a
  // meter it does nothing.
  class InFlight {
   public:
    explicit InFlight(QueryMeter* meter, int queries = 1) : meter_(meter), queries_(queries) {
      for (int i = 0; meter_ != nullptr && i < queries_; ++i) meter_->begin();
    }
    ~InFlight() {
      for (int i = 0; meter_ != nullptr && i < queries_; ++i) meter_->end();
    }
    InFlight(const InFlight&) = delete;
    InFlight& operator=(const InFlight&) = delete;

   private:
    QueryMeter* meter_;
    int queries_;
  };

 private:
  void advance(QueryFigures& figures, Clock::time_point now) const;

  mutable std::mutex mutex_;
  Clock::time_point made_;
  Clock::time_point changed_;  // figures_ hold what was until then
  int in_flight_ = 0;
  QueryFigures figures_;
};

}  // namespace probe::policy
