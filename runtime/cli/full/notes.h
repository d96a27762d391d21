// What a report and a comparison have to say about the runs beside their numbers, for people.
#pragma once

#include <span>

#include "runtime/report/benchmark.h"

namespace probe::cli {

// What a verb ends with that has told of `benchmark`: 2 where rows were left out, as for `results`.
int exit_of(const report::Benchmark& benchmark);

// One line each on standard error: "note: ..." or "warning: ...".
void say_notes(std::span<const report::Note> notes);

}  // namespace probe::cli
