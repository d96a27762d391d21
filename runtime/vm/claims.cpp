#include "runtime/vm/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/plan/claims.h"
#include "runtime/vm/judge.h"

namespace probe::vm {
namespace {

// Centimetres to a tenth, without a negative zero.
double tenth_of_cm(double metres) { return std::nearbyint(metres * 1000) / 10 + 0.0; }

std::string name_of(const plan::Plan& plan, std::uint32_t task, std::uint32_t body) {
  return "`" + std::string(plan.text(plan.bodies(plan.tasks()[task])[body].name)) + "`";
}

// "it denotes `pepsi_can`, not `coke_can`: `coke_can` at (1.2cm, 3cm), ...".
std::string what_is_so(const plan::Plan& plan, std::uint32_t task, const ClaimVerdict& claim,
                       const StepSample& settled) {
  std::string denoted;
  bool is_meant = false;
  for (const std::uint32_t body : claim.denoted) {
    denoted += (denoted.empty() ? "" : " and ") + name_of(plan, task, body);
    is_meant = is_meant || body == claim.body;
  }
  // What a layout put somewhere is called by its own name: "carrot in cabinet.inside_top".
  const std::string_view own = plan.text(plan.bodies(plan.tasks()[task])[claim.body].name);
  std::string text = claim.text.starts_with(std::string(own) + " ") && denoted.empty()
                         ? std::string("it has moved")
                         : "it denotes " + (denoted.empty() ? "nothing" : denoted);
  if (!is_meant && !denoted.empty()) text += ", not " + name_of(plan, task, claim.body);
  std::vector<std::uint32_t> shown = claim.denoted;
  if (!is_meant) shown.insert(shown.begin(), claim.body);
  const char* between = ": ";
  for (const std::uint32_t body : shown) {
    const Vec3& at = settled.bodies[body].position;
    text += fmt::format("{}{} at ({}cm, {}cm)", between, name_of(plan, task, body),
                        tenth_of_cm(at.x()), tenth_of_cm(at.y()));
    between = ", ";
  }
  return text;
}

}  // namespace

Result<std::vector<ClaimVerdict>> judge_claims(const plan::Plan& plan, std::uint32_t task,
                                               std::span<const BodyStart> starts,
                                               const StepSample& settled) {
  std::vector<ClaimVerdict> verdicts;
  for (const plan::ClaimRecord& claim : plan::claims_of(plan.tables(), task)) {
    Judge judge(plan, task, claim.program);
    PROBE_TRY(judge.begin(starts));
    PROBE_TRY(judge.step(settled));
    ClaimVerdict verdict{plan.text(claim.text), claim.body, {}, false};
    for (std::uint32_t i = 0; i < judge.metric_count(); ++i) {
      const auto body = plan::claimed_body(judge.metric_name(i));
      if (body && judge.truth(i)) verdict.denoted.push_back(*body);
    }
    std::ranges::sort(verdict.denoted);
    verdict.holds = verdict.denoted == std::vector<std::uint32_t>{claim.body};
    verdicts.push_back(std::move(verdict));
  }
  return verdicts;
}

Status check_claims(const plan::Plan& plan, std::uint32_t task, std::span<const BodyStart> starts,
                    const StepSample& settled) {
  PROBE_ASSIGN(const auto verdicts, judge_claims(plan, task, starts, settled));
  for (const ClaimVerdict& claim : verdicts) {
    if (claim.holds) continue;
    return Failure{Fault::kWorld,
                   "\"" + std::string(claim.text) + "\" does not hold in the settled start: " +
                       what_is_so(plan, task, claim, settled),
                   ""};
  }
  return {};
}

}  // namespace probe::vm
