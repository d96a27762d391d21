#include "runtime/report/models.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "runtime/base/numbering.h"
#include "runtime/inspect/axes.h"
#include "runtime/plan/axes.h"
#include "runtime/report/tables.h"
#include "runtime/stats/bradley_terry.h"
#include "runtime/stats/mixed_logistic.h"
#include "runtime/stats/paired.h"
#include "runtime/stats/sequential.h"

namespace probe::report {
namespace {

constexpr double kPriorSd = 3;  // log-odds

constexpr std::array<const char*, 3> kFactors = {"task", "source", "start"};

struct Row {
  int policy = 0, task = 0, start = 0;
  double successes = 0, trials = 0;
};

// Valid episodes of a metric, a row a policy and start.
std::vector<Row> rows_of(const Benchmark& benchmark, int metric) {
  std::vector<Row> rows;
  for (const Episode& e : benchmark.episodes) {
    if (!e.valid() || benchmark.is_adaptive(e.policy)) continue;
    const auto& metrics = benchmark.tasks[static_cast<std::size_t>(e.task)].metrics;
    if (std::find(metrics.begin(), metrics.end(), metric) == metrics.end()) continue;
    if (rows.empty() || rows.back().policy != e.policy || rows.back().task != e.task ||
        rows.back().start != e.start) {
      rows.push_back({e.policy, e.task, e.start, 0, 0});
    }
    rows.back().successes += e.is(metric) ? 1 : 0;
    rows.back().trials += 1;
  }
  return rows;
}

// Policies whose every episode ended alike have no finite odds.
std::string leave_out_constant(const Benchmark& benchmark, std::vector<Row>& rows) {
  std::map<int, std::pair<double, double>> sums;
  for (const Row& row : rows) {
    sums[row.policy].first += row.successes;
    sums[row.policy].second += row.trials;
  }
  std::string names;
  std::set<int> constant;
  for (const auto& [policy, sum] : sums) {
    if (sum.first > 0 && sum.first < sum.second) continue;
    constant.insert(policy);
    names +=
        (names.empty() ? "" : ", ") +
        fmt::format("`{}` ({} of {})", benchmark.policies[static_cast<std::size_t>(policy)].label,
                    sum.first, sum.second);
  }
  std::erase_if(rows, [&](const Row& row) { return constant.contains(row.policy); });
  return names;
}

struct Column {
  std::string term, kind;
  std::vector<double> values;
};

std::vector<Column> policy_columns(const Benchmark& benchmark, const std::vector<Row>& rows,
                                   std::string& reference) {
  std::set<int> policies;
  for (const Row& row : rows) policies.insert(row.policy);
  std::vector<Column> columns;
  for (const int policy : policies) {
    const std::string& label = benchmark.policies[static_cast<std::size_t>(policy)].label;
    if (policy == *policies.begin()) {
      reference = label;
      continue;
    }
    Column column{label, "policy", {}};
    for (const Row& row : rows) column.values.push_back(row.policy == policy ? 1 : 0);
    columns.push_back(std::move(column));
  }
  return columns;
}

std::vector<Column> category_columns(const Benchmark& benchmark, const std::vector<Row>& rows,
                                     std::string& reference) {
  std::vector<Column> columns;
  for (std::size_t c = 0; c < benchmark.categories.size(); ++c) {
    const Category& category = benchmark.categories[c];
    if (c == 0) {
      reference = category.label;
      continue;
    }
    Column column{category.label, "category", {}};
    for (const Row& row : rows) {
      const bool in =
          std::find(category.tasks.begin(), category.tasks.end(), row.task) != category.tasks.end();
      column.values.push_back(in ? 1 : 0);
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

// An axis counts as moved when it moved anywhere on the way to the original.
std::vector<Column> axis_columns(const Benchmark& benchmark, const std::vector<Row>& rows) {
  std::vector<std::uint32_t> moved(benchmark.tasks.size(), 0);
  for (std::size_t t = 0; t < moved.size(); ++t) {
    for (int at = static_cast<int>(t); at != kAbsent;
         at = benchmark.tasks[static_cast<std::size_t>(at)].baseline)
      moved[t] |= benchmark.tasks[static_cast<std::size_t>(at)].axes;
  }
  std::vector<Column> columns;
  for (const plan::AxisInfo& info : plan::kAxisTable) {
    Column column{std::string(info.name), "axis", {}};
    for (const Row& row : rows) {
      const std::uint32_t of_task = moved[static_cast<std::size_t>(row.task)];
      column.values.push_back(plan::moves(of_task, info.axis) ? 1 : 0);
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

// Columns that the ones before them do not already say, by Gram and Schmidt; the names of others.
std::string drop_aliased(std::vector<Column>& columns, std::size_t rows) {
  std::vector<Eigen::VectorXd> basis = {Eigen::VectorXd::Constant(
      static_cast<Eigen::Index>(rows), 1 / std::sqrt(static_cast<double>(rows)))};
  std::vector<Column> kept;
  std::string dropped;
  for (Column& column : columns) {
    Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(
        column.values.data(), static_cast<Eigen::Index>(column.values.size()));
    const double length = v.norm();
    for (const Eigen::VectorXd& b : basis) v -= v.dot(b) * b;
    if (length == 0) continue;  // nowhere in these runs
    if (v.norm() < 1e-6 * length) {
      dropped += (dropped.empty() ? "" : ", ") + column.term;
      continue;
    }
    basis.push_back(v.normalized());
    kept.push_back(std::move(column));
  }
  columns = std::move(kept);
  return dropped;
}

stats::MixedData data_of(const Benchmark& benchmark, const std::vector<Row>& rows,
                         const std::vector<Column>& columns) {
  stats::MixedData data;
  const auto n = static_cast<Eigen::Index>(rows.size());
  data.fixed = Eigen::MatrixXd::Ones(n, static_cast<Eigen::Index>(columns.size()) + 1);
  data.successes.resize(n);
  data.trials.resize(n);
  data.groups.resize(kFactors.size());
  Numbering<int> tasks, objects;
  Numbering<std::pair<int, int>> starts;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Row& row = rows[static_cast<std::size_t>(i)];
    data.successes(i) = row.successes;
    data.trials(i) = row.trials;
    data.groups[0].push_back(tasks(row.task));
    data.groups[1].push_back(objects(benchmark.tasks[static_cast<std::size_t>(row.task)].source));
    data.groups[2].push_back(starts(std::pair(row.task, row.start)));
    for (std::size_t c = 0; c < columns.size(); ++c)
      data.fixed(i, static_cast<Eigen::Index>(c) + 1) =
          columns[c].values[static_cast<std::size_t>(i)];
  }
  return data;
}

MixedModel fit(const Benchmark& benchmark, int metric, bool by_category) {
  MixedModel model;
  model.metric = metric;
  std::vector<Row> rows = rows_of(benchmark, metric);
  const std::string constant = leave_out_constant(benchmark, rows);
  std::string reference_policy, reference_category;
  std::vector<Column> columns = policy_columns(benchmark, rows, reference_policy);
  std::vector<Column> more = by_category ? category_columns(benchmark, rows, reference_category)
                                         : axis_columns(benchmark, rows);
  columns.insert(columns.end(), std::make_move_iterator(more.begin()),
                 std::make_move_iterator(more.end()));
  const auto formula = [&](const char* random) {
    return fmt::format("{} ~ policy + {} + {}",
                       benchmark.metrics[static_cast<std::size_t>(metric)].name,
                       by_category ? "category" : "axes", random);
  };
  model.formula = formula("(1 | task) + (1 | source) + (1 | start)");
  model.rows = rows.size();
  if (!constant.empty()) model.note = "left out, always or never so: " + constant + ". ";
  if (rows.empty()) {
    model.note += "No policy's episodes differ, so there is nothing to fit.";
    return model;
  }
  const std::string aliased = drop_aliased(columns, rows.size());
  if (!aliased.empty()) model.note += "Not told apart from the others: " + aliased + ". ";
  stats::MixedData data = data_of(benchmark, rows, columns);
  // One episode a start says nothing of how starts differ.
  const auto starts = *std::max_element(data.groups[2].begin(), data.groups[2].end()) + 1;
  if (static_cast<double>(starts) == data.trials.sum()) {
    data.groups.pop_back();
    model.formula = formula("(1 | task) + (1 | source)");
    model.note += "Every start has one episode here, so it has no effect of its own. ";
  }
  const auto fitted = stats::fit_mixed_logistic(data, {.fixed_prior_sd = kPriorSd});
  if (!fitted) {
    model.note += "No fit: " + probe::to_text(fitted.failure()) + ".";
    return model;
  }
  model.note += "References: policy `" + reference_policy + "`" +
                (by_category ? ", category " + reference_category : ", no axis moved") + ".";
  const double z = stats::normal_two_sided(0.95);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto i = static_cast<Eigen::Index>(c) + 1;
    const double effect = fitted->fixed(i);
    const double error = std::sqrt(std::max(0.0, fitted->covariance(i, i)));
    const double p = error > 0
                         ? 2 * boost::math::cdf(boost::math::complement(
                                   boost::math::normal_distribution<>(), std::abs(effect) / error))
                         : 1;
    model.terms.push_back({columns[c].term, columns[c].kind, std::exp(effect),
                           std::exp(effect - z * error), std::exp(effect + z * error), p});
  }
  for (Eigen::Index f = 0; f < fitted->random_sd.size(); ++f)
    model.random.push_back({kFactors[static_cast<std::size_t>(f)], fitted->random_sd(f)});
  return model;
}

// Of every start that both policies have: 1 where a's rate is higher, -1 where b's is, else 0. The
// first start of all tasks, then the second, and so on.
std::vector<int> outcomes(const Benchmark& benchmark, int a, int b, int metric) {
  std::vector<std::pair<std::pair<int, int>, int>> by_start;  // (start, task), sign
  for (const int t : benchmark.all_tasks()) {
    const auto rate = [&](int policy) {
      std::map<int, std::pair<int, int>> counts;
      for (const Episode& e : benchmark.of(policy, t)) {
        if (!e.valid()) continue;
        counts[e.start].first += e.is(metric) ? 1 : 0;
        ++counts[e.start].second;
      }
      return counts;
    };
    const auto& metrics = benchmark.tasks[static_cast<std::size_t>(t)].metrics;
    if (std::find(metrics.begin(), metrics.end(), metric) == metrics.end()) continue;
    const auto ours = rate(a);
    const auto theirs = rate(b);
    for (const auto& [start, count] : ours) {
      const auto other = theirs.find(start);
      if (other == theirs.end()) continue;
      const int net = count.first * other->second.second - other->second.first * count.second;
      by_start.push_back({{start, t}, net > 0 ? 1 : net < 0 ? -1 : 0});
    }
  }
  std::sort(by_start.begin(), by_start.end());
  std::vector<int> signs;
  for (const auto& [key, sign] : by_start) signs.push_back(sign);
  return signs;
}

Looked look(const std::vector<std::int64_t>& nets) {
  Looked looked;
  looked.units = static_cast<std::int64_t>(nets.size());
  stats::SequentialComparison comparison;
  std::vector<stats::Cluster> seen;
  for (const std::int64_t net : nets) {
    ++looked.used;
    if (net == 0) continue;  // no news
    comparison.add(net);
    seen.push_back(
        {.only_a = std::max<std::int64_t>(net, 0), .only_b = std::max<std::int64_t>(-net, 0)});
    // Signs and sums may disagree where units hold unlike numbers of episodes.
    looked.stopped = comparison.p_value() <= kAlpha && stats::clustered_exact(seen) <= kAlpha;
    if (looked.stopped) break;
  }
  looked.a_wins = comparison.a_wins();
  looked.b_wins = comparison.b_wins();
  looked.p = comparison.p_value();
  return looked;
}

}  // namespace

std::vector<MixedModel> mixed_models(const Benchmark& benchmark, const std::vector<int>& metrics) {
  std::vector<MixedModel> models;
  for (const int metric : metrics) {
    if (benchmark.categories.size() > 1) models.push_back(fit(benchmark, metric, true));
    models.push_back(fit(benchmark, metric, false));
  }
  return models;
}

std::vector<RankRow> ranking(const Benchmark& benchmark, int metric) {
  std::vector<int> policies;
  for (int p = 0; p < static_cast<int>(benchmark.policies.size()); ++p)
    if (!benchmark.is_adaptive(p)) policies.push_back(p);
  const auto n = static_cast<Eigen::Index>(policies.size());
  if (n < 2) return {};
  const auto policy = [&](Eigen::Index i) { return policies[static_cast<std::size_t>(i)]; };
  Eigen::MatrixXd wins = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = a + 1; b < n; ++b) {
      for (const int sign : outcomes(benchmark, policy(a), policy(b), metric)) {
        wins(a, b) += sign > 0 ? 1 : sign == 0 ? 0.5 : 0;
        wins(b, a) += sign < 0 ? 1 : sign == 0 ? 0.5 : 0;
      }
    }
  }
  const auto ranked = stats::bradley_terry(wins);
  if (!ranked) return {};  // policies that share no start have no order
  const double z = stats::normal_two_sided(0.95);
  std::vector<RankRow> rows;
  for (Eigen::Index i = 0; i < n; ++i) {
    rows.push_back({policy(i), metric, ranked->strength(i),
                    ranked->strength(i) - z * ranked->standard_error(i),
                    ranked->strength(i) + z * ranked->standard_error(i)});
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const RankRow& a, const RankRow& b) { return a.score > b.score; });
  return rows;
}

std::vector<SequentialRow> sequential(const Benchmark& benchmark, int metric) {
  std::vector<SequentialRow> rows;
  const int n = static_cast<int>(benchmark.policies.size());
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      if (benchmark.is_adaptive(a) || benchmark.is_adaptive(b)) continue;
      const Contrast contrast = policy_contrast(benchmark, a, b, metric, benchmark.all_tasks());
      if (contrast.anew.nets.empty()) continue;
      rows.push_back({a, b, metric, look(contrast.here.nets), look(contrast.anew.nets)});
    }
  }
  return rows;
}

}  // namespace probe::report
