#include "runtime/inspect/claims_json.h"

#include <algorithm>
#include <string>

#include "runtime/plan/claims.h"

namespace probe::inspect {

void add_claims(const plan::Plan& plan, std::uint32_t task, Json& json) {
  const auto bodies = plan.bodies(plan.tasks()[task]);
  for (const plan::ClaimRecord& claim : plan::claims_of(plan.tables(), task)) {
    Json among = Json::array();
    for (const plan::MetricRecord& metric : plan.metrics(plan.programs()[claim.program])) {
      const auto body = plan::claimed_body(plan.text(metric.name));
      if (body && *body != claim.body) among.push_back(plan.text(bodies[*body].name));
    }
    json["claims"].push_back({{"text", plan.text(claim.text)},
                              {"object", plan.text(bodies[claim.body].name)},
                              {"among", std::move(among)}});
  }
}

Json claims_text(const Json& claims) {
  Json lines = Json::array();
  for (const Json& claim : claims) {
    std::string line = "\"" + claim["text"].get<std::string>() + "\"";
    // What was put somewhere: there is no other that it could be.
    const std::string object = claim["object"].get<std::string>();
    if (!claim["text"].get<std::string>().starts_with(object + " ")) line += " is " + object;
    const char* between = ", not ";
    for (const Json& other : claim["among"]) {
      line += between + other.get<std::string>();
      between = " or ";
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

bool same_claims(const plan::Plan& a, std::uint32_t ours, const plan::Plan& b,
                 std::uint32_t theirs) {
  return std::ranges::equal(plan::claims_of(a.tables(), ours), plan::claims_of(b.tables(), theirs),
                            [&](const plan::ClaimRecord& p, const plan::ClaimRecord& q) {
                              return p.body == q.body && a.text(p.text) == b.text(q.text) &&
                                     a.programs()[p.program].hash == b.programs()[q.program].hash;
                            });
}

}  // namespace probe::inspect
