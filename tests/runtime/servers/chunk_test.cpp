// Chunks: how many of an answer are done, and what several answers make together.
#include "runtime/servers/chunk.h"

#include <doctest/doctest.h>

namespace probe::servers {
namespace {

std::vector<RawAction> counted(int count, double first) {
  std::vector<RawAction> actions(static_cast<std::size_t>(count), RawAction(7));
  for (std::size_t i = 0; i < actions.size(); ++i) actions[i][0] = first + static_cast<double>(i);
  return actions;
}

}  // namespace

TEST_CASE("a chunk is done without another question") {
  ChunkQueue queue(Profile{});
  CHECK(queue.wants_answer());
  REQUIRE(queue.put(counted(3, 10)).ok());
  for (const double expected : {10.0, 11.0, 12.0}) {
    REQUIRE_FALSE(queue.wants_answer());
    CHECK(queue.take()[0] == expected);
  }
  CHECK(queue.wants_answer());
}

TEST_CASE("the profile says how many of a chunk are done") {
  Profile profile;
  profile.chunk_use = 2;
  ChunkQueue queue(profile);
  REQUIRE(queue.put(counted(5, 0)).ok());
  CHECK(queue.take()[0] == 0);
  CHECK(queue.take()[0] == 1);
  CHECK(queue.wants_answer());
  REQUIRE(queue.put(counted(5, 20)).ok());
  CHECK(queue.take()[0] == 20);
  queue.clear();
  CHECK(queue.wants_answer());
  CHECK(queue.put(counted(1, 0)).failure().message ==
        "expected at least 2 actions, got 1 (profile field `chunk.use`)");
}

TEST_CASE("a chunk of another length than the profile's is refused") {
  Profile profile;
  profile.chunk_length = 4;
  ChunkQueue queue(profile);
  CHECK(queue.put(counted(3, 0)).failure().message ==
        "expected a chunk of 4 actions, got 3 (profile field `chunk.length`)");
  CHECK(queue.put(counted(4, 0)).ok());
}

// SimplerEnv's ActionEnsembler of horizon 3: weights exp(-temperature * i), the oldest first.
TEST_CASE("an ensemble is the mean of all answers' predictions, weighed by age") {
  Profile profile;
  profile.ensemble = Ensemble::kTemporal;
  profile.ensemble_ratio = 2;
  ChunkQueue queue(profile);
  REQUIRE(queue.put(counted(3, 0)).ok());  // predicts 0, 1, 2
  CHECK(queue.take()[0] == 0);
  CHECK(queue.wants_answer());
  REQUIRE(queue.put(counted(3, 10)).ok());  // 10, 11, 12
  CHECK(queue.take()[0] == doctest::Approx((1 * 1 + 2 * 10) / 3.0));
  REQUIRE(queue.put(counted(3, 20)).ok());
  CHECK(queue.take()[0] == doctest::Approx((1 * 2 + 2 * 11 + 4 * 20) / 7.0));
  REQUIRE(queue.put(counted(3, 30)).ok());  // the first answer has nothing more to say
  CHECK(queue.take()[0] == doctest::Approx((1 * 12 + 2 * 21 + 4 * 30) / 7.0));
}

}  // namespace probe::servers
