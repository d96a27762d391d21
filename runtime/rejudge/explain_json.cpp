#include "runtime/rejudge/explain_json.h"

namespace probe::rejudge {

Json to_json(const EpisodeWhy& why) {
  Json json = {
      {"task", why.task}, {"episode", why.episode}, {"seed", why.seed}, {"steps", why.steps}};
  json["invalid"] = why.invalid ? Json(*why.invalid) : nullptr;
  json["remark"] = why.remark ? Json(*why.remark) : nullptr;
  for (const ClaimWhy& claim : why.claims) {
    json["claims"].push_back({{"text", claim.text},
                              {"object", claim.object},
                              {"denoted", claim.denoted},
                              {"holds", claim.holds}});
  }
  json["metrics"] = Json::array();
  for (const MetricWhy& metric : why.metrics) {
    Json entry = {{"metric", metric.name},     {"value", metric.value}, {"shown", metric.shown},
                  {"readout", metric.readout}, {"step", metric.step},   {"when", metric.when},
                  {"file", metric.file},       {"line", metric.line}};
    if (metric.is_bool) entry["value"] = metric.value != 0;
    entry["conditions"] = Json::array();
    for (const Condition& c : metric.conditions) {
      entry["conditions"].push_back({{"file", c.file},
                                     {"line", c.line},
                                     {"text", c.text},
                                     {"bodies", c.bodies},
                                     {"measured", c.measured},
                                     {"truth", c.is_number ? Json(nullptr) : Json(c.truth)},
                                     {"decides", c.decides},
                                     {"alike", c.alike}});
    }
    json["metrics"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace probe::rejudge
