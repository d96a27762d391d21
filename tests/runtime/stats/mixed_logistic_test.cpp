#include "runtime/stats/mixed_logistic.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/stats/laplace.h"

namespace probe::stats {
namespace {

using Columns = std::vector<std::vector<double>>;

// A table of numbers after a comment line and a line of names, by column.
Columns read_table(const std::string& name) {
  std::ifstream in(std::string(VLAPROBE_SOURCE_DIR) + "/tests/runtime/stats/data/" + name);
  REQUIRE(in.good());
  std::string line;
  std::getline(in, line);
  std::getline(in, line);
  Columns columns;
  while (std::getline(in, line)) {
    std::stringstream cells(line);
    std::string cell;
    for (std::size_t i = 0; std::getline(cells, cell, ','); ++i) {
      if (columns.size() <= i) columns.resize(i + 1);
      columns[i].push_back(std::stod(cell));
    }
  }
  return columns;
}

// An intercept and, for each column of `factors`, a 0/1 column a level but its first: R's treatment
// contrasts.
Eigen::MatrixXd treatment(const Columns& table,
                          const std::vector<std::pair<std::size_t, int>>& factors) {
  const auto n = static_cast<Eigen::Index>(table[0].size());
  Eigen::Index p = 1;
  for (const auto& [column, levels] : factors) p += levels - 1;
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(n, p);
  x.col(0).setOnes();
  Eigen::Index first = 1;
  for (const auto& [column, levels] : factors) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const int level = static_cast<int>(table[column][static_cast<std::size_t>(i)]);
      if (level > 0) x(i, first + level - 1) = 1;
    }
    first += levels - 1;
  }
  return x;
}

MixedData data_of(const Columns& table, Eigen::MatrixXd fixed,
                  const std::vector<std::size_t>& groups) {
  MixedData data;
  data.fixed = std::move(fixed);
  data.successes = Eigen::Map<const Eigen::VectorXd>(table[0].data(), data.fixed.rows());
  data.trials = Eigen::Map<const Eigen::VectorXd>(table[1].data(), data.fixed.rows());
  for (const std::size_t column : groups) {
    data.groups.emplace_back(table[column].begin(), table[column].end());
  }
  return data;
}

void check_near(const Eigen::VectorXd& got, const std::vector<double>& wanted) {
  REQUIRE(got.size() == static_cast<Eigen::Index>(wanted.size()));
  for (Eigen::Index i = 0; i < got.size(); ++i) {
    CAPTURE(i);
    CHECK(std::abs(got(i) - wanted[static_cast<std::size_t>(i)]) < 1e-3);
  }
}

// Reference values: R 4.2.2, lme4 1.1.31, glmer(cbind(successes, trials - successes) ~ ...,
// binomial) with the bobyqa optimiser, rhoend 1e-8, tolPwrss 1e-10.
void check_fit(const MixedData& data, const std::vector<double>& fixed,
               const std::vector<double>& errors, const std::vector<double>& random_sd,
               double log_likelihood) {
  const auto fit = fit_mixed_logistic(data);
  REQUIRE_MESSAGE(fit.ok(), fit.failure().message);
  check_near(fit->fixed, fixed);
  check_near(fit->covariance.diagonal().cwiseSqrt(), errors);
  check_near(fit->random_sd, random_sd);
  double coefficients = 0;
  for (Eigen::Index i = 0; i < data.trials.size(); ++i) {
    coefficients += std::lgamma(data.trials(i) + 1) - std::lgamma(data.successes(i) + 1) -
                    std::lgamma(data.trials(i) - data.successes(i) + 1);
  }
  CHECK(std::abs(fit->log_likelihood + coefficients - log_likelihood) < 1e-3);
  MESSAGE("evaluations: " << fit->evaluations);
  const auto again = fit_mixed_logistic(data);
  REQUIRE(again.ok());
  CHECK(again->fixed == fit->fixed);
  CHECK(again->covariance == fit->covariance);
  CHECK(again->random_sd == fit->random_sd);
}

