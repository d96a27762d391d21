#include "runtime/report/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "runtime/base/percent.h"

namespace probe::report {
namespace {

constexpr std::size_t kFewest = 3;  // policies: two always lie on a line

stats::MeasuredRate measured(const PublishedFigure& figure) {
  return {figure.value, figure.trials};
}

// Sources divide the name of a column otherwise, and some leave `average` away.
bool is_same_cell(const PublishedFigure& a, const PublishedFigure& b) {
  return a.policy == b.policy && column_of(a) == column_of(b);
}

// The real rate beside a simulated one: of its own source, else the first in the file.
const PublishedFigure* real_of(const RateTable& table, const PublishedFigure& simulated) {
  const PublishedFigure* found = nullptr;
  for (const PublishedFigure& figure : table.figures) {
    if (!is_rate(figure) || figure.protocol != kReal || !is_same_cell(figure, simulated)) continue;
    if (figure.source == simulated.source) return &figure;
    if (found == nullptr) found = &figure;
  }
  return found;
}

std::string interval_text(const std::optional<stats::Interval>& interval) {
  return interval ? fmt::format("{:.3f} .. {:.3f}", interval->low, interval->high) : "-";
}

Json interval_json(const std::optional<stats::Interval>& interval) {
  return interval ? Json{interval->low, interval->high} : Json();
}

struct RunRate {
  stats::Count count;
  std::size_t starts = 0;   // episodes of one start are no independent trials
  std::size_t planned = 0;  // starts that the suites would have run
};

// Of a policy's valid episodes in the tasks of all sets of that name, each task once.
RunRate run_rate(const Benchmark& benchmark, int policy, std::string_view set_name) {
  const int success = benchmark.find_metric("success");
  std::map<int, std::size_t> tasks;  // and the starts that a suite has of each
  for (std::size_t p = 0; p < benchmark.plan_files.size(); ++p) {
    const plan::Plan& plan = benchmark.plan_files[p];
    const auto suite = plan.find_suite(benchmark.plans[p].suite);
    for (const plan::SetRecord& set : plan.sets()) {
      if (plan.text(set.name) != set_name) continue;
      for (const std::uint32_t member : plan.members(set)) {
        std::size_t& starts = tasks[benchmark.find_task(plan.text(plan.tasks()[member].name))];
        if (suite) starts = std::max(starts, plan.episodes(plan.suites()[*suite], member).size());
      }
    }
  }
  tasks.erase(kAbsent);
  RunRate of;
  std::set<std::pair<int, int>> starts;
  for (const auto& [task, planned] : tasks) {
    of.planned += planned;
    for (const Episode& episode : benchmark.of(policy, task)) {
      if (!episode.valid()) continue;
      of.count.k += episode.is(success);
      ++of.count.n;
      starts.emplace(task, episode.start);
    }
  }
  of.starts = starts.size();
  return of;
}

// The fewest trials that a simulated rate of the table says for a column; 0 where none does.
double fewest_trials(const RateTable& table, const std::string& column) {
  double fewest = 0;
  for (const PublishedFigure& figure : table.figures) {
    if (!is_rate(figure) || figure.protocol == kReal || column_of(figure) != column) continue;
    if (figure.trials > 0 && (fewest == 0 || figure.trials < fewest)) fewest = figure.trials;
  }
  return fewest;
}

}  // namespace

std::vector<std::string> add_runs(RateTable& table, const Benchmark& benchmark) {
  const auto is_ambiguous = [&](const std::string& name) {
    return std::ranges::count(benchmark.policies, name, &Policy::name) > 1;
  };
  std::vector<PublishedFigure> added;
  std::map<std::string, std::string> partial;  // by policy
  for (const PublishedFigure& real : table.figures) {
    if (!is_rate(real) || real.protocol != kReal) continue;
    const bool is_known = std::ranges::any_of(
        added, [&](const PublishedFigure& figure) { return is_same_cell(figure, real); });
    for (std::size_t p = 0; p < benchmark.policies.size() && !is_known; ++p) {
      if (benchmark.policies[p].name != real.policy || benchmark.policies[p].adaptive ||
          is_ambiguous(real.policy))
        continue;
      const RunRate of = run_rate(benchmark, static_cast<int>(p), column_of(real));
      if (of.count.n == 0) continue;
      // A plan of some tasks alone has smaller sets and does not know it.
      const double trials = fewest_trials(table, column_of(real));
      const bool is_part = of.starts < of.planned;
      if (is_part || static_cast<double>(of.starts) < trials) {
        std::string& columns = partial[real.policy];
        columns += fmt::format("{}{}{} starts of `{}`", columns.empty() ? "" : ", ", of.starts,
                               is_part ? fmt::format(" of {}", of.planned) : "", column_of(real));
        if (!is_part) columns += fmt::format(" (the table's simulated rates: {} or more)", trials);
      }
      PublishedFigure figure = real;
      figure.source = figure.protocol = kTheseRuns;
      figure.value = of.count.rate();
      figure.trials = static_cast<double>(of.starts);
      figure.line = 0;
      added.push_back(std::move(figure));
    }
  }
  std::vector<std::string> left_out;
  std::set<std::string> known, counted;
  for (const PublishedFigure& figure : table.figures)
    if (is_rate(figure) && figure.protocol == kReal) known.insert(figure.policy);
  for (const PublishedFigure& figure : added) counted.insert(figure.policy);
  for (const auto& policy : benchmark.policies) {
    if (policy.adaptive) {
      left_out.push_back(fmt::format("`{}` is left out: {}", policy.name,
                                     adaptive::why_not_fixed(to_text(policy.adaptive->rule))));
    } else if (!known.contains(policy.name)) {
      left_out.push_back(fmt::format(
          "`{}` has no real rate in the table, which knows {}: name runs as it does, with --name",
          policy.name, fmt::join(known, ", ")));
    } else if (is_ambiguous(policy.name)) {
      left_out.push_back(
          fmt::format("`{}` is left out: another of the runs has its name", policy.label));
    } else if (!counted.contains(policy.name)) {
      left_out.push_back(
          fmt::format("`{}` has no valid episode in a set that is called as a column of the table "
                      "is (TASK_SUBTASK)",
                      policy.name));
    }
  }
  for (const auto& [policy, columns] : partial)
    left_out.push_back(fmt::format("`{}` has {}: its rates are of these", policy, columns));
  if (!counted.empty() && counted.size() < kFewest) {
    left_out.push_back(fmt::format("the runs have {} of the {} policies that an agreement takes",
                                   counted.size(), kFewest));
  }
  table.figures.insert(table.figures.end(), added.begin(), added.end());
  return left_out;
}

std::vector<AgreementRow> agreements(const RateTable& table) {
  using Key = std::array<std::string, 3>;  // source, protocol, column
  struct Sides {
    const PublishedFigure* first = nullptr;  // of the column, in the order of the table
    std::vector<std::string> policies, without_real;
    std::vector<stats::MeasuredRate> real, simulated;
  };
  std::vector<Key> order;
  std::map<Key, Sides> columns;
  for (const PublishedFigure& figure : table.figures) {
    if (!is_rate(figure) || figure.protocol == kReal) continue;
    const Key key = {figure.source, figure.protocol, column_of(figure)};
    Sides& sides = columns[key];
    if (sides.first == nullptr) {
      sides.first = &figure;
      order.push_back(key);
    }
    const PublishedFigure* real = real_of(table, figure);
    if (real == nullptr) {
      sides.without_real.push_back(figure.policy);
      continue;
    }
    sides.policies.push_back(figure.policy);
    sides.real.push_back(measured(*real));
    sides.simulated.push_back(measured(figure));
  }
  std::vector<AgreementRow> rows;
  for (const Key& key : order) {
    const Sides& sides = columns[key];
    const PublishedFigure& first = *sides.first;
    if (sides.policies.size() < kFewest) continue;
    std::vector<std::string> without_simulated;
    for (const PublishedFigure& figure : table.figures) {
      if (!is_rate(figure) || figure.protocol != kReal || column_of(figure) != column_of(first))
        continue;
      const auto is_in = [&](const std::vector<std::string>& names) {
        return std::ranges::find(names, figure.policy) != names.end();
      };
      if (!is_in(sides.policies) && !is_in(without_simulated))
        without_simulated.push_back(figure.policy);
    }
    rows.push_back({first.source, first.protocol, first.task, first.subtask, sides.policies,
                    sides.without_real, std::move(without_simulated),
                    stats::rank_agreement(sides.real, sides.simulated)});
  }
  return rows;
}

std::vector<StatedAgreement> stated_agreements(const RateTable& table,
                                               const std::vector<AgreementRow>& rows) {
  std::vector<StatedAgreement> all;
  for (const PublishedFigure& figure : table.figures) {
    const bool is_violation = figure.metric == "MMRV";
    if (!is_violation && figure.metric != "Pearson") continue;
    const auto fits = [&](const AgreementRow& row) {
      return row.protocol == figure.protocol && column_of(row) == column_of(figure) &&
             (is_violation || row.agreement.correlation);
    };
    // Its own source's rates, else the first.
    auto row = std::ranges::find_if(
        rows, [&](const AgreementRow& one) { return fits(one) && one.source == figure.source; });
    if (row == rows.end()) row = std::ranges::find_if(rows, fits);
    if (row == rows.end()) continue;
    const double computed = is_violation ? row->agreement.violation : *row->agreement.correlation;
    // What was written has a last digit of its own.
    const double half = 0.5 * std::pow(10.0, -figure.decimals);
    const bool is_close = std::abs(computed - figure.value) <= kClose + half + 1e-12;
    all.push_back({&figure, computed, row->policies.size(), is_close});
  }
  return all;
}

std::vector<std::string> impossible_rates(const RateTable& table) {
  std::vector<std::string> sentences;
  for (const PublishedFigure& figure : table.figures) {
    if (!is_rate(figure) || figure.trials == 0 || figure.line == 0) continue;
    const auto n = static_cast<std::int64_t>(figure.trials);
    const NearestCounts near = nearest_counts(100 * figure.value, figure.decimals - 2, n);
    if (near.fits) continue;
    const auto rate = [&](std::int64_t k) {
      return decimal_text(static_cast<double>(k) / figure.trials, figure.decimals + 1);
    };
    sentences.push_back(fmt::format(
        "{}:{}: {}: {} is no count of {} trials; nearest: {} ({}) and {} ({})", table.file,
        figure.line, name_of(figure), decimal_text(figure.value, figure.decimals), n, near.below,
        rate(near.below), near.above, rate(near.above)));
  }
  return sentences;
}

namespace {

// Policies that are in no figure of a column as they have one rate of two: a line for all columns
// of a protocol that lack the same.
std::string lone_rates_text(const std::vector<AgreementRow>& rows) {
  std::vector<std::array<std::string, 3>> lines;  // of whom, columns, what
  const auto add = [&](const AgreementRow& row, const char* side,
                       const std::vector<std::string>& policies) {
    if (policies.empty()) return;
    const std::string of =
        row.source == row.protocol ? row.source : row.source + ", " + row.protocol;
    const std::string what = fmt::format("no {} rate of {}", side, fmt::join(policies, ", "));
    const auto line = std::ranges::find_if(
        lines, [&](const auto& one) { return one[0] == of && one[2] == what; });
    if (line == lines.end()) {
      lines.push_back({of, column_of(row), what});
    } else {
      (*line)[1] += ", " + column_of(row);
    }
  };
  for (const AgreementRow& row : rows) {
    add(row, "real", row.without_real);
    add(row, "simulated", row.without_simulated);
  }
  std::string text;
  for (const auto& [of, columns, what] : lines)
    text += fmt::format("{}, {}: {}\n", of, columns, what);
  return text;
}

}  // namespace

std::string agreement_text(const RateTable& table) {
  const std::vector<AgreementRow> rows = agreements(table);
  std::string text;
  const std::string* source = nullptr;
  const std::string* protocol = nullptr;
  for (const AgreementRow& row : rows) {
    if (source == nullptr || *source != row.source || *protocol != row.protocol) {
      source = &row.source, protocol = &row.protocol;
      text +=
          fmt::format("{}{}{}\n{:<34} {:>8}  {:>6}  {:<16} {:<16}  {:>7}  {:<16} {:<16}\n",
                      text.empty() ? "" : "\n", row.source,
                      row.source == row.protocol ? "" : ", " + row.protocol, "", "policies", "MMRV",
                      "95 % by trials", "without one", "Pearson", "95 % by trials", "without one");
    }
    const stats::Agreement& a = row.agreement;
    text += fmt::format(
        "{:<34} {:>8}  {:>6.3f}  {:<16} {:<16}  {:>7}  {:<16} {:<16}\n", column_of(row),
        row.policies.size(), a.violation, interval_text(a.violation_by_trials),
        interval_text(a.violation_by_policies),
        a.correlation ? fmt::format("{:.3f}", *a.correlation) : "-",
        interval_text(a.correlation_by_trials), interval_text(a.correlation_by_policies));
  }
  if (rows.empty())
    text += "no three policies have a real rate and a simulated one of the same task\n";
  if (const std::string lone = lone_rates_text(rows); !lone.empty())
    text += "\npolicies with one rate of two, in none of these figures:\n" + lone;
  const std::vector<StatedAgreement> stated = stated_agreements(table, rows);
  std::map<std::string, std::pair<int, int>> close;  // by source: of how many
  for (const StatedAgreement& one : stated) {
    auto& [good, all] = close[one.stated->source];
    good += one.is_close;
    ++all;
  }
  if (!stated.empty()) text += "\n";
  for (const auto& [of, counts] : close)
    text += fmt::format("{}: {} of {} figures are what these rates give, to {}\n", of, counts.first,
                        counts.second, kClose);
  for (const StatedAgreement& one : stated) {
    if (one.is_close) continue;
    text += fmt::format(
        "{}:{}: {} of {}, {}: {} is written ({}), the rates of {} policies give {:.3f}\n",
        table.file, one.stated->line, one.stated->metric, column_of(*one.stated),
        one.stated->protocol, decimal_text(one.stated->value, one.stated->decimals),
        one.stated->source, one.policies, one.computed);
  }
  const std::vector<std::string> impossible = impossible_rates(table);
  if (!impossible.empty())
    text += fmt::format("\n{} {} no count of successes gives:\n", impossible.size(),
                        impossible.size() == 1 ? "rate that" : "rates that");
  for (const std::string& sentence : impossible) text += sentence + "\n";
  if (!table.unread.empty()) text += "\nleft out:\n";
  for (const std::string& line : table.unread) text += line + "\n";
  return text;
}

Json agreement_json(const RateTable& table) {
  const std::vector<AgreementRow> rows = agreements(table);
  Json json = {{"table", table.file}, {"figures", table.figures.size()}};
  json["agreement"] = Json::array();
  for (const AgreementRow& row : rows) {
    const stats::Agreement& a = row.agreement;
    json["agreement"].push_back(
        {{"source", row.source},
         {"protocol", row.protocol},
         {"task", row.task},
         {"subtask", row.subtask},
         {"policies", row.policies},
         {"without_real", row.without_real},
         {"without_simulated", row.without_simulated},
         {"mmrv", a.violation},
         {"mmrv_by_trials", interval_json(a.violation_by_trials)},
         {"mmrv_without_one", interval_json(a.violation_by_policies)},
         {"pearson", a.correlation ? Json(*a.correlation) : Json()},
         {"pearson_by_trials", interval_json(a.correlation_by_trials)},
         {"pearson_without_one", interval_json(a.correlation_by_policies)}});
  }
  json["stated"] = Json::array();
  for (const StatedAgreement& one : stated_agreements(table, rows)) {
    json["stated"].push_back({{"line", one.stated->line},
                              {"source", one.stated->source},
                              {"protocol", one.stated->protocol},
                              {"metric", one.stated->metric},
                              {"task", one.stated->task},
                              {"subtask", one.stated->subtask},
                              {"stated", one.stated->value},
                              {"computed", one.computed},
                              {"policies", one.policies},
                              {"close", one.is_close}});
  }
  json["impossible"] = impossible_rates(table);
  json["left_out"] = table.unread;
  return json;
}

}  // namespace probe::report
