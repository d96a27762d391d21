// Two policies: which differences are real, how large, on which axes; plain words first, then
// numbers, and what the data cannot tell.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runtime/report/benchmark.h"
#include "runtime/report/tables.h"

namespace probe::report {

struct CompareOptions {
  std::vector<std::string> metrics = {};  // empty: those of the tables
};

// One line of the comparison. `adjusted` after Holm over the categories (or axes, or metrics) of a
// metric, after Benjamini and Hochberg over its tasks.
struct ComparedRow {
  enum class Scope : std::uint8_t { kAll, kCategory, kAxis, kTask };
  Scope scope = Scope::kAll;
  int metric = 0;
  std::string name;  // of category, axis or task
  Contrast contrast;
  std::optional<double> detectable;         // where no difference was found
  std::optional<std::int64_t> more_places;  // of start, that would find the difference seen, with
                                            // 80 % power

  bool is_real() const { return contrast.adjusted <= 0.05; }
};

struct Comparison {
  std::string a, b;                // labels
  std::vector<std::string> words;  // sentences, most important first
  std::vector<ComparedRow> rows;
  std::vector<std::string> notes;  // about what was compared: partial runs, other plans
  std::size_t common_starts = 0, only_a = 0, only_b = 0;
};

// Policy a against policy b of a loaded benchmark. Fails (kUsage) when they share no start,
// and says why.
Result<Comparison> compare(const Benchmark& benchmark, int a, int b,
                           const CompareOptions& options = {});

std::string to_text(const Benchmark& benchmark, const Comparison& comparison);
nlohmann::ordered_json to_json(const Benchmark& benchmark, const Comparison& comparison);

// How many paired places of the same kind would find `difference` with 80 % power, when a share
// `discordance` of them differ; nothing when a million would not.
std::optional<std::int64_t> places_needed(double difference, double discordance);

}  // namespace probe::report
