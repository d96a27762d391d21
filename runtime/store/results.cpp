// Rows as JSON and as comma-separated values.
#include "runtime/store/results.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "runtime/base/csv.h"
#include "runtime/base/exact_text.h"
#include "runtime/base/json.h"

namespace probe::store {
namespace {

std::string line_of(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    if (&cell != cells.data()) line.push_back(',');
    line += csv_cell(cell);
  }
  line.push_back('\n');
  return line;
}

std::string cell(const ResultRow& row, const std::string& metric) {
  if (row.invalid) return "";
  for (const MetricValue& value : row.metrics) {
    if (value.name != metric) continue;
    if (value.is_bool) return value.value != 0 ? "true" : "false";
    return exact_text(value.value);
  }
  return "";
}

// The fields of every row, before and after its metrics.
constexpr std::string_view kBefore[] = {"task", "episode", "seed", "policy"};
constexpr std::string_view kBehind[] = {"steps",
                                        "invalid",
                                        "prompt_sha256",
                                        "image_sha256",
                                        "frames_sha256",
                                        "sent_prompt_sha256",
                                        "sent_image_sha256",
                                        "trace_sha256",
                                        "episode_id",
                                        "start_id",
                                        "trace"};

// Behind those, where there is something to say.
constexpr std::string_view kRareFields[] = {"live", "remark"};

// A metric is called as in the text, and `metric.NAME` where a row has a field NAME: names in texts
// have no dots, and those of a foreign plan that do are prefixed too.
std::string column_of(const std::string& metric) {
  constexpr std::string_view kPrefix = "metric.";
  const auto has = [&](const auto& fields) {
    return std::find(std::begin(fields), std::end(fields), metric) != std::end(fields);
  };
  return has(kBefore) || has(kBehind) || has(kRareFields) || metric.starts_with(kPrefix)
             ? std::string(kPrefix) + metric
             : metric;
}

Json or_null(const std::optional<std::string>& text) { return text ? Json(*text) : nullptr; }

// Every metric that some row has, in order of first use.
std::vector<std::string> metric_names(std::span<const ResultRow> rows) {
  std::vector<std::string> names;
  for (const ResultRow& row : rows) {
    for (const MetricValue& metric : row.metrics) {
      if (std::find(names.begin(), names.end(), metric.name) == names.end()) {
        names.push_back(metric.name);
      }
    }
  }
  return names;
}

}  // namespace

std::string results_to_json(std::span<const ResultRow> rows) {
  const std::vector<std::string> names = metric_names(rows);
  auto array = Json::array();
  for (const ResultRow& row : rows) {
    Json json;
    json["task"] = row.task;
    json["episode"] = row.episode;
    json["seed"] = row.seed;
    json["policy"] = row.policy;
    for (const std::string& name : names) json[column_of(name)] = nullptr;
    for (const MetricValue& metric : row.metrics) {
      if (row.invalid) continue;
      if (metric.is_bool) {
        json[column_of(metric.name)] = metric.value != 0;
      } else {
        json[column_of(metric.name)] = metric.value;
      }
    }
    json["steps"] = row.steps;
    json["invalid"] = or_null(row.invalid);
    json["prompt_sha256"] = row.prompt_sha256;
    json["image_sha256"] = row.image_sha256;
    json["frames_sha256"] = row.frames_sha256;
    json["sent_prompt_sha256"] = or_null(row.sent_prompt_sha256);
    json["sent_image_sha256"] = or_null(row.sent_image_sha256);
    json["trace_sha256"] = row.trace_sha256;
    json["episode_id"] = row.episode_id;
    json["start_id"] = row.start_id;
    json["trace"] = row.trace;
    if (!row.live.empty()) json["live"] = row.live;
    if (row.remark) json["remark"] = *row.remark;
    array.push_back(std::move(json));
  }
  // A policy's error text may hold any bytes; what is not UTF-8 is replaced, never thrown.
  return array.dump(1) + "\n";
}

std::string results_to_csv(std::span<const ResultRow> rows) {
  const std::vector<std::string> names = metric_names(rows);
  std::vector<std::string> header(std::begin(kBefore), std::end(kBefore));
  for (const std::string& name : names) header.push_back(column_of(name));
  header.insert(header.end(), std::begin(kBehind), std::end(kBehind));
  const bool has_live =
      std::ranges::any_of(rows, [](const ResultRow& row) { return !row.live.empty(); });
  const bool has_remark =
      std::ranges::any_of(rows, [](const ResultRow& row) { return row.remark.has_value(); });
  if (has_live) header.emplace_back(kRareFields[0]);
  if (has_remark) header.emplace_back(kRareFields[1]);
  std::string text = line_of(header);
  for (const ResultRow& row : rows) {
    std::vector<std::string> cells = {row.task, std::to_string(row.episode),
                                      std::to_string(row.seed), row.policy};
    for (const std::string& name : names) cells.push_back(cell(row, name));
    cells.push_back(std::to_string(row.steps));
    for (const std::string& value :
         {row.invalid.value_or(""), row.prompt_sha256, row.image_sha256, row.frames_sha256,
          row.sent_prompt_sha256.value_or(""), row.sent_image_sha256.value_or(""), row.trace_sha256,
          row.episode_id, row.start_id, row.trace}) {
      cells.push_back(value);
    }
    if (has_live) cells.push_back(row.live);
    if (has_remark) cells.push_back(row.remark.value_or(""));
    text += line_of(cells);
  }
  return text;
}

}  // namespace probe::store
