#include "runtime/stats/rank_agreement.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace probe::stats {

// By hand: 2 and 3 have changed places, and each misses the other by 0.3; 1 is right.
TEST_CASE("a policy's rank violation is the largest real difference that the simulation turns round") {
  const std::vector<double> real = {0.9, 0.5, 0.2}, turned = {0.8, 0.1, 0.4};
  CHECK(mean_max_rank_violation(real, turned) == doctest::Approx((0.0 + 0.3 + 0.3) / 3));
  CHECK(mean_max_rank_violation(real, real) == 0);
  const std::vector<double> upside_down = {0.1, 0.5, 0.9};
  CHECK(mean_max_rank_violation(real, upside_down) == doctest::Approx((0.7 + 0.4 + 0.7) / 3));
  CHECK(mean_max_rank_violation({}, {}) == 0);
}

// R_1 > R_2 while neither S is larger: the pair (1, 2) is violated, (2, 1) is not.
TEST_CASE("a tie in the simulation misses an order in one of its directions") {
  const std::vector<double> real = {0.6, 0.2}, tied = {0.5, 0.5};
  CHECK(mean_max_rank_violation(real, tied) == doctest::Approx(0.4 / 2));
  CHECK(mean_max_rank_violation(tied, real) == 0);  // equal in reality: nothing is lost
}

TEST_CASE("Pearson's correlation is 1 on a rising line, -1 on a falling one, and none of a constant") {
  const std::vector<double> real = {0.1, 0.4, 0.7}, half = {0.05, 0.2, 0.35},
                            falling = {0.7, 0.4, 0.1}, flat = {0.3, 0.3, 0.3};
  CHECK(*pearson(real, half) == doctest::Approx(1));
  CHECK(*pearson(real, falling) == doctest::Approx(-1));
  CHECK_FALSE(pearson(real, flat));
  CHECK_FALSE(pearson(std::vector<double>{0.1}, std::vector<double>{0.2}));
  // cor(c(1, 2, 4), c(1, 3, 2)) = 1.0 / sqrt(4.6667 * 2) by hand: 1/3.0551
  CHECK(*pearson(std::vector<double>{1, 2, 4}, std::vector<double>{1, 3, 2}) ==
        doctest::Approx(1 / std::sqrt(14.0 / 3 * 2)));
}

TEST_CASE("more trials narrow what the agreement of policies could be, and the same trials say the same") {
  const auto at = [](double trials) {
    const std::vector<MeasuredRate> real = {{0.9, trials}, {0.6, trials}, {0.3, trials}, {0.0, trials}},
                                    simulated = {{0.8, trials}, {0.5, trials}, {0.4, trials}, {0.1, trials}};
    return rank_agreement(real, simulated);
  };
  const Agreement few = at(25), many = at(2500);
  CHECK(few.violation == 0);
  REQUIRE(few.correlation_by_trials);
  CHECK(few.correlation_by_trials->low < *few.correlation);
  CHECK(*few.correlation < few.correlation_by_trials->high + 0.02);
  CHECK(many.correlation_by_trials->high - many.correlation_by_trials->low <
        0.3 * (few.correlation_by_trials->high - few.correlation_by_trials->low));
  CHECK(many.violation_by_trials->high == 0);
  CHECK(few.violation_by_trials->high > 0);
  CHECK(at(25).violation_by_trials->high == few.violation_by_trials->high);
  REQUIRE(few.violation_by_policies);
  CHECK(few.violation_by_policies->high == 0);
}

TEST_CASE("rates whose trials nobody says have no interval, and three policies leave none out") {
  const std::vector<MeasuredRate> real = {{0.9, 25}, {0.6, 25}, {0.3, 25}},
                                  simulated = {{0.8, 0}, {0.5, 0}, {0.4, 0}};
  const Agreement agreement = rank_agreement(real, simulated);
  CHECK(agreement.violation == 0);
  CHECK_FALSE(agreement.violation_by_trials);
  CHECK_FALSE(agreement.violation_by_policies);
}

}  // namespace probe::stats
