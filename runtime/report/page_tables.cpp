// The `tables` of the page's document.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <unordered_map>

#include "runtime/base/file.h"
#include "runtime/report/categories.h"
#include "runtime/report/models.h"
#include "runtime/report/page_data.h"
#include "runtime/report/published_match.h"

namespace probe::report {
namespace {

double p_value(double p) { return p < 1e-4 ? p : rounded(p); }

Json pair_json(const Contrast& c) {
  if (!c.paired) return nullptr;
  return {c.pairs.both, c.pairs.only_a, c.pairs.only_b, c.pairs.neither};
}

// Keys without a question's name are older than the two questions: the interval is of starts never
// tried, p and q are of `tested`.
void put(Json& json, const Contrast& c, const Answer& tested, const char* adjusted = "q") {
  json["pairs"] = pair_json(c);
  json["first"] = {c.first.k, c.first.n};
  json["second"] = {c.second.k, c.second.n};
  json["starts"] = c.starts;
  json["diff"] = rounded(c.difference);
  json["low"] = rounded(c.anew.interval.low);
  json["high"] = rounded(c.anew.interval.high);
  json["p"] = p_value(tested.p);
  if (adjusted != nullptr) json[adjusted] = p_value(tested.adjusted);
  put_answers(json, c, 1, adjusted != nullptr);
}

Json main_json(const Tables& tables) {
  Json rows = Json::array();
  for (const MainRow& row : tables.main) {
    Json cells = Json::array();
    for (const auto& cell : row.cells) cells.push_back(to_json(cell));
    rows.push_back({{"policy", row.policy},
                    {"metric", row.metric},
                    {"all", to_json(row.all)},
                    {"cells", std::move(cells)}});
  }
  return {{"rows", std::move(rows)}, {"all_label", "all tasks"}};
}

Json by_task_json(const Benchmark& benchmark, const Tables& tables) {
  Json json = Json::object();
  for (std::size_t m = 0; m < tables.by_task.size(); ++m) {
    if (tables.by_task[m].empty()) continue;
    Json policies = Json::array();
    for (const auto& policy : tables.by_task[m]) {
      Json tasks = Json::array();
      for (const auto& task : policy) tasks.push_back(to_json(task));
      policies.push_back(std::move(tasks));
    }
    json[benchmark.metrics[m].name] = std::move(policies);
  }
  return json;
}

// Categories of other words: variants beside their own baselines.
Json language_json(const Benchmark& benchmark, const Tables& tables) {
  Json rows = Json::array();
  for (const CategoryDeltaRow& row : tables.category_deltas) {
    if (!is_worded(benchmark, row.category)) continue;
    Json json = {{"policy", row.policy}, {"metric", row.metric}, {"category", row.category}};
    put(json, row.contrast, row.contrast.here);
    rows.push_back(std::move(json));
  }
  return rows;
}

Json compare_json(const Benchmark& benchmark, const Tables& tables) {
  Json rows = Json::array();
  for (const PolicyRow& row : tables.policies) {
    Json json = {{"a", row.a}, {"b", row.b}, {"metric", row.metric}};
    json["scope"] = row.category == kAbsent
                        ? std::string("all")
                        : benchmark.categories[static_cast<std::size_t>(row.category)].label;
    json["category"] = row.category;
    put(json, row.contrast, row.contrast.anew);
    json["real"] = row.contrast.anew.is_real();
    if (row.contrast.anew.detectable) json["detectable"] = rounded(*row.contrast.anew.detectable);
    rows.push_back(std::move(json));
  }
  return rows;
}

Json looked_json(const Looked& looked) {
  return {{"units", looked.units},   {"used", looked.used},    {"a_wins", looked.a_wins},
          {"b_wins", looked.b_wins}, {"p", p_value(looked.p)}, {"stopped", looked.stopped}};
}

Json delivery_json(const Benchmark& benchmark) {
  Json rows = Json::array();
  for (std::size_t p = 0; p < benchmark.policies.size(); ++p) {
    std::size_t sent = 0, own = 0;
    std::string first;
    for (const Episode& e : benchmark.episodes) {
      if (e.policy != static_cast<int>(p) || !e.is_prompted) continue;
      ++sent;
      const Task& task = benchmark.tasks[static_cast<std::size_t>(e.task)];
      const bool same = e.prompt != kAbsent &&
                        benchmark.prompts[static_cast<std::size_t>(e.prompt)] == task.prompt;
      own += same ? 1 : 0;
      if (!same && first.empty())
        first = fmt::format("{} start {} seed {}", task.name, e.start, e.seed);
    }
    const std::string& label = benchmark.policies[p].label;
    if (sent > 0 && own == sent) {
      rows.push_back({{"level", "good"},
                      {"policy", p},
                      {"text", fmt::format("{}: the hash of the instruction it was given is its "
                                           "task's in all {} episodes",
                                           label, sent)}});
    } else if (sent > 0) {
      rows.push_back({{"level", "bad"},
                      {"policy", p},
                      {"text", fmt::format("{}: in {} of {} episodes the instruction that was sent "
                                           "is not the task's, first in {}",
                                           label, sent - own, sent, first)}});
    }
  }
  for (std::size_t p = 0; p < benchmark.policies.size(); ++p) {
    const Policy& policy = benchmark.policies[p];
    for (const RunInfo& run : policy.runs) {
      // Which profile asked: of some policies there is one as published and one as meant.
      if (run.content.find(" profile ") != std::string::npos) {
        rows.push_back({{"level", "good"},
                        {"policy", p},
                        {"text", fmt::format("{}: asked by {}", policy.label, run.content)}});
      }
      if (!run.live.empty()) {
        rows.push_back({{"level", "warn"},
                        {"policy", p},
                        {"text", fmt::format("{}: {}", policy.label, run.live)}});
      }
      for (const std::string& text : run.reading.batches) {
        rows.push_back({{"level", "good"},
                        {"policy", p},
                        {"text", fmt::format("{}: {}", policy.label, text)}});
      }
      const bool is_good = run.reading.findings.empty();
      if (is_good && run.reading.good.empty()) continue;
      for (const std::string& text :
           is_good ? std::vector{run.reading.good} : run.reading.findings) {
        rows.push_back({{"level", is_good ? "good" : "bad"},
                        {"policy", p},
                        {"text", fmt::format("{}: {}", policy.label, text)}});
      }
    }
  }
  std::unordered_map<std::int64_t, std::uint64_t> pictures;  // by task and start
  std::size_t same = 0, other = 0;
  for (const Episode& e : benchmark.episodes) {
    if (e.picture == 0) continue;
    const std::int64_t place = std::int64_t{e.task} << 32 | e.start;
    const auto [at, fresh] = pictures.try_emplace(place, e.picture);
    if (fresh) continue;
    ++(at->second == e.picture ? same : other);
  }
  if (same + other > 0) {
    rows.push_back(
        {{"level", other == 0 ? "good" : "warn"},
         {"text", other == 0 ? fmt::format("policies and seeds that share a start saw the same "
                                           "first picture, bit for bit ({} comparisons)",
                                           same)
                             : fmt::format("{} of {} episodes saw another first picture than "
                                           "the first policy on that start",
                                           other, same + other)}});
  }
  return rows;
}

Json models_json(const Benchmark& benchmark) {
  std::vector<int> metrics;
  for (const char* name : {"success", "intention"}) {
    if (const int m = benchmark.find_metric(name); m != kAbsent) metrics.push_back(m);
  }
  Json models = Json::array();
  for (const MixedModel& model : mixed_models(benchmark, metrics)) {
    Json rows = Json::array(), random = Json::array();
    for (const ModelTerm& term : model.terms) {
      rows.push_back({{"term", term.term},
                      {"kind", term.kind},
                      {"odds", rounded(term.odds)},
                      {"low", rounded(term.low)},
                      {"high", rounded(term.high)},
                      {"p", p_value(term.p)}});
    }
    for (const RandomTerm& term : model.random)
      random.push_back({{"factor", term.factor}, {"sd", rounded(term.sd)}});
    models.push_back({{"metric", model.metric},
                      {"model", model.formula},
                      {"rows", std::move(rows)},
                      {"random", std::move(random)},
                      {"n", model.rows},
                      {"note", model.note}});
  }
  return models;
}

// Many pairs of policies say little more than a ranking.
constexpr std::size_t kMostPairs = 300;

}  // namespace

PublishedSizes published_sizes(const Benchmark& benchmark) {
  PublishedSizes sizes;
  sizes.tasks.push_back(static_cast<std::int64_t>(benchmark.tasks.size()));
  for (const Category& category : benchmark.categories) {
    sizes.tasks.push_back(std::count_if(category.tasks.begin(), category.tasks.end(), [&](int t) {
      return benchmark.tasks[static_cast<std::size_t>(t)].plan == 0;
    }));
  }
  if (benchmark.plans.empty() || benchmark.plans[0].tasks == 0) return sizes;
  const PlanInfo& plan = benchmark.plans[0];
  sizes.tasks[0] = plan.tasks;
  sizes.per_task = static_cast<std::int64_t>(plan.starts) / plan.tasks * plan.seeds;
  return sizes;
}

Json external_json(const Benchmark& benchmark, const std::vector<PublishedTable>& published) {
  const auto [tasks, per_task] = published_sizes(benchmark);
  Json tables = Json::array();
  for (const PublishedTable& table : published) {
    const auto columns = matched_columns(benchmark, table);
    Json rows = Json::array();
    for (const PublishedRow& row : table.rows) {
      Json all, cells = Json::array(), n = Json::array(), flags = Json::array();
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto cell = columns[i] ? row.cells[*columns[i]] : std::nullopt;
        const Json value = cell ? Json(cell->value) : Json();
        if (i == 0) {
          all = value;
        } else {
          cells.push_back(value);
        }
        n.push_back(tasks[i] * per_task);
        const auto flag = cell ? impossible(*cell, tasks[i], per_task) : std::nullopt;
        flags.push_back(flag ? Json(*flag) : Json());
      }
      rows.push_back({{"policy", row.policy},
                      {"metric", row.metric},
                      {"all", std::move(all)},
                      {"cells", std::move(cells)},
                      {"n", std::move(n)},
                      {"flags", std::move(flags)}});
    }
    Json json = {{"source", table.source}, {"rows", std::move(rows)}};
    Json unused = Json::array();
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      if (std::find(columns.begin(), columns.end(), std::optional(c)) == columns.end())
        unused.push_back(table.columns[c]);
    }
    if (!unused.empty()) json["unused_columns"] = std::move(unused);
    tables.push_back(std::move(json));
  }
  return tables;
}

