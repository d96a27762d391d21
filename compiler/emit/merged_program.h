// A stored program with more metrics behind its own.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "compiler/lower/program.h"
#include "runtime/base/result.h"
#include "runtime/plan/writer.h"

namespace probe::emit {

// Appends to the writer's records a program that judges as `stored`, one of theirs, and `added`
// together; a metric of `added` replaces one of its name. `source_of` gives the text of a file.
// Returns its index; fails (kUsage) when it becomes longer than programs may be.
Result<std::uint32_t> merge_program(plan::Writer& writer, const plan::ProgramRecord& stored,
                                    const lower::Program& added,
                                    std::span<const std::uint32_t> source_of,
                                    std::string_view task);

}  // namespace probe::emit
