// Every difference of the tables as a line of CSV, both questions beside each other.
#include <fmt/format.h>

#include <string_view>

#include "runtime/base/csv.h"
#include "runtime/base/percent.h"
#include "runtime/report/categories.h"
#include "runtime/report/page_data.h"
#include "runtime/report/table_parts.h"

namespace probe::report {
namespace {

// `of` is the policy, or the first of two; `against` a baseline or the other policy. Counts, then
// points; units are starts on these starts, places for starts never tried.
constexpr std::string_view kHead =
    "kind,of,against,scope,metric,k,n,against_k,against_n,points,"
    "on_these_starts_units,on_these_starts_low,on_these_starts_high,on_these_starts_p,"
    "on_these_starts_p_adjusted,"
    "for_starts_never_tried_units,for_starts_never_tried_low,for_starts_never_tried_high,"
    "for_starts_never_tried_p,for_starts_never_tried_p_adjusted\n";

std::string answer(const Answer& a) {
  return fmt::format(",{},{},{},{:.4g},{:.4g}", a.nets.size(),
                     decimal_text(100 * a.interval.low, 1), decimal_text(100 * a.interval.high, 1),
                     a.p, a.adjusted);
}

std::string line(std::string_view kind, const std::string& of, const std::string& against,
                 const std::string& scope, const std::string& metric, const Contrast& c) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{}{}{}\n", kind, csv_cell(of), csv_cell(against),
                     csv_cell(scope), csv_cell(metric), c.first.k, c.first.n, c.second.k,
                     c.second.n, decimal_text(100 * c.difference, 1), answer(c.here),
                     answer(c.anew));
}

std::string lines(const Benchmark& benchmark, const Tables& tables) {
  const auto policy = [&](int p) { return benchmark.policies[static_cast<std::size_t>(p)].label; };
  const auto metric = [&](int m) { return benchmark.metrics[static_cast<std::size_t>(m)].name; };
  const auto category = [&](int c) { return category_name(benchmark, c); };
  const auto task = [&](int t) -> const Task& {
    return benchmark.tasks[static_cast<std::size_t>(t)];
  };
  std::string text;
  for (const CategoryDeltaRow& row : tables.category_deltas) {
    text += line("category", policy(row.policy), "baselines", category(row.category),
                 metric(row.metric), row.contrast);
  }
  for (const DeltaRow& row : tables.deltas) {
    const Task& variant = task(row.task);
    text += line("task", policy(row.policy), task(variant.baseline).name, variant.name,
                 metric(row.metric), row.contrast);
  }
  for (const PolicyRow& row : tables.policies) {
    text += line("policies", policy(row.a), policy(row.b), category(row.category),
                 metric(row.metric), row.contrast);
  }
  return text;
}

}  // namespace

std::string differences_csv(const TablesToPrint& print) {
  const Benchmark& benchmark = print.benchmark;
  std::string text = std::string(kHead) + lines(benchmark, print.tables);
  if (print.asked == nullptr) return text;
  text += lines(print.asked->benchmark, print.asked->tables);
  for (const KnowsRow& row : print.asked->knowledge.knows) {
    text +=
        line("knows-goes", benchmark.models[static_cast<std::size_t>(row.model)].label,
             benchmark.policies[static_cast<std::size_t>(row.policy)].label,
             category_name(benchmark, row.category), question_name(benchmark, row), row.contrast);
  }
  return text;
}

}  // namespace probe::report
