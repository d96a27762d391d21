#include "runtime/report/page_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <set>

#include "runtime/base/digit_groups.h"
#include "runtime/base/percent.h"
#include "runtime/base/printable.h"
#include "runtime/wire/base64.h"

namespace probe::report {
namespace {

namespace fs = std::filesystem;
// "success" is drawn as "success"; a name's underscores are for programs.
std::string label_of(const std::string& name) {
  if (name == "wrong") return "wrong object";
  std::string label = name;
  std::replace(label.begin(), label.end(), '_', ' ');
  return label;
}

std::string from(const std::string& base, const std::string& path) {
  std::error_code error;
  const fs::path relative =
      fs::relative(path, base.empty() ? fs::path(".") : fs::path(base), error);
  return error || relative.empty() ? path : relative.string();
}

Json policies_json(const Benchmark& benchmark, const PageOptions& options) {
  Json policies = Json::array();
  for (const Policy& policy : benchmark.policies) {
    Json runs = Json::array();
    for (const RunInfo& run : policy.runs) {
      runs.push_back({{"dir", from(options.relative_to, run.dir)},
                      {"plan", run.plan},
                      {"fingerprint", run.fingerprint},
                      {"seeds", run.seeds},
                      {"done", run.done},
                      {"expected", run.expected},
                      {"invalid", run.invalid},
                      {"videos", run.videos}});
      if (run.not_attempted.count() > 0) runs.back()["not_attempted"] = run.not_attempted.count();
    }
    policies.push_back({{"name", policy.name},
                        {"label", policy.label},
                        {"role", to_text(policy.role)},
                        {"runs", std::move(runs)}});
  }
  return policies;
}

Json starts_json(const Task& task) {
  Json starts = Json::array();
  for (const StartPlace& start : task.starts) {
    Json bodies = Json::array();
    for (const auto& body : start.bodies)
      bodies.push_back({rounded(body[0]), rounded(body[1]), probe::rounded(body[2], 1)});
    starts.push_back(std::move(bodies));
  }
  return starts;
}

Json tasks_json(const Benchmark& benchmark) {
  std::vector<std::vector<int>> categories(benchmark.tasks.size());
  for (std::size_t c = 0; c < benchmark.categories.size(); ++c) {
    for (const int t : benchmark.categories[c].tasks)
      categories[static_cast<std::size_t>(t)].push_back(static_cast<int>(c));
  }
  Json tasks = Json::array();
  for (std::size_t t = 0; t < benchmark.tasks.size(); ++t) {
    const Task& task = benchmark.tasks[t];
    Json json = {
        {"plan", task.plan},       {"name", task.name},           {"baseline", task.baseline},
        {"axes", task.axis_names}, {"categories", categories[t]}, {"prompt", task.prompt},
        {"source", task.source},   {"target", task.target},       {"distractors", task.distractors},
        {"ood", task.ood},         {"horizon", task.horizon},     {"hz", task.hz},
        {"scene", task.scene},     {"metrics", task.metrics},     {"starts", starts_json(task)}};
    for (const Task::NamedRole& role : task.roles)
      json["roles"].push_back({{"name", role.name}, {"objects", role.objects}});
    if (!task.later.empty()) json["then"] = task.later;
    if (!task.confounded.empty()) json["confounded"] = task.confounded;
    if (!task.allowed.empty()) {
      json["allowed"] = Json::array();
      json["allowed"].push_back({{"word", "confounded"}, {"reason", task.allowed}});
    }
    if (!task.unpaired.empty()) json["unpaired"] = task.unpaired;
    if (!task.rule.empty())
      json["rule"] = {{"file", task.rule_file}, {"line", task.rule_line}, {"text", task.rule}};
    tasks.push_back(std::move(json));
  }
  return tasks;
}

constexpr int kTruthsANumber = 52;  // bits that a number of a page holds exactly

// Metrics `first` and the next ones, metric i as bit i - first.
std::uint64_t truth_bits(const Episode& episode, int first) {
  std::uint64_t bits = 0;
  for (int i = 0; i < kTruthsANumber; ++i)
    bits |= static_cast<std::uint64_t>(episode.is(first + i)) << i;
  return bits;
}

constexpr std::size_t kLongestRemark = 300;  // characters

using WholeColumn = std::vector<std::int64_t>;

// What a page of many episodes has in place of a column, see PAGE_DATA.md: runs of equal values, or
// bytes in base64.
Json packed(const WholeColumn& column) {
  WholeColumn runs;
  std::int64_t low = 0, high = 0;
  for (std::size_t i = 0; i < column.size(); ++i) {
    const bool is_new = i == 0 || column[i] != column[i - 1];
    if (is_new) runs.insert(runs.end(), {column[i], 0});
    ++runs.back();
    low = i == 0 ? column[i] : std::min(low, column[i]);
    high = i == 0 ? column[i] : std::max(high, column[i]);
  }
  if (8 * runs.size() <= column.size()) return {{"runs", runs}};
  const std::int64_t span = high - low;
  const int width = span < 256 ? 1 : span < 65536 ? 2 : 4;
  if (span > UINT32_MAX) return column;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(column.size() * static_cast<std::size_t>(width));
  for (const std::int64_t value : column) {
    for (int i = 0; i < width; ++i)
      bytes.push_back(static_cast<std::uint8_t>((value - low) >> 8 * i & 255));
  }
  return {{"from", low}, {"width", width}, {"bytes", wire::to_base64(bytes)}};
}

Json episodes_json(const Benchmark& benchmark, const PageOptions& options, Json& strings) {
  const std::vector<Episode>& episodes = benchmark.episodes;
  const bool packs = episodes.size() > options.plain;
  Json columns = {{"count", episodes.size()}};
  const auto column = [&](auto value) -> Json {
    WholeColumn values;
    values.reserve(episodes.size());
    for (const Episode& e : episodes) values.push_back(static_cast<std::int64_t>(value(e)));
    return packs ? packed(values) : Json(values);
  };
  columns["policy"] = column([](const Episode& e) { return e.policy; });
  columns["task"] = column([](const Episode& e) { return e.task; });
  columns["start"] = column([](const Episode& e) { return e.start; });
  columns["seed"] = column([](const Episode& e) { return e.seed; });
  columns["bits"] = column([](const Episode& e) { return truth_bits(e, 0); });
  columns["steps"] = column([](const Episode& e) { return e.steps; });
  columns["reason"] = column([](const Episode& e) { return e.reason; });
  columns["prompt"] = column([](const Episode& e) { return e.prompt; });
  columns["video"] = column([&](const Episode& e) {
    if (e.video.empty()) return kAbsent;
    strings.push_back(from(options.relative_to, e.video));
    return static_cast<int>(strings.size()) - 1;
  });
  // Many episodes have few remarks, each once among the strings.
  std::vector<int> remark_texts;
  for (const std::string& remark : benchmark.remarks) {
    remark_texts.push_back(static_cast<int>(strings.size()));
    strings.push_back(printable(remark, kLongestRemark));
  }
  const auto remark_of = [&](const Episode& e) {
    return e.remark == kAbsent ? kAbsent : remark_texts[static_cast<std::size_t>(e.remark)];
  };
  // An object's keys are looked for one by one; these come once each.
  const auto put = [](Json& object, std::size_t episode, Json value) {
    object.items().emplace_back(std::to_string(episode), std::move(value));
  };
  Json remarks = Json::object(), told = Json::object();
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    const Episode& e = episodes[i];
    if (e.remark != kAbsent && !packs) put(remarks, i, remark_of(e));
    if (e.row == kAbsent) continue;
    const auto& at = benchmark.rows[static_cast<std::size_t>(e.row)].told_at;
    if (at) put(told, i, *at);
  }
  if (packs && !remark_texts.empty()) columns["remark"] = column(remark_of);
  // The page asks for none of them.
  if (!packs) {
    Json hashes = Json::array();
    for (const Episode& e : episodes)
      hashes.push_back(e.trace == 0 ? std::string() : fmt::format("{:012x}", e.trace));
    columns["sha"] = std::move(hashes);
  }
  const auto truths = std::count_if(benchmark.metrics.begin(), benchmark.metrics.end(),
                                    [](const Metric& metric) { return metric.truth; });
  Json more_bits = Json::array();
  for (std::ptrdiff_t first = kTruthsANumber; first < truths; first += kTruthsANumber)
    more_bits.push_back(
        column([&](const Episode& e) { return truth_bits(e, static_cast<int>(first)); }));
  Json numbers = Json::object();
  for (std::size_t m = static_cast<std::size_t>(truths); m < benchmark.metrics.size(); ++m) {
    const std::size_t at = m - static_cast<std::size_t>(truths);
    Json values = Json::array();
    for (const Episode& e : episodes) {
      const bool known = e.valid() && at < e.numbers.size() && std::isfinite(e.numbers[at]);
      values.push_back(known ? Json(rounded(e.numbers[at])) : Json());
    }
    numbers[benchmark.metrics[m].name] = std::move(values);
  }
  if (!more_bits.empty()) columns["more_bits"] = std::move(more_bits);
  if (!remarks.empty()) columns["remarks"] = std::move(remarks);
  if (!told.empty()) columns["told"] = std::move(told);
  if (!numbers.empty()) columns["numbers"] = std::move(numbers);
  return columns;
}

// "1,200 episodes, seeds 42, 7"
std::string what_policy_did(const Policy& policy) {
  int done = 0;
  std::set<int> seeds;
  for (const RunInfo& run : policy.runs) {
    done += run.done;
    seeds.insert(run.seeds.begin(), run.seeds.end());
  }
  std::string list;
  for (const int seed : seeds) list += (list.empty() ? "" : ", ") + std::to_string(seed);
  return fmt::format("{} episodes, seed{} {}", digit_groups(static_cast<std::size_t>(done)), seeds.size() == 1 ? "" : "s", list);
}

std::vector<std::string> what_was_run(const Benchmark& benchmark) {
  std::vector<std::string> sentences;
  for (const PlanInfo& plan : benchmark.plans) {
    sentences.push_back(fmt::format(
        "Plan {}, suite `{}`: {} tasks, {} starts{}.", plan.root.substr(0, 12), plan.suite,
        plan.tasks, plan.starts,
        plan.trained_on.empty() ? "" : ", out of distribution against " + plan.trained_on));
  }
  std::set<std::string> kinds;
  for (const Policy& policy : benchmark.policies) kinds.insert(what_policy_did(policy));
  if (kinds.size() == 1 && benchmark.policies.size() > 1) {
    sentences.push_back(
        fmt::format("{} policies, each {}.", benchmark.policies.size(), *kinds.begin()));
    return sentences;
  }
  for (const Policy& policy : benchmark.policies)
    sentences.push_back(fmt::format("{}: {}.", policy.label, what_policy_did(policy)));
  return sentences;
}

}  // namespace

