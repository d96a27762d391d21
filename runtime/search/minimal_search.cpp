// Which changes of a failing case are needed for it to fail.
#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "runtime/search/hunt.h"
#include "runtime/search/method/minimal.h"
#include "runtime/search/scale.h"

namespace probe::search {
namespace {

Failure no_case(const std::string& message, const std::string& where) {
  return {Fault::kUsage, message, where};
}

std::string_view word_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kFails:
      return "fails";
    case Verdict::kPasses:
      return "passes";
    case Verdict::kLeftOut:
      return "left out";
    case Verdict::kUnclear:
      break;
  }
  return "unclear";
}

}  // namespace

Result<Case> case_of(const SearchOptions& options, const BaseTask& base) {
  const sema::Space& of = base.space();
  if (!options.at.empty()) {
    PROBE_ASSIGN(std::vector<double> values, read_point(of, options.at));
    values = space::seen_values(of, std::move(values));
    if (space::changed_axes(of, values).empty())
      return no_case("`" + options.at + "` changes nothing", "--at");
    return Case{std::move(values), {}};
  }
  if (options.from.empty())
    return no_case(
        "which case? --from DIR of a `search worst`, or --at \"light.power 0.3, clutter 2\"",
        "--from");
  PROBE_ASSIGN(const SearchSummary other, read_search(options.from));
  const Json* const cases = other.findings.find("cases");
  if (cases == nullptr) return no_case("it has no cases: is it a `search worst`?", options.from);
  const std::pair<const char*, Json> known[] = {
      {"task", base.task().name}, {"space", of.name}, {"text_sha256", base.hash()}};
  for (const auto& [key, value] : known) {
    const Json& asked = other.findings.at("asked").at(key);
    if (asked != value)
      return no_case("it is of another " + std::string(key) + " (" + asked.dump() + ", not " +
                         value.dump() + ")",
                     options.from);
  }
  if (options.number < 1 || static_cast<std::size_t>(options.number) > cases->size())
    return no_case(
        fmt::format("{} has {} cases, no number {}", options.from, cases->size(), options.number),
        "--case");
  return read_case(of, (*cases)[options.number - 1], options.from);
}

Status search_minimal(Hunt& hunt) {
  const sema::Space& space = hunt.space();
  const std::vector<double>& whole = hunt.whole.values;
  const std::vector<std::size_t> changed = space::changed_axes(space, whole);
  MinimalOptions options;
  options.axes = static_cast<int>(changed.size());
  if (hunt.options.budget) options.budget = *hunt.options.budget;
  Minimal minimal(options);
  const auto values_with = [&](AxisSet set) {
    std::vector<double> values = space::own_values(space);
    for (std::size_t i = 0; i < changed.size(); ++i) {
      if ((set >> i & 1) != 0) values[changed[i]] = whole[changed[i]];
    }
    return values;
  };
  // What is drawn beside a case stays as it is while axes are put back.
  const std::uint64_t draw = hunt.whole.draw.value_or(hunt.draw_of(whole));
  const auto point_with = [&](AxisSet set) {
    return space::Point{hunt.point_name(values_with(set)), values_with(set), draw, {}};
  };
  AxisSet planned_set = 0;
  std::uint64_t number = 0;
  while (!minimal.done()) {
    const AxisSet set = minimal.ask().front();
    planned_set = set;
    number = 0;
    std::vector<space::Point> points;
    if (set != 0) points.push_back(point_with(set));
    PROBE_ASSIGN(const PlannedPoints planned, hunt.plan(std::move(points)));
    hunt.tell("tried: " + space::point_text(space, values_with(set)));
    Trials::Asking asking;
    asking.ask = [&]() -> Result<std::vector<Trial>> {
      if (minimal.done() || minimal.ask().empty() || minimal.ask().front() != planned_set)
        return std::vector<Trial>{};
      std::vector<Trial> trials;
      for (std::size_t i = 0; i < minimal.ask().size(); ++i)
        trials.push_back({set == 0 ? kBase : 0, number++});
      return trials;
    };
    asking.tell = [&](std::span<const Outcome> outcomes) {
      hunt.summary.trials += static_cast<int>(outcomes.size());
      minimal.tell(outcomes);
    };
    PROBE_TRY(hunt.try_out(planned, asking, "minimal"));
  }
  const MinimalFinding& found = minimal.finding();
  const std::string smallest = space::point_text(space, values_with(found.set));
  SearchSummary& summary = hunt.summary;
  std::string line;
  switch (found.status) {
    case MinimalStatus::kFound:
      line = "the smallest change that still fails: " + smallest;
      if (found.doubtful != 0)
        line += "; of " + space::point_text(space, values_with(found.doubtful)) +
                " it is not certain that it is needed";
      hunt.kept.push_back({point_with(found.set), line});
      break;
    case MinimalStatus::kFailsAtOwnPoint:
      line = "the task fails with nothing changed";
      break;
    case MinimalStatus::kNotReliable:
      if (!found.tried.empty() && found.tried.front().failures.n == 0) {
        line = summary.invalid > 0
                   ? "the case could not be tried"
                   : "the case is not fair, so it was not tried: points.csv says why";
        break;
      }
      line = "the case does not fail reliably, so nothing can be put back: " +
             k_of_n(found.tried.empty() ? stats::Count{} : found.tried.front().failures) +
             " trials fail";
      break;
    case MinimalStatus::kBudgetSpent:
      summary.is_done = false;
      if (found.set == 0) {
        line = "the budget is spent before it is known whether the case fails reliably";
        break;
      }
      line = "the budget is spent; what still fails, and may be larger than needed: " + smallest;
      break;
    case MinimalStatus::kRunning:
      line = "under way";
      break;
  }
  summary.lines.push_back(line + fmt::format(" ({} trials; failing is a rate of {:g} or more, not "
                                             "failing one of {:g} or less)",
                                             found.trials, options.fails, options.passes));
  Json tried = Json::array();
  for (const SetTried& one : found.tried) {
    const std::string text = space::point_text(space, values_with(one.set));
    summary.lines.push_back(
        fmt::format("  {}: {} trials fail, {}", text, k_of_n(one.failures), word_of(one.verdict)));
    tried.push_back({{"changes", json_of(space, values_with(one.set))},
                     {"text", text},
                     {"failures", json_of(one.failures)},
                     {"verdict", word_of(one.verdict)}});
  }
  summary.findings["case"] = json_of(space, whole);
  if (found.status == MinimalStatus::kFound ||
      (found.status == MinimalStatus::kBudgetSpent && found.set != 0))
    summary.findings["smallest"] = json_of(space, values_with(found.set));
  summary.findings["sentence"] = line;
  summary.findings["tried"] = std::move(tried);
  return {};
}

}  // namespace probe::search
