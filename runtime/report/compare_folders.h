// Two folders, of runs or of answers, as a comparison.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/report/benchmark.h"
#include "runtime/report/compare.h"

namespace probe::report {

struct CompareFoldersOptions {
  std::vector<std::string> metrics = {};  // empty: those of the tables
  std::vector<std::string> sets = {};     // of the plan that are the categories; empty: its finest
};

struct ComparedFolders {
  Benchmark benchmark;  // what the comparison's numbers index
  Comparison comparison;
};

// Rows that their traces do not bear are in no number: a note of level "bad" names them. Fails
// (kUsage) on one folder twice, on a run beside answers, and as load() and compare() do.
Result<ComparedFolders> compare_folders(const std::string& a, const std::string& b,
                                        const CompareFoldersOptions& options = {});

}  // namespace probe::report
