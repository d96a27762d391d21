// Two policies: which differences are real, on the starts that were run and for starts never tried,
// how large, on which axes; plain words first, then numbers, and what the data cannot tell.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/json.h"
#include "runtime/report/benchmark.h"
#include "runtime/report/tables.h"

namespace probe::report {

struct CompareOptions {
  std::vector<std::string> metrics = {};  // empty: those of the tables
};

// One line of the comparison. Adjusted after Holm over the categories (or axes, or metrics) of a
// metric, after Benjamini and Hochberg over its tasks; each question for itself.
struct ComparedRow {
  enum class Scope : std::uint8_t { kAll, kCategory, kAxis, kTask };
  Scope scope = Scope::kAll;
  int metric = 0;
  std::string name;  // of category, axis or task
  Contrast contrast;

  bool is_real() const { return contrast.here.is_real() || contrast.anew.is_real(); }
};

// What may be said of two runs of which one stops by what it finds: a start, with its seeds, is won by
// either side or by none, on these starts alone.
struct AnytimeRow {
  int metric = 0;
  stats::Count first = {}, second = {};  // of the episodes of these starts
  std::int64_t starts = 0, won = 0, lost = 0;
  std::int64_t left_out = 0;  // starts that the other one has not run
  double p = 1, adjusted = 1;  // anytime-valid; after Holm over the metrics
  int leads = 0;               // 1: the first has more, -1: fewer

  bool is_real() const { return adjusted <= kAlpha; }
};

struct Comparison {
  std::string a, b;                // labels
  std::vector<std::string> words;  // sentences, most important first
  std::vector<ComparedRow> rows;
  std::vector<AnytimeRow> anytime;  // in place of rows, where a run stops by what it finds
  std::vector<std::string> notes;  // about what was compared: partial runs, other plans
  std::size_t common_starts = 0, only_a = 0, only_b = 0;
};

// Policy a against policy b of a loaded benchmark. Fails (kUsage) when they share no start,
// and says why.
Result<Comparison> compare(const Benchmark& benchmark, int a, int b,
                           const CompareOptions& options = {});

std::string to_text(const Benchmark& benchmark, const Comparison& comparison);
Json to_json(const Benchmark& benchmark, const Comparison& comparison);

}  // namespace probe::report