std::string adaptive_interval_text() {
  return "Where a policy's name says \"until\", how many episodes were run depended on how they "
         "ended: 95 % intervals are of the rate that all its episodes would have and hold whenever it "
         "stopped (sampling without replacement), and rates over several tasks are weighted by how "
         "many episodes each could have.";
}

std::string interval_text(const Benchmark& benchmark) {
  const std::string fixed =
    "95 % intervals: Wilson's, with episodes counted as what they are worth: starts in one place "
    "form a cluster, tasks are strata (with one task and one seed, Wilson's own)";
  return fixed + (benchmark.has_adaptive() ? ". " + adaptive_interval_text() : "");
}

double rounded(double value) { return probe::rounded(value, 4); }

std::string p_text(double p) {
  if (p < 1e-4) return "p < 0.0001";
  return fmt::format("p = {:.2g}", p);
}

void put_answers(Json& json, const Contrast& contrast, double scale, bool adjusted) {
  const auto answer = [&](const Answer& a) {
    Json one = {{"units", a.nets.size()},
                {"low", rounded(scale * a.interval.low)},
                {"high", rounded(scale * a.interval.high)},
                {"p", a.p}};
    if (!adjusted) return one;
    one["p_adjusted"] = a.adjusted;
    one["real"] = a.is_real();
    if (a.detectable) one["detectable"] = rounded(scale * *a.detectable);
    if (a.more) one["more"] = *a.more;
    return one;
  };
  json[kOnTheseStarts] = answer(contrast.here);
  json[kForStartsNeverTried] = answer(contrast.anew);
}

