// Stage 2, claims: in the order of their tasks, each of an object that its program tells of.
#include <fmt/format.h>

#include <optional>

#include "runtime/plan/claims.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/verify.h"
#include "runtime/plan/verify_records.h"

namespace probe::plan {
namespace {

class ClaimCheck : FieldCheck {
 public:
  using FieldCheck::FieldCheck;

  Status run() const {
    std::uint32_t last = 0;
    for (const ClaimRecord& claim : t.claims) {
      if (claim.task < last)
        return fail(
            Rule::kClaimOrder, &claim.task,
            fmt::format("a claim of task {} stands behind one of task {}", claim.task, last));
      last = claim.task;
      PROBE_TRY(one(claim));
    }
    return {};
  }

 private:
  Status one(const ClaimRecord& claim) const {
    const TaskRecord& task = t.tasks[claim.task];
    const auto bodies = slice_of(t.bodies, task.bodies);
    const auto can_be_meant = [&](std::uint32_t body) {
      return body < bodies.size() &&
             (bodies[body].kind == static_cast<std::uint32_t>(BodyKind::kObject) ||
              bodies[body].kind == static_cast<std::uint32_t>(BodyKind::kPart));
    };
    if (!can_be_meant(claim.body))
      return fail(
          Rule::kClaimBody, &claim.body,
          fmt::format("body {} is no object or part of task `{}`", claim.body, t.text(task.name)));
    const ProgramRecord& program = t.programs[claim.program];
    if (program.states.count > 0)
      return fail(Rule::kClaimProgram, &claim.program,
                  "what is judged of a start alone remembers nothing");
    bool is_told = false;
    for (const MetricRecord& metric : slice_of(t.metrics, program.metrics)) {
      const std::optional<std::uint32_t> body = claimed_body(t.text(metric.name));
      if (!body || !can_be_meant(*body) ||
          metric.type != static_cast<std::uint32_t>(MetricType::kBool))
        return fail(Rule::kClaimProgram, &claim.program,
                    fmt::format("`{}` is no truth of an object of task `{}`", t.text(metric.name),
                                t.text(task.name)));
      is_told = is_told || *body == claim.body;
    }
    if (!is_told)
      return fail(Rule::kClaimProgram, &claim.program,
                  fmt::format("it does not say whether body {} is denoted", claim.body));
    return {};
  }
};

}  // namespace

Status verify_claims(std::span<const std::byte> bytes, const Tables& tables) {
  return ClaimCheck(bytes, tables).run();
}

}  // namespace probe::plan
