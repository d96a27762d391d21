#include "runtime/policy/query_meter.h"

#include <doctest/doctest.h>

#include <thread>
#include <vector>

using namespace probe;
using policy::QueryMeter;

namespace {

QueryMeter::Clock::time_point at(int milliseconds) {
  return QueryMeter::Clock::time_point(std::chrono::milliseconds(milliseconds));
}

}  // namespace

TEST_CASE("a server is busy while any query is there, and each waiting world waits") {
  QueryMeter meter(at(0));
  meter.begin(at(100));
  meter.begin(at(200));
  meter.end(at(400));
  meter.end(at(500));
  meter.begin(at(800));
  meter.end(at(900));
  const auto figures = meter.figures(at(1000));
  CHECK(figures.queries == 3);
  CHECK(figures.elapsed_s == doctest::Approx(1.0));
  CHECK(figures.busy_s == doctest::Approx(0.5));
  CHECK(figures.waiting_s == doctest::Approx(0.7));
  CHECK(figures.most_at_once == 2);
}

TEST_CASE("a query that has not ended counts as far as it got") {
  QueryMeter meter(at(0));
  meter.begin(at(250));
  CHECK(meter.figures(at(1000)).busy_s == doctest::Approx(0.75));
  CHECK(meter.figures(at(1000)).queries == 0);
  meter.end(at(1250));
  CHECK(meter.figures(at(2000)).busy_s == doctest::Approx(1.0));
}

TEST_CASE("clocks that were read in another order than reported never give a negative time") {
  QueryMeter meter(at(0));
  meter.begin(at(300));
  meter.begin(at(200));
  meter.end(at(250));
  meter.end(at(400));
  const auto figures = meter.figures(at(400));
  CHECK(figures.busy_s == doctest::Approx(0.1));
  CHECK(figures.waiting_s >= 0.1);
}

TEST_CASE("many threads report to one meter, and none is forgotten") {
  QueryMeter meter;
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&meter] {
      for (int query = 0; query < 500; ++query) const QueryMeter::InFlight flight(&meter);
    });
  }
  for (std::thread& thread : threads) thread.join();
  const QueryMeter::InFlight without(nullptr);
  const auto figures = meter.figures();
  CHECK(figures.queries == 4000);
  CHECK(figures.busy_s <= figures.elapsed_s);
  CHECK(figures.most_at_once <= 8);
}
