// What tests of runs do again and again: options with this tree's assets, a run that has to
// succeed, the traces' hashes of a folder without an invalid episode.
#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "runtime/run/run.h"

namespace probe::run {
using namespace probe::store;

inline RunOptions options_for(const std::string& out, const std::string& policy = "random") {
  RunOptions options;
  options.policy = policy;
  options.out = out;
  options.assets = std::string(VLAPROBE_SOURCE_DIR) + "/assets";
  return options;
}

inline RunSummary must_run(const plan::Plan& plan, const RunOptions& options) {
  const auto summary = run(plan, options);
  REQUIRE_MESSAGE(summary.ok(), to_text(summary.failure()));
  return *summary;
}

inline std::vector<std::string> hashes(const std::string& dir) {
  std::vector<std::string> all;
  const auto rows = read_results(dir);
  REQUIRE_MESSAGE(rows.ok(), to_text(rows.failure()));
  for (const ResultRow& row : *rows) {
    CHECK_MESSAGE(!row.invalid, row.invalid.value_or(""));
    all.push_back(row.trace_sha256);
  }
  return all;
}

}  // namespace probe::run