Json tables_json(const Benchmark& benchmark, const Tables& tables, const PageOptions& options) {
  Json json = {{"main", main_json(tables)}, {"by_task", by_task_json(benchmark, tables)}};
  if (!options.published.empty()) json["external"] = external_json(benchmark, options.published);
  json["deltas"] = Json::array();
  for (const DeltaRow& row : tables.deltas) {
    Json delta = {{"policy", row.policy},
                  {"task", row.task},
                  {"baseline", benchmark.tasks[static_cast<std::size_t>(row.task)].baseline},
                  {"metric", row.metric}};
    put(delta, row.contrast, row.contrast.anew);
    delta["floor"] = row.at_floor;
    json["deltas"].push_back(std::move(delta));
  }
  json["category_deltas"] = Json::array();
  for (const CategoryDeltaRow& row : tables.category_deltas) {
    Json delta = {{"policy", row.policy}, {"category", row.category}, {"metric", row.metric}};
    put(delta, row.contrast, row.contrast.here);
    delta["left_out"] = row.left_out;
    json["category_deltas"].push_back(std::move(delta));
  }
  json["language"] = language_json(benchmark, tables);
  json["pairs"] = Json::array();
  for (const ObjectPairRow& row : tables.pairs) {
    json["pairs"].push_back({{"policy", row.policy},
                             {"source", row.source},
                             {"target", row.target},
                             {"metric", row.metric},
                             {"e", to_json(row.estimate)},
                             {"ood", row.ood}});
  }
  json["objects"] = Json::array();
  for (const ObjectRow& row : tables.objects) {
    json["objects"].push_back({{"policy", row.policy},
                               {"object", row.object},
                               {"role", row.as_source ? "source" : "target"},
                               {"metric", row.metric},
                               {"e", to_json(row.estimate)},
                               {"ood", row.ood}});
  }
  json["gap"] = Json::array();
  for (const GapRow& row : tables.gap) {
    Json gap = {{"policy", row.policy},
                {"category", row.category},
                {"intention", to_json(row.intention)},
                {"success", to_json(row.success)}};
    put(gap, row.contrast, row.contrast.anew, nullptr);
    json["gap"].push_back(std::move(gap));
  }
  json["floors"] = Json::array();
  for (const FloorRow& row : tables.floors) {
    Json floor = {{"task", row.task},
                  {"metric", row.metric},
                  {"floor", to_json(row.floor)},
                  {"ceiling", to_json(row.ceiling)}};
    if (!row.note.empty()) floor["note"] = row.note;
    json["floors"].push_back(std::move(floor));
  }
  json["compare"] = compare_json(benchmark, tables);
  json["ranking"] = Json::array();
  json["sequential"] = Json::array();
  const std::size_t count = benchmark.policies.size();
  if (const int success = benchmark.find_metric("success"); success != kAbsent && count > 1) {
    for (const RankRow& row : ranking(benchmark, success)) {
      json["ranking"].push_back({{"policy", row.policy},
                                 {"metric", row.metric},
                                 {"score", rounded(row.score)},
                                 {"low", rounded(row.low)},
                                 {"high", rounded(row.high)}});
    }
    if (count * (count - 1) / 2 <= kMostPairs) {
      for (const SequentialRow& row : sequential(benchmark, success)) {
        Json one = {{"a", row.a},
                    {"b", row.b},
                    {"metric", row.metric},
                    {"places", row.anew.units},
                    {"used", row.anew.used},
                    {"a_wins", row.anew.a_wins},
                    {"b_wins", row.anew.b_wins},
                    {"p", p_value(row.anew.p)},
                    {"stopped", row.anew.stopped}};
        one[kOnTheseStarts] = looked_json(row.here);
        one[kForStartsNeverTried] = looked_json(row.anew);
        json["sequential"].push_back(std::move(one));
      }
    }
  }
  json["mixed"] = options.models ? models_json(benchmark) : Json::array();
  json["delivery"] = delivery_json(benchmark);
  json["confounded"] = Json::array();
  for (std::size_t t = 0; t < benchmark.tasks.size(); ++t) {
    const Task& task = benchmark.tasks[t];
    if (task.confounded.empty()) continue;
    json["confounded"].push_back({{"task", t},
                                  {"baseline", task.baseline},
                                  {"axes", task.axis_names},
                                  {"reason", task.confounded}});
  }
  return json;
}

