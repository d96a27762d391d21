#include "runtime/stats/bradley_terry.h"

#include <doctest/doctest.h>

namespace probe::stats {

// The 1987 American League, eastern division, in Agresti, Categorical Data Analysis, 10.6.2:
// strengths against Baltimore 1.58, 1.44, 1.29, 1.25, 1.11, 0.68; standard errors by R 4.2.2's glm.
TEST_CASE("strengths equal the published ones of a baseball season") {
  Eigen::MatrixXd wins(7, 7);
  wins << 0, 7, 9, 7, 7, 9, 11,  //
      6, 0, 7, 5, 11, 9, 9,      //
      4, 6, 0, 7, 7, 8, 12,      //
      6, 8, 6, 0, 6, 7, 10,      //
      6, 2, 6, 7, 0, 7, 12,      //
      4, 4, 5, 6, 6, 0, 6,       //
      2, 4, 1, 3, 1, 7, 0;
  const auto ranking = bradley_terry(wins, 0);
  REQUIRE(ranking.ok());
  const double against_last[] = {1.5813559, 1.4364084, 1.2944851, 1.2476178,
                                 1.1076977, 0.6838528, 0};
  const double error[] = {0.207419458, 0.204156540, 0.202061505, 0.201603732,
                          0.200919057, 0.205044304, 0.232462182};
  for (int i = 0; i < 7; ++i) {
    CHECK(ranking->strength(i) - ranking->strength(6) ==
          doctest::Approx(against_last[i]).epsilon(1e-6));
    CHECK(ranking->standard_error(i) == doctest::Approx(error[i]).epsilon(1e-6));
  }
}

TEST_CASE("a policy that never lost has a finite strength with a prior and none without") {
  Eigen::MatrixXd wins(3, 3);
  wins << 0, 10, 10, 0, 0, 6, 0, 4, 0;
  const auto with_prior = bradley_terry(wins);
  REQUIRE(with_prior.ok());
  CHECK(with_prior->strength(0) > with_prior->strength(1));
  CHECK(with_prior->strength(1) > with_prior->strength(2));
  CHECK_FALSE(bradley_terry(wins, 0).ok());
}

TEST_CASE("policies that never met the others cannot be ranked") {
  Eigen::MatrixXd wins = Eigen::MatrixXd::Zero(4, 4);
  wins(0, 1) = 3;
  wins(2, 3) = 2;
  const auto ranking = bradley_terry(wins);
  REQUIRE_FALSE(ranking.ok());
  CHECK(ranking.failure().message.find("not linked") != std::string::npos);
}

}  // namespace probe::stats
