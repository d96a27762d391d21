// All tables as JSON, with names in place of indices.
#include "runtime/base/json.h"
#include "runtime/base/percent.h"
#include "runtime/report/categories.h"
#include "runtime/report/page_data.h"
#include "runtime/report/table_parts.h"

namespace probe::report {
namespace {

Json estimate_json(const std::optional<Estimate>& e) {
  if (!e) return nullptr;
  return {{"k", e->count.k},
          {"n", e->count.n},
          {"percent", rounded(100 * e->rate())},
          {"low", rounded(100 * e->interval.low)},
          {"high", rounded(100 * e->interval.high)}};
}

// As in the page's document, keys without a question's name are older than the two questions: the
// interval is of starts never tried, p of `tested`.
Json contrast_json(const Contrast& c, const Answer& tested) {
  Json json = {{"k", c.first.k},
               {"n", c.first.n},
               {"against_k", c.second.k},
               {"against_n", c.second.n},
               {"starts", c.starts},
               {"points", rounded(100 * c.difference)},
               {"low", rounded(100 * c.anew.interval.low)},
               {"high", rounded(100 * c.anew.interval.high)},
               {"paired", c.paired},
               {"p", tested.p},
               {"p_adjusted", tested.adjusted}};
  if (c.paired) {
    json["pairs"] = {{"both", c.pairs.both},
                     {"only_first", c.pairs.only_a},
                     {"only_second", c.pairs.only_b},
                     {"neither", c.pairs.neither}};
  }
  put_answers(json, c, 100);
  return json;
}

Json rates_json(const Benchmark& benchmark, const std::vector<std::string>& names,
                const AskedTables& asked) {
  Json rates = Json::array();
  for (const RateRow& row : asked.rates) {
    Json columns = Json::object();
    for (std::size_t c = 0; c < row.cells.size(); ++c) {
      const auto& cell = row.cells[c];
      columns[names[c]] = !cell           ? Json()
                          : cell->counted ? estimate_json(cell->counted)
                                          : Json({{"percent", rounded(100 * cell->share)}});
    }
    rates.push_back({{"policy", benchmark.models[static_cast<std::size_t>(row.model)].label},
                     {"metric", row.question},
                     {"rate", row.kind->name},
                     {"columns", std::move(columns)}});
  }
  return rates;
}

Json tables_as_json(const Benchmark& benchmark, const Tables& tables,
                    const std::vector<PublishedTable>& published, const AskedTables* asked) {
  const std::vector<std::string> names = column_names(benchmark);
  Json json = {{"interval", interval_text(benchmark)}};
  json["main"] = Json::array();
  for (const MainRow& row : tables.main) {
    Json columns = Json::object();
    const auto cells = cells_of(row);
    for (std::size_t c = 0; c < cells.size(); ++c) columns[names[c]] = estimate_json(cells[c]);
    json["main"].push_back({{"policy", policy_label(benchmark, row.policy)},
                            {"metric", metric_name(benchmark, row.metric)},
                            {"columns", std::move(columns)}});
  }
  json["category_differences"] = Json::array();
  for (const CategoryDeltaRow& row : tables.category_deltas) {
    Json one = {{"policy", policy_label(benchmark, row.policy)},
                {"metric", metric_name(benchmark, row.metric)},
                {"category", benchmark.categories[static_cast<std::size_t>(row.category)].name}};
    one.update(contrast_json(row.contrast, row.contrast.here));
    one["tasks_left_out"] = row.left_out;
    json["category_differences"].push_back(std::move(one));
  }
  json["task_differences"] = Json::array();
  for (const DeltaRow& row : tables.deltas) {
    const Task& task = benchmark.tasks[static_cast<std::size_t>(row.task)];
    Json one = {{"policy", policy_label(benchmark, row.policy)},
                {"metric", metric_name(benchmark, row.metric)},
                {"task", task.name},
                {"baseline", benchmark.tasks[static_cast<std::size_t>(task.baseline)].name},
                {"axes", task.axis_names}};
    one.update(contrast_json(row.contrast, row.contrast.anew));
    if (!task.confounded.empty()) one["confounded"] = task.confounded;
    if (!task.unpaired.empty()) one["unpaired"] = task.unpaired;
    json["task_differences"].push_back(std::move(one));
  }
  json["policies"] = Json::array();
  for (const PolicyRow& row : tables.policies) {
    Json one = {{"a", policy_label(benchmark, row.a)},
                {"b", policy_label(benchmark, row.b)},
                {"metric", metric_name(benchmark, row.metric)},
                {"category", category_name(benchmark, row.category)}};
    one.update(contrast_json(row.contrast, row.contrast.anew));
    json["policies"].push_back(std::move(one));
  }
  if (!published.empty()) json["published"] = external_json(benchmark, published);
  if (asked != nullptr) {
    json["models"] = tables_as_json(asked->benchmark, asked->tables, {}, nullptr);
    for (const char* of_all : {"interval", "notes"}) json["models"].erase(of_all);
    json["models"]["rates"] = rates_json(benchmark, names, *asked);
    json["knows"] = Json::array();
    for (const KnowsRow& row : asked->knowledge.knows) {
      Json one = {{"model", benchmark.models[static_cast<std::size_t>(row.model)].label},
                  {"policy", policy_label(benchmark, row.policy)},
                  {"questions", question_name(benchmark, row)},
                  {"category", category_name(benchmark, row.category)},
                  {"episodes", row.episodes()},
                  {"knows_goes_does", row.counts[7]},
                  {"knows_goes_fails", row.counts[6]},
                  {"knows_goes_elsewhere", row.with(true, false)},
                  {"goes_without_knowing", row.with(false, true)},
                  {"neither", row.with(false, false)},
                  {"says", knows_sentence(benchmark, row)}};
      one.update(contrast_json(row.contrast, row.contrast.anew));
      json["knows"].push_back(std::move(one));
    }
  }
  json["notes"] = Json::array();
  for (const Note& note : benchmark.notes) json["notes"].push_back(note.text);
  return json;
}

}  // namespace

std::string tables_json(const TablesToPrint& print) {
  return tables_as_json(print.benchmark, print.tables, print.published, print.asked).dump(1) + "\n";
}

}  // namespace probe::report