Status add_floors(const std::string& path, Benchmark& benchmark, Tables& tables) {
  PROBE_ASSIGN(const std::string text, read_file(path));
  std::string_view rest = text;
  std::vector<std::string_view> names;
  std::size_t number = 0, used = 0;
  bool same_plan = true;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    ++number;
    if (line.rfind("# plan ", 0) == 0) {
      const std::string_view root = line.substr(7);
      same_plan = std::any_of(benchmark.plans.begin(), benchmark.plans.end(),
                              [&](const PlanInfo& plan) { return plan.root == root; });
      continue;
    }
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string_view> cells;
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t comma = std::min(line.find(',', begin), line.size());
      cells.push_back(line.substr(begin, comma - begin));
      begin = comma + 1;
    }
    if (names.empty()) {
      names = cells;
      if (cells.size() > 3 && cells[0] == "task" && cells[1] == "policy" && cells[2] == "episodes")
        continue;
      return Failure{Fault::kUsage, "floors begin with `task,policy,episodes,` and metrics",
                     fmt::format("{}:{}", path, number)};
    }
    const auto whole = [](std::string_view cell) {
      std::int64_t value = -1;
      const auto [at, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      return error == std::errc() && at == cell.data() + cell.size() ? value : -1;
    };
    const std::int64_t n = cells.size() == names.size() ? whole(cells[2]) : -1;
    if (n < 0) {
      return Failure{Fault::kUsage, "is no line of task, policy and counts",
                     fmt::format("{}:{}", path, number)};
    }
    const bool is_floor = cells[1] == "null", is_ceiling = cells[1] == "expert";
    const int task = benchmark.find_task(cells[0]);
    if ((!is_floor && !is_ceiling) || task == kAbsent || n == 0) continue;
    for (std::size_t i = 3; i < cells.size(); ++i) {
      const int metric = benchmark.find_metric(names[i]);
      const std::int64_t k = whole(cells[i]);
      if (metric == kAbsent || k < 0 || k > n) continue;
      auto row = std::find_if(
          tables.floors.begin(), tables.floors.end(),
          [&](const FloorRow& known) { return known.task == task && known.metric == metric; });
      if (row == tables.floors.end()) {
        tables.floors.push_back({task, metric, std::nullopt, std::nullopt, ""});
        row = tables.floors.end() - 1;
      }
      auto& side = is_floor ? row->floor : row->ceiling;
      if (side) continue;
      side = Estimate{{k, n}, stats::wilson({k, n})};
      ++used;
    }
  }
  if (used > 0 && !same_plan) {
    benchmark.notes.push_back(
        {"warn", fmt::format("floors and ceilings of `{}` were measured with another plan", path)});
  }
  return {};
}

}  // namespace probe::report