Json to_json(const std::optional<Estimate>& estimate) {
  if (!estimate || estimate->count.n == 0) return nullptr;
  Json json = {estimate->count.k, estimate->count.n, rounded(estimate->interval.low),
               rounded(estimate->interval.high)};
  if (estimate->weighted) json.push_back(rounded(*estimate->weighted));
  return json;
}

Json page_data(const Benchmark& benchmark, const Tables& tables, const PageOptions& options) {
  Json data = {{"format", "vlaprobe-report"}, {"version", 1}, {"title", options.title}};
  if (!options.command.empty()) data["command"] = options.command;
  if (!options.program.empty()) data["program"] = options.program;
  data["confidence"] = 0.95;
  data["interval"] = interval_text(benchmark);
  data["run"] = what_was_run(benchmark);
  data["findings"] = findings(benchmark, tables);
  data["notes"] = Json::array();
  for (const Note& note : benchmark.notes)
    data["notes"].push_back({{"level", note.level}, {"text", note.text}});
  data["metrics"] = Json::array();
  for (const Metric& metric : benchmark.metrics) {
    data["metrics"].push_back({{"name", metric.name},
                               {"label", label_of(metric.name)},
                               {"truth", metric.truth},
                               {"good", metric.good}});
  }
  data["categories"] = Json::array();
  for (const Category& c : benchmark.categories)
    data["categories"].push_back({{"name", c.name}, {"label", c.label}, {"tasks", c.tasks}});
  data["objects"] = Json::array();
  const auto seen = [](const std::optional<bool>& known) { return known ? Json(*known) : Json(); };
  for (const Object& object : benchmark.objects) {
    data["objects"].push_back(
        {{"name", object.name},
         {"label", label_of(object.name)},
         {"seen",
          {{"source", seen(object.seen_as_source)}, {"target", seen(object.seen_as_target)}}}});
  }
  data["plans"] = Json::array();
  for (const PlanInfo& plan : benchmark.plans) {
    data["plans"].push_back({{"root", plan.root},
                             {"suite", plan.suite},
                             {"tasks", plan.tasks},
                             {"starts", plan.starts},
                             {"trained_on", plan.trained_on}});
  }
  data["fingerprints"] = benchmark.fingerprints;
  data["fingerprint_differences"] = benchmark.fingerprint_differences;
  data["prompts"] = benchmark.prompts;
  data["reasons"] = benchmark.reasons;
  data["policies"] = policies_json(benchmark, options);
  data["tasks"] = tasks_json(benchmark);
  Json strings = Json::array();
  data["episodes"] = episodes_json(benchmark, options, strings);
  data["strings"] = std::move(strings);
  data["tables"] = tables_json(benchmark, tables, options);
  if (!options.events.is_null()) data["tables"]["events"] = options.events;
  add_knowledge(benchmark, make_knowledge(benchmark), data);
  return data;
}

}  // namespace probe::report
