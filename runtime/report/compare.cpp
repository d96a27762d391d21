#include "runtime/report/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runtime/base/percent.h"
#include "runtime/plan/axes.h"
#include "runtime/report/compare_adaptive.h"
#include "runtime/report/models.h"
#include "runtime/report/page_data.h"

namespace probe::report {
namespace {

using Scope = ComparedRow::Scope;

struct Shared {
  std::size_t common = 0, only_a = 0, only_b = 0;
  std::vector<int> tasks;  // that have a common start
};

Shared shared_starts(const Benchmark& benchmark, int a, int b) {
  Shared shared;
  for (const int t : benchmark.all_tasks()) {
    std::set<std::pair<int, int>> ours, theirs;
    for (const Episode& e : benchmark.of(a, t)) {
      if (e.valid()) ours.emplace(e.start, e.seed);
    }
    for (const Episode& e : benchmark.of(b, t)) {
      if (e.valid()) theirs.emplace(e.start, e.seed);
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
          fmt::format("`{}` and `{}` share no {}: {}", first.label, second.label, benchmark.things,
                      why),
          ""};
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
    adjust(0, Adjustment::kHolm);
    for (const int m : metrics) {
      std::size_t first = rows_.size();
      for (const Category& c : benchmark_.categories)
        add(Scope::kCategory, m, c.label, both(tasks_, c.tasks));
      adjust(first, Adjustment::kHolm);
      first = rows_.size();
      add_axes(m);
      adjust(first, Adjustment::kHolm);
      first = rows_.size();
      for (const int t : tasks_)
        add(Scope::kTask, m, benchmark_.tasks[static_cast<std::size_t>(t)].name, {t});
      adjust(first, Adjustment::kBenjaminiHochberg);
    }
    for (ComparedRow& row : rows_) {
      if (row.scope != Scope::kTask) say_what_would_tell(row.contrast);
    }
    return std::move(rows_);
  }

 private:
  void add(Scope scope, int metric, const std::string& name, const std::vector<int>& tasks) {
    ComparedRow row{scope, metric, name, policy_contrast(benchmark_, a_, b_, metric, tasks)};
    if (row.contrast.first.n > 0) rows_.push_back(std::move(row));
  }

  // The tasks that move an axis against their own baselines.
  void add_axes(int metric) {
    for (const plan::AxisInfo& info : plan::kAxisTable) {
      std::vector<int> tasks;
      for (const int t : tasks_) {
        const std::uint32_t moved = benchmark_.tasks[static_cast<std::size_t>(t)].axes;
        if (plan::moves(moved, info.axis)) tasks.push_back(t);
      }
      if (!tasks.empty()) add(Scope::kAxis, metric, "moves " + std::string(info.name), tasks);
    }
  }

  void adjust(std::size_t first, Adjustment method) {
    std::vector<Contrast*> family;
    for (std::size_t i = first; i < rows_.size(); ++i) family.push_back(&rows_[i].contrast);
    report::adjust(family, method);
  }

  const Benchmark& benchmark_;
  int a_, b_;
  std::vector<int> tasks_;
  std::vector<ComparedRow> rows_;
};

// Where every place has one start, both questions have one answer.
bool is_one_start_a_place(const Contrast& c) { return c.anew.nets.size() == c.here.nets.size(); }

// What was tried: "96 starts in 24 places".
std::string places(const Contrast& c) {
  const auto count = static_cast<std::int64_t>(c.anew.nets.size());
  if (is_one_start_a_place(c)) return fmt::format("{} {}", count, count == 1 ? "start" : "starts");
  return fmt::format("{} starts in {} {}", c.starts, count, count == 1 ? "place" : "places");
}

bool differs_anywhere(const Contrast& c) { return c.pairs.only_a + c.pairs.only_b > 0; }

std::string rate(const stats::Count& count) {
  return fmt::format("{} of {} ({} %)", count.k, count.n, percent_text(count.k, count.n));
}

std::string points(double difference) { return signed_text(100 * difference, 1); }

std::string from_to(const Answer& answer) {
  return fmt::format("{} to {}", points(answer.interval.low), points(answer.interval.high));
}

// "+24.9 to +29.9; p < 0.0001"
std::string interval_and_p(const Answer& answer) {
  return fmt::format("{}; {}", from_to(answer), p_text(answer.adjusted));
}

// "24 of 24 (100.0 %) against 6 of 24 (25.0 %); +75.0 points"
std::string seen(const Contrast& c) {
  return fmt::format("{} against {}; {} points", rate(c.first), rate(c.second),
                     points(c.difference));
}

constexpr char kHere[] = "on these starts";
constexpr char kAnew[] = "for starts never tried";

// What would have shown a difference in new places, as further sentences.
std::string what_would_tell(const Contrast& c) {
  std::string text;
  if (c.anew.detectable) {
    text += fmt::format(" {} show differences from {} points on, four times in five.", places(c),
                        decimal_text(100 * *c.anew.detectable, 1));
  } else {
    const std::int64_t differ = unit_design(c, c.anew).differ;
    text += fmt::format(" {}, of which {} {}, cannot show a difference reliably.", places(c),
                        differ, differ == 1 ? "differs" : "differ");
  }
  if (c.anew.more) {
    text += fmt::format(" If the difference is what was seen, about {} more {} would show it.",
                        *c.anew.more, is_one_start_a_place(c) ? "starts" : "places of start");
  }
  return text;
}

std::string no_difference(const Benchmark& benchmark, const Metric& metric, const Contrast& c) {
  std::string text = fmt::format(
      "{}: no difference was seen in any of {} {} ({}). {} exclude a true difference of more "
      "than {} points (95 %)",
      metric.name, c.pairs.pairs(), benchmark.things, rate(c.first), places(c),
      decimal_text(100 * c.anew.interval.high, 1));
  if (!is_one_start_a_place(c)) {
    text += fmt::format(" {}, and of more than {} {}", kAnew,
                        decimal_text(100 * c.here.interval.high, 1), kHere);
  }
  return text + ".";
}

std::string verdict(const Benchmark& benchmark, const Comparison& comparison,
                    const ComparedRow& row) {
  const Metric& metric = benchmark.metrics[static_cast<std::size_t>(row.metric)];
  const Contrast& c = row.contrast;
  if (!differs_anywhere(c)) return no_difference(benchmark, metric, c);
  const bool here = c.here.is_real(), anew = c.anew.is_real();
  const bool one_answer = is_one_start_a_place(c);
  if (!here && !anew) {
    const std::string aside =
        one_answer ? "" : fmt::format("; {} {}", kHere, interval_and_p(c.here));
    return fmt::format("{}: the data cannot tell them apart ({}, {}{}).{}", metric.name, seen(c),
                       interval_and_p(c.anew), aside, what_would_tell(c));
  }
  // "more" is not "better" for every metric.
  const bool a_better = (c.difference > 0) == (metric.good >= 0);
  const std::string who =
      fmt::format("{}: {} is {}", metric.name, a_better ? comparison.a : comparison.b,
                  metric.good == 0 ? "higher" : "better");
  if (one_answer)
    return fmt::format("{} ({}, {}), {} and {}.", who, seen(c), interval_and_p(c.anew), kHere,
                       kAnew);
  if (here && anew) {
    return fmt::format("{} ({}), {} ({}) and {} ({}).", who, seen(c), kHere, interval_and_p(c.here),
                       kAnew, interval_and_p(c.anew));
  }
  if (here) {
    const std::string missing = c.anew.more
                                    ? fmt::format(", about {} more {} of start would", *c.anew.more,
                                                  *c.anew.more == 1 ? "place" : "places")
                                    : "";
    return fmt::format("{} {} ({}, {}); {} the data cannot tell ({}){}.{}", who, kHere, seen(c),
                       interval_and_p(c.here), kAnew, interval_and_p(c.anew), missing,
                       c.anew.more ? "" : what_would_tell(c));
  }
  return fmt::format("{} {} ({}, {}); {}, exchanged one by one, the data cannot tell ({}).", who,
                     kAnew, seen(c), interval_and_p(c.anew), kHere, interval_and_p(c.here));
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

// Of what was found: when a look after every place, and after every start, would have stopped.
void say_when_enough(const Benchmark& benchmark, int a, int b, Comparison& comparison,
                     const ComparedRow& row) {
  const bool one_answer = is_one_start_a_place(row.contrast);
  const auto add = [&](const Looked& looked, const Answer& answer, const char* unit,
                       const std::string& question) {
    if (!looked.stopped || !answer.is_real()) return;
    comparison.words.push_back(
        fmt::format("  looked at after every {0}, {1} of {2} {0}s would have been enough{3} "
                    "(anytime-valid, {4}).",
                    unit, looked.used, looked.units, question, p_text(looked.p)));
  };
  for (const SequentialRow& looked : sequential(benchmark, row.metric)) {
    if (looked.a != a || looked.b != b) continue;
    if (one_answer) {
      add(looked.anew, row.contrast.anew, "start", "");
      continue;
    }
    add(looked.anew, row.contrast.anew, "place", std::string(" ") + kAnew);
    add(looked.here, row.contrast.here, "start", std::string(" ") + kHere);
  }
}

using Rows = std::vector<const ComparedRow*>;

// Those that are real for a question, largest first.
Rows real_rows(const Rows& rows, Answer Contrast::*question) {
  Rows real;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(real),
               [&](const ComparedRow* row) { return (row->contrast.*question).is_real(); });
  std::stable_sort(real.begin(), real.end(), [](const ComparedRow* x, const ComparedRow* y) {
    return std::abs(x->contrast.difference) > std::abs(y->contrast.difference);
  });
  return real;
}

// "  3 of 11 categories differ on these starts (Holm): ...", for both questions at once where the
// same ones do.
void say_which(const Rows& rows, const char* one, const char* many, const char* method,
               Comparison& comparison) {
  if (rows.empty()) return;
  const Rows here = real_rows(rows, &Contrast::here), anew = real_rows(rows, &Contrast::anew);
  const auto add = [&](const Rows& real, const std::string& question) {
    comparison.words.push_back(
        real.empty() ? fmt::format("  no {} of {} differs for certain{} ({}).", one, rows.size(),
                                   question, method)
                     : fmt::format("  {} of {} {} differ{} ({}): {}.", real.size(), rows.size(),
                                   many, question, method, listed(real)));
  };
  if (here.empty() && anew.empty()) {
    add(here, "");
  } else if (here == anew) {
    add(here, fmt::format(" {} and {}", kHere, kAnew));
  } else {
    add(here, fmt::format(" {}", kHere));
    add(anew, fmt::format(" {}", kAnew));
  }
}

void say(const Benchmark& benchmark, int a, int b, Comparison& comparison) {
  for (const ComparedRow& row : comparison.rows) {
    if (row.scope != Scope::kAll) continue;
    comparison.words.push_back(verdict(benchmark, comparison, row));
    if (!differs_anywhere(row.contrast)) continue;
    say_when_enough(benchmark, a, b, comparison, row);
    const auto add = [&](Scope scope, const char* one, const char* many, const char* method) {
      Rows rows;
      for (const ComparedRow& other : comparison.rows) {
        if (other.scope == scope && other.metric == row.metric) rows.push_back(&other);
      }
      say_which(rows, one, many, method, comparison);
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

// Of runs of which one stops by what it finds.
std::string anytime_verdict(const Benchmark& benchmark, const Comparison& comparison,
                            const AnytimeRow& row, const std::string& other) {
  const Metric& metric = benchmark.metrics[static_cast<std::size_t>(row.metric)];
  std::string numbers = fmt::format(
      "{} against {}; of {} starts {} has more on {}, fewer on {}; anytime-valid {}",
      rate(row.first), rate(row.second), row.starts, comparison.a, row.won, row.lost,
      p_text(row.adjusted));
  if (row.left_out > 0)
    numbers += fmt::format("; {} starts that {} has not run are left out", row.left_out, other);
  if (!row.is_real())
    return fmt::format("{}: not decided on these starts ({}).", metric.name, numbers);
  const bool a_better = (row.leads > 0) == (metric.good >= 0);
  return fmt::format("{}: {} is {} on these starts ({}).", metric.name,
                     a_better ? comparison.a : comparison.b,
                     metric.good == 0 ? "higher" : "better", numbers);
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
  const bool is_adaptive = benchmark.is_adaptive(a) || benchmark.is_adaptive(b);
  if (metrics.empty() && is_adaptive && benchmark.find_metric("success") != kAbsent)
    metrics = {benchmark.find_metric("success")};  // which it was stopped by
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
        "{} {} are common to both; {} that only {} has and {} that only {} has are left out",
        shared.common, benchmark.things, shared.only_a, comparison.a, shared.only_b, comparison.b));
  }
  for (const Note& note : benchmark.notes) comparison.notes.push_back(note.text);
  if (is_adaptive) {
    PROBE_ASSIGN(comparison.anytime, compare_at_any_time(benchmark, a, b, metrics));
    const std::string& other = benchmark.is_adaptive(a) ? comparison.b : comparison.a;
    for (const AnytimeRow& row : comparison.anytime)
      comparison.words.push_back(anytime_verdict(benchmark, comparison, row, other));
    comparison.notes.push_back(
        "the starts were won or lost one by one, which may be looked at at any time; how large the "
        "difference is, categories, tasks, and what holds for starts never tried are left out");
    return comparison;
  }
  comparison.rows = Comparer(benchmark, a, b, shared.tasks).rows(metrics);
  say(benchmark, a, b, comparison);
  return comparison;
}

std::string to_text(const Benchmark& benchmark, const Comparison& comparison) {
  std::string text = fmt::format("{} (A) against {} (B), the same {} {}\n\n", comparison.a,
                                 comparison.b, comparison.common_starts, benchmark.things);
  for (const std::string& words : comparison.words) text += words + "\n";
  int last = kAbsent;
  for (const ComparedRow& row : comparison.rows) {
    if (row.scope == Scope::kAll || (row.scope == Scope::kTask && !row.is_real())) continue;
    if (!differs_somewhere(comparison, row.metric)) continue;
    if (row.metric != last) {
      text += fmt::format("\n{:<32} {:>16} {:>16} {:>8} {:>17} {:>10} {:>10}\n",
                          benchmark.metrics[static_cast<std::size_t>(row.metric)].name, "A", "B",
                          "points", "95 %", "p, these", "p, new");
      last = row.metric;
    }
    const Contrast& c = row.contrast;
    const auto of = [](const stats::Count& count) {
      return fmt::format("{}/{} {} %", count.k, count.n, percent_text(count.k, count.n));
    };
    const auto p = [](const Answer& answer) {
      return fmt::format("{:.2g}{}", answer.adjusted, answer.is_real() ? "*" : "");
    };
    text +=
        fmt::format("{:<32} {:>16} {:>16} {:>8} {:>7} to {:>6} {:>10} {:>10}\n", row.name,
                    of(c.first), of(c.second), points(c.difference), points(c.anew.interval.low),
                    points(c.anew.interval.high), p(c.here), p(c.anew));
  }
  if (last != kAbsent) {
    text +=
        "\n* differs. p, these: on these starts, exact by sign flips of starts; p, new and 95 %: "
        "for "
        "starts never tried, by places of start; adjusted over categories and kinds of variant "
        "(Holm) and tasks (Benjamini-Hochberg, only those that differ are listed)\n";
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
  for (const AnytimeRow& row : comparison.anytime) {
    json["at_any_time"].push_back(
        {{"metric", benchmark.metrics[static_cast<std::size_t>(row.metric)].name},
         {"a", {{"k", row.first.k}, {"n", row.first.n}}},
         {"b", {{"k", row.second.k}, {"n", row.second.n}}},
         {"starts", row.starts},
         {"a_wins", row.won},
         {"b_wins", row.lost},
         {"left_out", row.left_out},
         {"p", row.p},
         {"p_adjusted", row.adjusted},
         {"real", row.is_real()}});
  }
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
                {"places", c.anew.nets.size()},
                {"difference", rounded(c.difference)},
                {"low", rounded(c.anew.interval.low)},
                {"high", rounded(c.anew.interval.high)},
                {"p", c.anew.p},
                {"p_adjusted", c.anew.adjusted},
                {"real", c.anew.is_real()}};
    one["detectable"] = c.anew.detectable ? Json(rounded(*c.anew.detectable)) : Json();
    one["more_places"] = c.anew.more ? Json(*c.anew.more) : Json();
    put_answers(one, c);
    json["rows"].push_back(std::move(one));
  }
  return json;
}

}  // namespace probe::report
