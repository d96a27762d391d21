// Models that were asked, in the tables of policies: what every format of table_text.h prints of
// them, made once.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/report/knowledge.h"
#include "runtime/report/tables.h"

namespace probe::report {

// What stands beside the answers that are right in every order of the options.
struct RateKind {
  std::string_view name;  // in tables of data
  std::string_view head;  // in tables for people
  bool is_computed;       // not asked: it has no count
};
inline constexpr std::array<RateKind, 5> kRateKinds = {{{"plain", "in one order", false},
                                                        {"letters", "by likeliest letters", false},
                                                        {"blind", "without the picture", false},
                                                        {"prior", "with another picture", false},
                                                        {"luck", "by chance", true}}};

// A share, with its count where it was counted.
struct RateCell {
  double share = 0;
  std::optional<Estimate> counted = {};
};

// One kind of rate of a model's answers to one family of questions. Nothing in a cell: not asked
// so, or nothing valid came.
struct RateRow {
  int model = 0;
  std::string question;  // the metric in AskedTables::benchmark
  const RateKind* kind = nullptr;
  std::vector<std::optional<RateCell>> cells;  // of all tasks, then by category
};

struct AskedTables {
  Benchmark benchmark;  // models_as_policies
  Tables tables;
  Knowledge knowledge;
  std::vector<RateRow> rates;  // by model, family, kind; those with a cell
};

// Points into `benchmark`. Nothing where no model was asked.
std::optional<AskedTables> make_asked_tables(const Benchmark& benchmark);

}  // namespace probe::report
