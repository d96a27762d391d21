// What the compiler knows of tasks, sets and suites and the text does not show: at their names, and
// behind them.
#pragma once

#include <string>
#include <vector>

#include "compiler/language/snapshot.h"

namespace probe::language {

// Behind a declaration: "\"put carrot on plate\", 24 starts, language.action".
struct Hint {
  std::uint32_t offset = 0;
  std::string label;
};
std::vector<Hint> hints(const Snapshot& snapshot, FileId file, std::uint32_t begin,
                        std::uint32_t end);

// Above a declaration: what can be done with it.
enum class LensKind : std::uint8_t { kTask, kSuite };
struct Lens {
  Span name;
  LensKind kind = LensKind::kTask;
  std::string subject;  // the task or suite
  std::string title;    // "24 starts"
};
std::vector<Lens> lenses(const Snapshot& snapshot, FileId file);

// "language.action, light": what a variant moves; empty for no variant.
std::string axes_text(const sema::Task& task);
// "24 starts", "1 start".
std::string starts_text(const sema::Task& task);

}  // namespace probe::language