MixedData benchmark() {
  const Columns t = read_table("benchmark.csv");
  return data_of(t, treatment(t, {{2, 3}, {3, 4}}), {4, 5, 6});
}

}  // namespace

TEST_CASE("one random factor agrees with lme4: pleuropneumonia in herds") {
  const Columns t = read_table("cbpp.csv");
  check_fit(data_of(t, treatment(t, {{2, 4}}), {3}),
            {-1.39853214, -0.99233271, -1.12867207, -1.58031383},
            {0.23247186, 0.30664225, 0.32663752, 0.42743626}, {0.64226145}, -92.02628187);
}

TEST_CASE("two crossed random factors agree with lme4") {
  const Columns t = read_table("crossed.csv");
  check_fit(data_of(t, treatment(t, {{2, 3}}), {3, 4}), {0.84850234, -0.83753677, 0.56484094},
            {0.34481726, 0.16469677, 0.17395411}, {0.93640018, 0.49845154}, -342.8162727);
}

TEST_CASE("a benchmark with policies, categories, tasks, objects and starts agrees with lme4") {
  check_fit(benchmark(),
            {0.06968351, 0.73158580, -0.52803076, -0.92466855, 0.61324153, -0.76264799},
            {0.27386047, 0.13093020, 0.13158821, 0.37643832, 0.37548081, 0.37527380},
            {0.46811524, 0, 0.46215194}, -680.3385189);
}

TEST_CASE("the gradient of the Laplace deviance equals its differences") {
  const MixedData data = benchmark();
  LaplaceDeviance deviance(data, 2.0);
  Eigen::VectorXd at(9);
  at << 0.3, 0.5, -0.4, -0.7, 0.2, -0.5, 0.6, -0.4, 0.9;
  double value = 0, above = 0, below = 0;
  Eigen::VectorXd gradient, unused;
  REQUIRE(deviance.evaluate(at, &value, &gradient));
  for (Eigen::Index j = 0; j < at.size(); ++j) {
    Eigen::VectorXd there = at;
    there(j) += 1e-5;
    REQUIRE(deviance.evaluate(there, &above, &unused));
    there(j) -= 2e-5;
    REQUIRE(deviance.evaluate(there, &below, &unused));
    CAPTURE(j);
    CHECK(gradient(j) == doctest::Approx((above - below) / 2e-5).epsilon(1e-5));
  }
}

TEST_CASE("a policy that never succeeds needs a prior") {
  Columns t = read_table("crossed.csv");
  for (std::size_t i = 0; i < t[0].size(); ++i) {
    if (t[2][i] == 1) t[0][i] = 0;
  }
  const MixedData data = data_of(t, treatment(t, {{2, 3}}), {3, 4});
  const auto without = fit_mixed_logistic(data);
  REQUIRE_FALSE(without.ok());
  CHECK(without.failure().message.find("prior") != std::string::npos);
  const auto with = fit_mixed_logistic(data, {.fixed_prior_sd = 2.5});
  REQUIRE(with.ok());
  CHECK(with->fixed(1) < -4);
}

TEST_CASE("a table that is no table is refused with its reason") {
  MixedData data;
  CHECK_FALSE(fit_mixed_logistic(data).ok());
  data.fixed = Eigen::MatrixXd::Ones(4, 2);
  data.successes = Eigen::VectorXd::Ones(4);
  data.trials = Eigen::VectorXd::Constant(4, 2);
  CHECK(fit_mixed_logistic(data).failure().message.find("depend") != std::string::npos);
  data.fixed = Eigen::MatrixXd::Ones(4, 1);
  data.successes(2) = 3;
  CHECK(fit_mixed_logistic(data).failure().message.find("row 2") != std::string::npos);
}

}  // namespace probe::stats
