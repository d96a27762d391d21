#include "runtime/report/asked_tables.h"

#include <algorithm>
#include <map>
#include <utility>

namespace probe::report {
namespace {

std::optional<RateCell> counted(const ask::Rate& rate) {
  if (rate.count.n == 0) return std::nullopt;
  return RateCell{rate.count.rate(), Estimate{rate.count, rate.interval}};
}

std::optional<RateCell> rate_cell(const ask::ScoreRow& score, const RateKind& kind) {
  if (kind.is_computed) {
    if (!score.floors.random_circular) return std::nullopt;
    return RateCell{*score.floors.random_circular};
  }
  const ask::Arm arm = kind.name == "blind"   ? ask::Arm::kBlind
                       : kind.name == "prior" ? ask::Arm::kPrior
                                              : ask::Arm::kPicture;
  const auto& of_arm = score.of(arm);
  if (!of_arm) return std::nullopt;
  if (kind.name == "letters")
    return of_arm->likely_circular ? counted(*of_arm->likely_circular) : std::nullopt;
  return counted(kind.name == "plain" ? of_arm->plain : of_arm->circular);
}

std::vector<RateRow> rates_of(const Benchmark& benchmark, const Knowledge& knowledge) {
  const FamilyNames names(benchmark);
  std::map<std::pair<int, std::uint32_t>, std::vector<const AccuracyRow*>> families;
  for (const AccuracyRow& row : knowledge.accuracy)
    families[{row.model, row.family}].push_back(&row);
  std::vector<RateRow> rates;
  for (const auto& [key, rows] : families) {
    for (const RateKind& kind : kRateKinds) {
      RateRow rate{key.first, names.of(key.first, key.second), &kind, {}};
      rate.cells.resize(benchmark.categories.size() + 1);
      for (const AccuracyRow* row : rows)
        rate.cells[static_cast<std::size_t>(row->category + 1)] = rate_cell(*row->score, kind);
      const auto is_known = [](const auto& cell) { return cell.has_value(); };
      if (std::ranges::any_of(rate.cells, is_known)) rates.push_back(std::move(rate));
    }
  }
  return rates;
}

}  // namespace

std::optional<AskedTables> make_asked_tables(const Benchmark& benchmark) {
  if (benchmark.models.empty()) return std::nullopt;
  AskedTables asked{models_as_policies(benchmark), {}, make_knowledge(benchmark), {}};
  asked.tables = make_tables(asked.benchmark);
  asked.rates = rates_of(benchmark, asked.knowledge);
  return asked;
}

}  // namespace probe::report
