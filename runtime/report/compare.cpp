#include "runtime/report/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runtime/base/percent.h"
#include "runtime/plan/axis_names.h"
#include "runtime/report/models.h"
#include "runtime/report/page_data.h"
#include "runtime/stats/design.h"
#include "runtime/stats/multiplicity.h"

namespace probe::report {
namespace {

using Json = nlohmann::ordered_json;
using Scope = ComparedRow::Scope;

constexpr double kAlpha = 0.05;
constexpr double kPower = 0.8;

struct Shared {
  std::size_t common = 0, only_a = 0, only_b = 0;
  std::vector<int> tasks;  // that have a common start
};

Shared shared_starts(const Benchmark& benchmark, int a, int b) {
  Shared shared;
  for (const int t : benchmark.all_tasks()) {
    std::set<std::pair<int, int>> ours, theirs;
    for (const Episode& e : benchmark.of(a, t)) {
      if (e.valid()) ours.emplace(e.start, e.row.seed);
    }
    for (const Episode& e : benchmark.of(b, t)) {
      if (e.valid()) theirs.emplace(e.start, e.row.seed);
    }
    std::size_t common = 0;
    for (const auto& key : ours) common += theirs.contains(key) ? 1 : 0;
    shared.common += common;
    shared.only_a += ours.size() - common;
    shared.only_b += theirs.size() - common;
    if (common > 0) shared.tasks.push_back(t);
  }
  return shared;
}

Failure nothing_shared(const Benchmark& benchmark, int a, int b, const Shared& shared) {
  const Policy& first = benchmark.policies[static_cast<std::size_t>(a)];
  const Policy& second = benchmark.policies[static_cast<std::size_t>(b)];
  std::string why = "they ran other tasks, starts or seeds";
  if (shared.only_a == 0 || shared.only_b == 0) {
    why = fmt::format("`{}` has no valid episode", shared.only_a == 0 ? first.label : second.label);
  } else if (benchmark.plans.size() > 1) {
    why = "their plans have no task with the same instruction, rule, objects and starts";
  }
  return {Fault::kUsage,
          fmt::format("`{}` and `{}` share no episode: {}", first.label, second.label, why), ""};
}

std::vector<int> both(const std::vector<int>& tasks, const std::vector<int>& of) {
  std::vector<int> common;
  for (const int t : tasks) {
    if (std::find(of.begin(), of.end(), t) != of.end()) common.push_back(t);
  }
  return common;
}

class Comparer {
 public:
  Comparer(const Benchmark& benchmark, int a, int b, std::vector<int> tasks)
      : benchmark_(benchmark), a_(a), b_(b), tasks_(std::move(tasks)) {}

  std::vector<ComparedRow> rows(const std::vector<int>& metrics) {
    for (const int m : metrics) add(Scope::kAll, m, "all tasks", tasks_);
    adjust(0, true);
    for (const int m : metrics) {
      std::size_t first = rows_.size();
      for (const Category& c : benchmark_.categories)
        add(Scope::kCategory, m, c.label, both(tasks_, c.tasks));
      adjust(first, true);
      first = rows_.size();
      add_axes(m);
      adjust(first, true);
      first = rows_.size();
      for (const int t : tasks_)
        add(Scope::kTask, m, benchmark_.tasks[static_cast<std::size_t>(t)].name, {t});
      adjust(first, false);
    }
    for (ComparedRow& row : rows_) what_would_tell(row);
    return std::move(rows_);
  }

 private:
  void add(Scope scope, int metric, const std::string& name, const std::vector<int>& tasks) {
    ComparedRow row{scope, metric, name, policy_contrast(benchmark_, a_, b_, metric, tasks),
                    {},    {}};
    if (row.contrast.first.n > 0) rows_.push_back(std::move(row));
  }

  // The tasks that move an axis against their own baselines.
  void add_axes(int metric) {
    for (const auto& [axis, name] : plan::kAxisNames) {
      std::vector<int> tasks;
      for (const int t : tasks_) {
        const std::uint32_t moved = benchmark_.tasks[static_cast<std::size_t>(t)].axes;
        if ((moved & static_cast<std::uint32_t>(axis)) != 0) tasks.push_back(t);
      }
      if (!tasks.empty()) add(Scope::kAxis, metric, "moves " + std::string(name), tasks);
    }
  }

