#include "runtime/report/contrast.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/stats/design.h"
#include "runtime/stats/multiplicity.h"

namespace probe::report {
namespace {

Answer answer_of(stats::Finding&& answered) {
  Answer answer;
  answer.interval = answered.interval;
  answer.p = answered.p;
  answer.nets = std::move(answered.nets);
  return answer;
}

}  // namespace

void count_pair(stats::PairTable& table, bool a, bool b) {
  ++(a ? (b ? table.both : table.only_a) : (b ? table.only_b : table.neither));
}

stats::PairTable& PairRows::at(int task, std::uint32_t place, int group, bool fresh) {
  if (fresh) {
    rows_.push_back({{}, tasks_(task), 0, places_(place)});
    groups_.push_back(group);
  }
  return rows_.back().pairs;
}

Contrast PairRows::contrast() const {
  Contrast contrast;
  for (const stats::PlacedPairs& row : rows_) contrast.pairs = contrast.pairs + row.pairs;
  const stats::PairTable& all = contrast.pairs;
  contrast.first = {all.both + all.only_a, all.pairs()};
  contrast.second = {all.both + all.only_b, all.pairs()};
  contrast.starts = static_cast<std::int64_t>(rows_.size());
  stats::HereAndAnew answers = stats::compare_here_and_anew(by_place());
  contrast.difference = answers.difference;
  contrast.here = answer_of(std::move(answers.here));
  contrast.anew = answer_of(std::move(answers.anew));
  return contrast;
}

std::vector<stats::PlacedPairs> PairRows::by_place() const {
  std::map<std::pair<std::uint32_t, int>, std::uint32_t> starts;
  for (std::size_t i = 0; i < rows_.size(); ++i) starts[{rows_[i].place, groups_[i]}] = 0;
  std::uint32_t next = 0;
  for (auto& [key, id] : starts) id = next++;
  std::vector<stats::PlacedPairs> rows = rows_;
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].start = starts[{rows[i].place, groups_[i]}];
  return rows;
}

UnitDesign unit_design(const Contrast& contrast, const Answer& answer) {
  UnitDesign design;
  design.units = static_cast<std::int64_t>(answer.nets.size());
  if (design.units == 0) return design;
  double squares = 0;
  for (const std::int64_t net : answer.nets) {
    design.differ += net == 0 ? 0 : 1;
    squares += static_cast<double>(net * net);
  }
  const double units = static_cast<double>(design.units);
  const double differ = static_cast<double>(design.differ);
  // A share of 0 is what was seen, not what can be: half a unit.
  design.discordance = std::max(differ, 0.5) / units;
  // Units of unlike sums are worth less than their number: the root of the mean square, not the
  // mean, is what the variance of the flipped total holds.
  const double per_unit = design.differ == 0 ? 1 : std::sqrt(squares / differ);
  design.episodes = per_unit * units / static_cast<double>(contrast.pairs.pairs());
  return design;
}

void say_what_would_tell(Contrast& contrast) {
  for (Answer* const answer : {&contrast.here, &contrast.anew}) {
    const UnitDesign design = unit_design(contrast, *answer);
    if (answer->is_real() || design.units == 0) continue;
    if (const auto share = stats::minimum_detectable_difference(
            {.pairs = design.units, .discordance = design.discordance}))
      answer->detectable = std::min(1.0, *share * design.episodes);
    if (design.differ == 0) continue;
    // Adjusted, the first of a family is held to that part of the level.
    const auto needed =
        stats::pairs_needed(std::abs(contrast.difference) / design.episodes, design.discordance,
                            kAlpha / static_cast<double>(answer->family));
    if (needed && *needed > design.units) answer->more = *needed - design.units;
  }
}

void adjust(std::span<Contrast* const> family, Adjustment method) {
  for (Answer Contrast::*const question : {&Contrast::here, &Contrast::anew}) {
    std::vector<double> p;
    for (const Contrast* c : family) p.push_back((c->*question).p);
    const auto adjusted =
        method == Adjustment::kHolm ? stats::holm(p) : stats::benjamini_hochberg(p);
    for (std::size_t i = 0; i < family.size(); ++i) {
      (family[i]->*question).adjusted = adjusted[i];
      (family[i]->*question).family = static_cast<std::int64_t>(family.size());
    }
  }
}

}  // namespace probe::report
