// What stands out of the tables, in words.
#include <fmt/format.h>

#include <algorithm>

#include "runtime/base/percent.h"
#include "runtime/report/page_data.h"
#include "runtime/store/not_attempted.h"

namespace probe::report {
namespace {

Json finding(const char* level, std::string text, const char* see) {
  return {{"level", level}, {"text", std::move(text)}, {"see", see}};
}

std::string points_text(double difference) { return signed_text(100 * difference, 1) + " points"; }

// Of the policies under test, where there are some.
bool is_tested(const Benchmark& benchmark, int policy) {
  const auto is_model = [](const Policy& p) { return p.role == Role::kModel; };
  if (std::none_of(benchmark.policies.begin(), benchmark.policies.end(), is_model)) return true;
  return is_model(benchmark.policies[static_cast<std::size_t>(policy)]);
}

void add_categories(const Benchmark& benchmark, const Tables& tables, int metric, Json& found) {
  for (std::size_t p = 0; p < benchmark.policies.size(); ++p) {
    if (!is_tested(benchmark, static_cast<int>(p))) continue;
    const CategoryDeltaRow* worst = nullptr;
    int here = 0, anew = 0, rows = 0;
    for (const CategoryDeltaRow& row : tables.category_deltas) {
      if (row.policy != static_cast<int>(p) || row.metric != metric) continue;
      ++rows;
      here += row.contrast.here.is_real() ? 1 : 0;
      anew += row.contrast.anew.is_real() ? 1 : 0;
      if (!row.contrast.here.is_real() && !row.contrast.anew.is_real()) continue;
      if (worst == nullptr || row.contrast.difference < worst->contrast.difference) worst = &row;
    }
    if (worst == nullptr) continue;
    const Contrast& c = worst->contrast;
    found.push_back(finding(
        c.difference < 0 ? "warn" : "note",
        fmt::format(
            "{}: {} of {} categories differ from their baselines in {} on these starts, {} "
            "for starts never tried; the largest is {}, {} ({} of {} against {} of {}; after "
            "Holm {} on these starts, {} for starts never tried)",
            benchmark.policies[p].label, here, rows,
            benchmark.metrics[static_cast<std::size_t>(metric)].name, anew,
            benchmark.categories[static_cast<std::size_t>(worst->category)].label,
            points_text(c.difference), c.first.k, c.first.n, c.second.k, c.second.n,
            p_text(c.here.adjusted), p_text(c.anew.adjusted)),
        "deltas"));
  }
}

void add_gap(const Benchmark& benchmark, const Tables& tables, Json& found) {
  for (const GapRow& row : tables.gap) {
    if (row.category != kAbsent || !is_tested(benchmark, row.policy) ||
        row.contrast.difference < 0.1)
      continue;
    const Contrast& c = row.contrast;
    found.push_back(finding(
        "note",
        fmt::format("{}: goes for the right object in {} of {} episodes and succeeds in {}: a gap "
                    "of {} points ({} to {})",
                    benchmark.policies[static_cast<std::size_t>(row.policy)].label, c.first.k,
                    c.first.n, c.second.k, decimal_text(100 * c.difference, 1),
                    decimal_text(100 * c.anew.interval.low, 1),
                    decimal_text(100 * c.anew.interval.high, 1)),
        "gap"));
  }
}

}  // namespace

Json findings(const Benchmark& benchmark, const Tables& tables) {
  Json found = Json::array();
  std::size_t invalid = 0, floors = 0, ceilings = 0, confounded = 0, variants = 0;
  for (const Episode& e : benchmark.episodes) invalid += e.is_open ? 1 : 0;
  if (invalid > 0) {
    found.push_back(finding(2 * invalid > benchmark.episodes.size() ? "bad" : "warn",
                            fmt::format("{} of {} episodes are invalid and count neither way",
                                        invalid, benchmark.episodes.size()),
                            "invalid"));
  }
  if (const int success = benchmark.find_metric("success"); success != kAbsent) {
    add_categories(benchmark, tables, success, found);
    for (const FloorRow& row : tables.floors) {
      if (row.metric != success || row.note.empty()) continue;
      floors += row.floor && row.floor->count.k > 0 ? 1 : 0;
      ceilings += row.ceiling && row.ceiling->count.k < row.ceiling->count.n ? 1 : 0;
    }
  }
  add_gap(benchmark, tables, found);
  if (floors > 0) {
    found.push_back(
        finding("bad", fmt::format("{} tasks are also solved by doing nothing", floors), "floors"));
  }
  if (ceilings > 0) {
    found.push_back(finding(
        "warn", fmt::format("{} tasks have starts that not even the expert solves", ceilings),
        "floors"));
  }
  for (const Task& task : benchmark.tasks) {
    variants += task.baseline != kAbsent ? 1 : 0;
    confounded += task.confounded.empty() ? 0 : 1;
  }
  if (confounded > 0) {
    found.push_back(finding("note",
                            fmt::format("{} of {} comparisons with a baseline move more than one "
                                        "thing; their differences are not one axis's doing",
                                        confounded, variants),
                            "confounded"));
  }
  return found;
}

}  // namespace probe::report