  void adjust(std::size_t first, bool family_wise) {
    std::vector<double> p;
    for (std::size_t i = first; i < rows_.size(); ++i) p.push_back(rows_[i].contrast.p);
    const auto adjusted = family_wise ? stats::holm(p) : stats::benjamini_hochberg(p);
    for (std::size_t i = first; i < rows_.size(); ++i)
      rows_[i].contrast.adjusted = adjusted[i - first];
  }

  static void what_would_tell(ComparedRow& row) {
    if (row.is_real() || row.scope == Scope::kTask) return;
    row.detectable = detectable(row.contrast);
    const PlaceDesign design = place_design(row.contrast);
    if (design.differ == 0) return;
    const auto needed =
        places_needed(std::abs(row.contrast.difference) / design.episodes, design.discordance);
    if (needed && *needed > design.places) row.more_places = *needed - design.places;
  }

  const Benchmark& benchmark_;
  int a_, b_;
  std::vector<int> tasks_;
  std::vector<ComparedRow> rows_;
};

// What the test counts; every place is one start where one task was run.
std::string places(const Contrast& c) {
  const auto count = static_cast<std::int64_t>(c.place_nets.size());
  if (count == c.starts) return fmt::format("{} {}", count, count == 1 ? "start" : "starts");
  return fmt::format("{} starts in {} {}", c.starts, count, count == 1 ? "place" : "places");
}
bool is_one_start_a_place(const Contrast& c) {
  return static_cast<std::int64_t>(c.place_nets.size()) == c.starts;
}

bool differs_anywhere(const Contrast& c) { return c.pairs.only_a + c.pairs.only_b > 0; }

std::string rate(const stats::Count& count) {
  return fmt::format("{} of {} ({} %)", count.k, count.n, percent_text(count.k, count.n));
}

std::string p_text(double p) {
  if (p < 1e-4) return "p < 0.0001";
  return fmt::format("p = {:.2g}", p);
}

std::string points(double difference) { return signed_text(100 * difference, 1); }

std::string range(const Contrast& c) {
  return fmt::format("{} points, {} to {}", points(c.difference), points(c.interval.low),
                     points(c.interval.high));
}

// "more" is not "better" for every metric.
std::string verdict(const Benchmark& benchmark, const Comparison& comparison,
                    const ComparedRow& row) {
  const Metric& metric = benchmark.metrics[static_cast<std::size_t>(row.metric)];
  const Contrast& c = row.contrast;
  const std::string numbers = fmt::format("{} against {}; {}; {}", rate(c.first), rate(c.second),
                                          range(c), p_text(c.adjusted));
  if (row.is_real()) {
    const bool a_more = c.difference > 0;
    const bool a_better = a_more == (metric.good >= 0);
    return fmt::format("{}: {} is {} ({}).", metric.name, a_better ? comparison.a : comparison.b,
                       metric.good == 0 ? "higher" : "better", numbers);
  }
  if (c.pairs.only_a + c.pairs.only_b == 0) {
    return fmt::format(
        "{}: no difference was seen in any of {} episodes ({}). {} exclude a true difference of "
        "more "
        "than {} points (95 %).",
        metric.name, c.pairs.pairs(), rate(c.first), places(c),
        decimal_text(100 * c.interval.high, 1));
  }
  std::string text = fmt::format("{}: the data cannot tell them apart ({}).", metric.name, numbers);
  if (row.detectable) {
    text += fmt::format(" {} show differences from {} points on, four times in five.", places(c),
                        decimal_text(100 * *row.detectable, 1));
  } else {
    text += fmt::format(" {}, of which {} {}, cannot show a difference reliably.", places(c),
                        place_design(c).differ, place_design(c).differ == 1 ? "differs" : "differ");
  }
  if (row.more_places) {
    text += fmt::format(" If the difference is what was seen, about {} more {} would show it.",
                        *row.more_places, is_one_start_a_place(c) ? "starts" : "places of start");
  }
  return text;
}

std::string listed(const std::vector<const ComparedRow*>& rows) {
  constexpr std::size_t kMost = 6;
  std::string text;
  for (std::size_t i = 0; i < rows.size() && i < kMost; ++i) {
    text += fmt::format("{}{} ({})", i == 0 ? "" : ", ", rows[i]->name,
                        points(rows[i]->contrast.difference));
  }
  if (rows.size() > kMost) text += fmt::format(" and {} more", rows.size() - kMost);
  return text;
}

// Of what was found: when a look after every place would have stopped.
void say_when_enough(const Benchmark& benchmark, int a, int b, Comparison& comparison,
                     const ComparedRow& row) {
  if (!row.is_real()) return;
  for (const SequentialRow& looked : sequential(benchmark, row.metric)) {
    if (looked.a != a || looked.b != b || !looked.stopped) continue;
    comparison.words.push_back(
        fmt::format("  looked at after every {0}, {1} of {2} {0}s would have been enough "
                    "(anytime-valid, {3}).",
                    is_one_start_a_place(row.contrast) ? "start" : "place", looked.used,
                    looked.places, p_text(looked.p)));
  }
}

void say(const Benchmark& benchmark, int a, int b, Comparison& comparison) {
  for (const ComparedRow& row : comparison.rows) {
    if (row.scope != Scope::kAll) continue;
    comparison.words.push_back(verdict(benchmark, comparison, row));
    if (!differs_anywhere(row.contrast)) continue;
    say_when_enough(benchmark, a, b, comparison, row);
    const auto add = [&](Scope scope, const char* one, const char* many, const char* method) {
      std::vector<const ComparedRow*> real;
      std::size_t total = 0;
      for (const ComparedRow& other : comparison.rows) {
        if (other.scope != scope || other.metric != row.metric) continue;
        ++total;
        if (other.is_real()) real.push_back(&other);
      }
      if (total == 0) return;
      std::stable_sort(real.begin(), real.end(), [](const ComparedRow* x, const ComparedRow* y) {
        return std::abs(x->contrast.difference) > std::abs(y->contrast.difference);
      });
      comparison.words.push_back(
          real.empty() ? fmt::format("  no {} of {} differs for certain ({}).", one, total, method)
                       : fmt::format("  {} of {} {} differ ({}): {}.", real.size(), total, many,
                                     method, listed(real)));
    };
    add(Scope::kCategory, "category", "categories", "Holm");
    add(Scope::kAxis, "kind of variant", "kinds of variant", "Holm");
    add(Scope::kTask, "task", "tasks", "Benjamini-Hochberg");
  }
}

bool differs_somewhere(const Comparison& comparison, int metric) {
  return std::any_of(comparison.rows.begin(), comparison.rows.end(), [&](const ComparedRow& row) {
    return row.metric == metric && differs_anywhere(row.contrast);
  });
}

const char* scope_name(Scope scope) {
  switch (scope) {
    case Scope::kAll:
      return "all";
    case Scope::kCategory:
      return "category";
    case Scope::kAxis:
      return "axis";
    case Scope::kTask:
      return "task";
  }
  return "";
}

}  // namespace

std::optional<std::int64_t> places_needed(double difference, double discordance) {
  constexpr std::int64_t kMost = 1'000'000;
  if (difference <= 0 || discordance < difference) return std::nullopt;
  // McNemar's test: n pairs see d with power 1 - b when n = (z_a sqrt(q) + z_b sqrt(q - d^2))^2 /
  // d^2, q the share that differ (Connor 1987, Biometrics 43:207).
  const double alpha = stats::normal_two_sided(1 - kAlpha);
  const double beta = stats::normal_two_sided(2 * kPower - 1);
  const double root = alpha * std::sqrt(discordance) +
                      beta * std::sqrt(std::max(0.0, discordance - difference * difference));
  const double n = std::ceil(root * root / (difference * difference));
  if (n > static_cast<double>(kMost)) return std::nullopt;
  return static_cast<std::int64_t>(n);
}

Result<Comparison> compare(const Benchmark& benchmark, int a, int b,
                           const CompareOptions& options) {
  Comparison comparison;
  comparison.a = benchmark.policies[static_cast<std::size_t>(a)].label;
  comparison.b = benchmark.policies[static_cast<std::size_t>(b)].label;
  std::vector<int> metrics;
  for (const std::string& name : options.metrics) {
    const int metric = benchmark.find_metric(name);
    if (metric == kAbsent) {
      std::string known;
      for (const Metric& m : benchmark.metrics) known += (known.empty() ? "" : ", ") + m.name;
      return Failure{Fault::kUsage,
                     fmt::format("no metric is called `{}`; there are {}", name, known),
                     "--metrics"};
    }
    metrics.push_back(metric);
  }
  if (metrics.empty()) {
    metrics = table_metrics(benchmark);
    // What counts first stands first.
    std::stable_sort(metrics.begin(), metrics.end(), [&](int x, int y) {
      const auto is_success = [&](int m) {
        return benchmark.metrics[static_cast<std::size_t>(m)].name == "success";
      };
      return is_success(x) && !is_success(y);
    });
  }
  const Shared shared = shared_starts(benchmark, a, b);
  if (shared.common == 0) return nothing_shared(benchmark, a, b, shared);
  comparison.common_starts = shared.common;
  comparison.only_a = shared.only_a;
  comparison.only_b = shared.only_b;
  if (shared.only_a + shared.only_b > 0) {
    comparison.notes.push_back(fmt::format(
        "{} episodes are common to both; {} that only {} has and {} that only {} has are left out",
        shared.common, shared.only_a, comparison.a, shared.only_b, comparison.b));
  }
  for (const Note& note : benchmark.notes) comparison.notes.push_back(note.text);
  comparison.rows = Comparer(benchmark, a, b, shared.tasks).rows(metrics);
  say(benchmark, a, b, comparison);
  return comparison;
}

std::string to_text(const Benchmark& benchmark, const Comparison& comparison) {
  std::string text = fmt::format("{} (A) against {} (B), the same {} episodes\n\n", comparison.a,
                                 comparison.b, comparison.common_starts);
  for (const std::string& words : comparison.words) text += words + "\n";
  int last = kAbsent;
  for (const ComparedRow& row : comparison.rows) {
    if (row.scope == Scope::kAll || (row.scope == Scope::kTask && !row.is_real())) continue;
    if (!differs_somewhere(comparison, row.metric)) continue;
    if (row.metric != last) {
      text += fmt::format("\n{:<32} {:>16} {:>16} {:>8} {:>17} {:>9}\n",
                          benchmark.metrics[static_cast<std::size_t>(row.metric)].name, "A", "B",
                          "points", "95 %", "p adj.");
      last = row.metric;
    }
    const Contrast& c = row.contrast;
    const auto of = [](const stats::Count& count) {
      return fmt::format("{}/{} {} %", count.k, count.n, percent_text(count.k, count.n));
    };
    text += fmt::format("{:<32} {:>16} {:>16} {:>8} {:>7} to {:>6} {:>9.2g}{}\n", row.name,
                        of(c.first), of(c.second), points(c.difference), points(c.interval.low),
                        points(c.interval.high), c.adjusted, row.is_real() ? " *" : "");
  }
  if (last != kAbsent) {
    text +=
        "\n* differs; p exact by sign flips of places of start, adjusted over categories and kinds "
        "of variant (Holm) and tasks (Benjamini-Hochberg, only those that differ are listed)\n";
  }
  for (const std::string& note : comparison.notes) text += "\nnote: " + note;
  return text + "\n";
}

Json to_json(const Benchmark& benchmark, const Comparison& comparison) {
  Json json = {{"a", comparison.a},
               {"b", comparison.b},
               {"episodes", comparison.common_starts},
               {"only_a", comparison.only_a},
               {"only_b", comparison.only_b},
               {"words", comparison.words},
               {"notes", comparison.notes}};
  json["rows"] = Json::array();
  for (const ComparedRow& row : comparison.rows) {
    const Contrast& c = row.contrast;
    Json one = {{"scope", scope_name(row.scope)},
                {"name", row.name},
                {"metric", benchmark.metrics[static_cast<std::size_t>(row.metric)].name},
                {"a", {{"k", c.first.k}, {"n", c.first.n}}},
                {"b", {{"k", c.second.k}, {"n", c.second.n}}},
                {"pairs",
                 {{"both", c.pairs.both},
                  {"only_a", c.pairs.only_a},
                  {"only_b", c.pairs.only_b},
                  {"neither", c.pairs.neither}}},
                {"starts", c.starts},
                {"places", c.place_nets.size()},
                {"difference", rounded(c.difference)},
                {"low", rounded(c.interval.low)},
                {"high", rounded(c.interval.high)},
                {"p", c.p},
                {"p_adjusted", c.adjusted},
                {"real", row.is_real()}};
    one["detectable"] = row.detectable ? Json(rounded(*row.detectable)) : Json();
    one["more_places"] = row.more_places ? Json(*row.more_places) : Json();
    json["rows"].push_back(std::move(one));
  }
  return json;
}

}  // namespace probe::report
