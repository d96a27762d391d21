#include "runtime/ask/score_json.h"

#include "runtime/plan/family_name.h"

namespace probe::ask {
namespace {

Json rate_json(const Rate& rate) {
  const bool has_any = rate.count.n > 0;
  return {{"right", rate.count.k},
          {"asked", rate.count.n},
          {"low", has_any ? Json(rate.interval.low) : Json()},
          {"high", has_any ? Json(rate.interval.high) : Json()}};
}

template <typename T, typename To>
Json or_null(const std::optional<T>& value, To to) {
  return value ? Json(to(*value)) : Json();
}

}  // namespace

Json arms_json(const plan::Plan& plan, const ScoreRow& row) {
  const auto number = [](double value) { return value; };
  Json arms = Json::array();
  for (const Arm arm : {Arm::kPicture, Arm::kBlind, Arm::kPrior}) {
    const std::optional<ArmScore>& score = row.of(arm);
    if (!score) continue;
    arms.push_back({{"question", plan::family_name(plan, plan.families()[row.family])},
                    {"arm", word_of(arm)},
                    {"right_in_every_order", rate_json(score->circular)},
                    {"right_in_one_order", rate_json(score->plain)},
                    {"likeliest_in_every_order", or_null(score->likely_circular, rate_json)},
                    {"likeliest_in_one_order", or_null(score->likely_plain, rate_json)},
                    {"luck_in_every_order", or_null(row.floors.random_circular, number)},
                    {"luck_in_one_order", or_null(row.floors.random_plain, number)},
                    {"rows", score->rows},
                    {"unclear", score->unclear},
                    {"cut", score->cut},
                    {"refused", score->refused},
                    {"empty", score->empty},
                    {"invalid", score->invalid},
                    {"incomplete", score->incomplete}});
  }
  return arms;
}

}  // namespace probe::ask
