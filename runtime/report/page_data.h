// The document `data` of the report page, as PAGE_DATA.md describes it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/report/benchmark.h"
#include "runtime/report/knowledge.h"
#include "runtime/report/published.h"
#include "runtime/report/tables.h"

namespace probe::report {

struct PageOptions {
  std::string title, command = {}, program = {};
  std::string relative_to = {};  // folder of the page; dirs and videos are written from it
  std::vector<PublishedTable> published = {};  // other people's numbers
  bool models = true;                          // mixed models, which take seconds
  std::size_t plain = SIZE_MAX;                // episodes whose columns are arrays; more are packed
  Json events = nullptr;                       // of events_json(), or none
};

Json page_data(const Benchmark& benchmark, const Tables& tables, const PageOptions& options);
inline Json page_data(const Benchmark& benchmark, const PageOptions& options) {
  return page_data(benchmark, make_tables(benchmark), options);
}

// Its parts.
Json tables_json(const Benchmark& benchmark, const Tables& tables, const PageOptions& options);
// Of how many tasks a published percentage is, over all and by category, and how many episodes each
// has: theirs have no starts of ours, so the first plan's suite and seeds stand for them.
struct PublishedSizes {
  std::vector<std::int64_t> tasks;
  std::int64_t per_task = 0;
};
PublishedSizes published_sizes(const Benchmark& benchmark);

Json external_json(const Benchmark& benchmark, const std::vector<PublishedTable>& published);
// [{level, text, see}], most important first.
Json findings(const Benchmark& benchmark, const Tables& tables);

// [k, n, low, high, rate?], rounded to four digits, see PAGE_DATA.md; null without an episode.
Json to_json(const std::optional<Estimate>& estimate);
double rounded(double value);  // to four digits behind the point
// "p = 0.19", "p < 0.0001".
std::string p_text(double p);

// Adds both answers of a contrast by name, the same in every document: {units, low, high, p,
// p_adjusted?, real?, detectable?, more?}; `scale` of differences (1: rates, 100: points).
void put_answers(Json& json, const Contrast& contrast, double scale = 1, bool adjusted = true);
inline constexpr char kOnTheseStarts[] = "on_these_starts";
inline constexpr char kForStartsNeverTried[] = "for_starts_never_tried";

// What an interval of these tables is, in a sentence or two.
std::string interval_text(const Benchmark& benchmark);
// Of policies that stop by what they find.
std::string adaptive_interval_text();

// Floors and ceilings that were measured before, as suite/floors.csv holds them, for tasks of which
// the runs have none; a file of another plan is a note.
Status add_floors(const std::string& path, Benchmark& benchmark, Tables& tables);

}  // namespace probe::report
