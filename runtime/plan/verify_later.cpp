// Stage 2, later sentences: in the order of their tasks, each another than the one before it, each with
// a condition.
#include <fmt/format.h>

#include "runtime/plan/verify.h"
#include "runtime/plan/verify_records.h"

namespace probe::plan {
namespace {

class LaterCheck : FieldCheck {
 public:
  using FieldCheck::FieldCheck;

  Status run() const {
    std::uint32_t last = 0;
    std::string_view before;
    for (std::size_t i = 0; i < t.later.size(); ++i) {
      const LaterRecord& later = t.later[i];
      if (later.task < last)
        return fail(Rule::kLaterOrder, &later.task,
                    fmt::format("a later sentence of task {} stands behind one of task {}",
                                later.task, last));
      if (i == 0 || later.task != last) before = t.text(t.tasks[later.task].prompt);
      last = later.task;
      // Which of two is in force is read off what the policy was told.
      if (t.text(later.text) == before)
        return fail(Rule::kLaterOrder, &later.text,
                    fmt::format("task `{}` says \"{}\" twice in turn",
                                t.text(t.tasks[later.task].name), before));
      before = t.text(later.text);
      const auto metrics = slice_of(t.metrics, t.programs[later.program].metrics);
      if (metrics.size() != 1 ||
          metrics[0].type != static_cast<std::uint32_t>(MetricType::kBool))
        return fail(Rule::kLaterProgram, &later.program,
                    "the condition of a later sentence is one truth");
    }
    return {};
  }
};

}  // namespace

Status verify_later(std::span<const std::byte> bytes, const Tables& tables) {
  return LaterCheck(bytes, tables).run();
}

}  // namespace probe::plan
