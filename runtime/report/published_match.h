// A published table beside the runs: which of its columns is which of ours, and what it names that
// the runs do not have.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "runtime/report/benchmark.h"
#include "runtime/report/published.h"

namespace probe::report {

// By our columns (all tasks, then the categories): the table's. "avg" or "all" is all tasks, a
// category goes by its name or its label.
std::vector<std::optional<std::size_t>> matched_columns(const Benchmark& benchmark,
                                                        const PublishedTable& table);

// A warning for each column and metric that has no counterpart, with its place and the nearest
// name.
std::vector<Note> unmatched(const Benchmark& benchmark, const PublishedTable& table);

}  // namespace probe::report
