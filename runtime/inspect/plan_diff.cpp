#include "runtime/inspect/plan_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <unordered_map>

#include "runtime/inspect/claims_json.h"
#include "runtime/inspect/later_json.h"
#include "runtime/inspect/question_json.h"
#include "runtime/inspect/skills_json.h"

namespace probe::inspect {
namespace {

struct Changes {
  bool prompt = false, judge = false, claims = false, solution = false;  // equal
  std::size_t starts = 0, episodes = 0, of_a = 0, of_b = 0;

  bool none() const { return of_a == of_b && episodes == of_a && starts == of_a; }
};

Changes compare(const plan::Plan& a, std::uint32_t our_task, const plan::Plan& b,
                std::uint32_t their_task) {
  const plan::TaskRecord &ours = a.tasks()[our_task], &theirs = b.tasks()[their_task];
  Changes found;
  found.claims = same_claims(a, our_task, b, their_task);
  found.solution = same_solution(a, our_task, b, their_task);
  found.prompt = same_prompt(a, our_task, b, their_task);
  found.judge = ours.judge_id == theirs.judge_id;
  const auto here = a.episodes(ours);
  const auto there = b.episodes(theirs);
  found.of_a = here.size();
  found.of_b = there.size();
  for (std::size_t e = 0; e < std::min(here.size(), there.size()); ++e) {
    found.starts += here[e].start_id == there[e].start_id ? 1 : 0;
    found.episodes += here[e].episode_id == there[e].episode_id ? 1 : 0;
  }
  return found;
}

}  // namespace

Json diff_plans(const plan::Plan& a, const plan::Plan& b) {
  std::unordered_map<std::string_view, std::uint32_t> by_name;
  for (std::uint32_t t = 0; t < b.tasks().size(); ++t) by_name[b.text(b.tasks()[t].name)] = t;
  Json only_a = Json::array(), only_b = Json::array(), changed = Json::array();
  std::size_t equal = 0;
  for (std::uint32_t t = 0; t < a.tasks().size(); ++t) {
    const plan::TaskRecord& task = a.tasks()[t];
    const auto match = by_name.find(a.text(task.name));
    if (match == by_name.end()) {
      only_a.push_back(a.text(task.name));
      continue;
    }
    const Changes found = compare(a, t, b, match->second);
    by_name.erase(match);
    if (found.none() && found.prompt && found.judge && found.claims && found.solution) {
      ++equal;
      continue;
    }
    changed.push_back({{"task", a.text(task.name)},
                       {"prompt", found.prompt},
                       {"judge", found.judge},
                       {"starts", found.starts},
                       {"episodes", found.episodes},
                       {"of_a", found.of_a},
                       {"of_b", found.of_b}});
    if (!found.claims) changed.back()["claims"] = false;
    if (!found.solution) changed.back()["solution"] = false;
  }
  for (const plan::TaskRecord& task : b.tasks()) {
    if (by_name.contains(b.text(task.name))) only_b.push_back(b.text(task.name));
  }
  return {{"a", to_hex(a.root())},
          {"b", to_hex(b.root())},
          {"only_a", std::move(only_a)},
          {"only_b", std::move(only_b)},
          {"changed", std::move(changed)},
          {"equal", equal},
          {"questions", diff_questions(a, b)}};
}

std::string plan_diff_text(const Json& diff) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const Json& task : diff["only_a"]) fmt::format_to(out, "- {}\n", task.get<std::string>());
  for (const Json& task : diff["only_b"]) fmt::format_to(out, "+ {}\n", task.get<std::string>());
  for (const Json& task : diff["changed"]) {
    const auto number = [&task](const char* key) { return task[key].get<std::size_t>(); };
    fmt::format_to(out, "* {}:", task["task"].get<std::string>());
    if (number("of_a") != number("of_b"))
      fmt::format_to(out, " {} -> {} episodes;", number("of_a"), number("of_b"));
    if (!task["prompt"].get<bool>()) text += " prompt;";
    if (!task["judge"].get<bool>()) text += " judge;";
    if (task.contains("claims")) text += " what its words say of places;";
    if (task.contains("solution")) text += " solution;";
    const std::size_t of = std::max(number("of_a"), number("of_b"));
    if (number("starts") != of) fmt::format_to(out, " {} of {} starts;", of - number("starts"), of);
    fmt::format_to(out, " {} of {} episodes are others\n", of - number("episodes"), of);
  }
  fmt::format_to(out, "{} only in the first, {} only in the second, {} changed, {} equal\n",
                 diff["only_a"].size(), diff["only_b"].size(), diff["changed"].size(),
                 diff["equal"].get<std::size_t>());
  return text + question_diff_text(diff["questions"]);
}

}  // namespace probe::inspect
