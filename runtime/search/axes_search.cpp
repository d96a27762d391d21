// Which axes matter, and which two matter together.
#include <fmt/format.h>

#include <cmath>

#include "runtime/search/hunt.h"
#include "runtime/search/method/axes.h"
#include "runtime/search/scale.h"

namespace probe::search {
namespace {

// "light.ambient below 0.11", "words drop_on".
std::string text_of(const sema::Space& space, std::size_t axis, const Side& side) {
  const sema::SpaceAxis& of = space.axes[axis];
  Point point = point_of(space, space::own_values(space));
  point[axis] = side.value;
  const std::string value = space::value_text(of, values_of(space, point)[axis]);
  switch (side.kind) {
    case SideKind::kBelow:
      return of.name + " below " + value;
    case SideKind::kAtLeast:
      return of.name + " from " + value + " on";
    case SideKind::kIs:
      return of.name + " " + value;
    case SideKind::kIsNot:
      break;
  }
  return value == "as the task" ? "other " + of.name + " than the task's"
                                : of.name + " other than " + value;
}

// Trials to ask for so that `least` count, where as many are left out as here.
int budget_for(const AxesFinding& found, int least) {
  const double asked = static_cast<double>(found.failures.n) + found.left_out;
  return static_cast<int>(std::ceil(1.2 * least * asked / static_cast<double>(found.failures.n)));
}

}  // namespace

Status search_axes(Hunt& hunt) {
  const sema::Space& space = hunt.space();
  AxesOptions options;
  options.seed = hunt.options.seed;
  if (hunt.options.budget) options.points = *hunt.options.budget;
  const Space of_method = method_space(space);
  const int least = Axes::least_trials(of_method);
  if (options.points < least)
    return Failure{
        Fault::kUsage,
        fmt::format("`axes` takes {} trials at least: five to each part of an axis", least),
        "--budget"};
  Axes axes(of_method, options);
  PROBE_TRY(hunt.try_points({[&] { return axes.done(); }, [&] { return axes.ask(); },
                             [&](std::span<const Outcome> told) { axes.tell(told); }},
                            "axes"));
  hunt.tell("the figures are worked out");
  const AxesFinding found = axes.finding();
  SearchSummary& summary = hunt.summary;
  summary.lines.push_back(
      fmt::format("{} of points drawn over the whole space fail", k_of_n(found.failures)));
  if (found.left_out > 0)
    summary.lines.push_back(
        fmt::format("{} more were left out, so what is said is of the part of the space that {} "
                    "(points.csv has why)",
                    found.left_out, hunt.fair_words()));
  const bool are_alike = found.failures.k == 0 || found.failures.k == found.failures.n;
  if (are_alike || found.too_few) {
    summary.lines.push_back(
        found.failures.n == 0 ? fmt::format("no point that was drawn {}", hunt.fair_words())
        : found.too_few
            ? fmt::format("{} trials count, which is too few to compare parts of axes: {} have to; "
                          "a search in another folder with --budget {} may have them",
                          found.failures.n, least, budget_for(found, least))
            : "all that were tried end alike, so there is nothing to compare");
    summary.findings["failures"] = json_of(found.failures);
    summary.findings["effects"] = Json::array();
    summary.findings["pairs"] = Json::array();
    return {};
  }
  Json effects = Json::array(), pairs = Json::array();
  for (std::size_t i = 0; i < found.axes.size(); ++i) {
    const AxisEffect& one = found.axes[i];
    std::string line = space.axes[i].name + ": ";
    line += one.matters
                ? fmt::format("matters; {} it fails {}, elsewhere {}", text_of(space, i, one.side),
                              k_of_n(one.there), k_of_n(one.elsewhere))
                : "no effect that these trials would show";
    line += fmt::format(
        " (explains {:.0f} %, {:.0f} to {:.0f}; with its pairs at least {:.0f} %; p = {:.2g})",
        100 * one.first, 100 * one.first_interval.low, 100 * one.first_interval.high,
        100 * one.total, one.p);
    summary.lines.push_back(line);
    effects.push_back({{"axis", space.axes[i].name},
                       {"matters", one.matters},
                       {"p", one.p},
                       {"side", text_of(space, i, one.side)},
                       {"failures_there", json_of(one.there)},
                       {"failures_elsewhere", json_of(one.elsewhere)},
                       {"first", one.first},
                       {"first_interval", json_of(one.first_interval)},
                       {"total", one.total},
                       {"total_interval", json_of(one.total_interval)},
                       {"sentence", line}});
  }
  for (const PairEffect& one : found.pairs) {
    std::string line;
    if (one.named) {
      line = fmt::format(
          "{} and {} {}: {} and {} fail {}, one of the two alone {} and {}, neither {} (p = "
          "{:.2g})",
          space.axes[one.a].name, space.axes[one.b].name,
          one.synergy ? "work together" : "undo one another", text_of(space, one.a, one.side_a),
          text_of(space, one.b, one.side_b), k_of_n(one.both), k_of_n(one.only_a),
          k_of_n(one.only_b), k_of_n(one.neither), one.p);
      summary.lines.push_back(line);
    }
    pairs.push_back({{"a", space.axes[one.a].name},
                     {"b", space.axes[one.b].name},
                     {"named", one.named},
                     {"tested", one.tested},
                     {"synergy", one.synergy},
                     {"p", one.p},
                     {"share", one.share ? Json(*one.share) : Json(nullptr)},
                     {"side_a", text_of(space, one.a, one.side_a)},
                     {"side_b", text_of(space, one.b, one.side_b)},
                     {"both", json_of(one.both)},
                     {"only_a", json_of(one.only_a)},
                     {"only_b", json_of(one.only_b)},
                     {"neither", json_of(one.neither)},
                     {"sentence", line}});
  }
  summary.findings["failures"] = json_of(found.failures);
  summary.findings["effects"] = std::move(effects);
  summary.findings["pairs"] = std::move(pairs);
  return {};
}

}  // namespace probe::search
