// Rows as JSON and as comma-separated values.
#include "runtime/store/results.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

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
struct RareField {
  std::string_view name;
  std::string (*cell)(const ResultRow& row);  // empty: nothing to say
};
std::string steps_cell(int steps) { return steps == 0 ? "" : std::to_string(steps); }
std::string list_cell(const std::optional<std::vector<int>>& numbers) {
  std::string text;
  for (const int number : numbers.value_or(std::vector<int>()))
    text += (text.empty() ? "" : " ") + std::to_string(number);
  return text;
}
constexpr RareField kRareFields[] = {
    {"live", [](const ResultRow& row) { return row.live; }},
    {"only_success", [](const ResultRow& row) { return std::string(row.only_success ? "true" : ""); }},
    {"until", [](const ResultRow& row) { return row.until; }},
    {"remark", [](const ResultRow& row) { return row.remark.value_or(""); }},
    {"idle", [](const ResultRow& row) { return steps_cell(row.idle); }},
    {"delay", [](const ResultRow& row) { return steps_cell(row.delay); }},
    {"told_at", [](const ResultRow& row) { return list_cell(row.told_at); }},
};
constexpr std::string_view kJoints = "joints", kJointPrefix = "joint.";

// A metric is called as in the text, and `metric.NAME` where a row has a field NAME: names in texts
// have no dots, and those of a foreign plan that do are prefixed too.
std::string column_of(const std::string& metric) {
  constexpr std::string_view kPrefix = "metric.";
  const auto has = [&](const auto& fields) {
    return std::find(std::begin(fields), std::end(fields), metric) != std::end(fields);
  };
  return has(kBefore) || has(kBehind) || metric == kJoints || metric.starts_with(kJointPrefix) ||
                 std::ranges::find(kRareFields, metric, &RareField::name) !=
                     std::end(kRareFields) ||
                 metric.starts_with(kPrefix)
             ? std::string(kPrefix) + metric
             : metric;
}

Json or_null(const std::optional<std::string>& text) { return text ? Json(*text) : nullptr; }

// In order of first use.
void add_name(std::vector<std::string>& names, const std::string& name) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

}  // namespace

void RowTexts::know(const ResultRow& row) {
  rare_.resize(std::size(kRareFields));
  for (const MetricValue& metric : row.metrics) add_name(metrics_, metric.name);
  for (const JointValue& joint : row.joints) add_name(joints_, joint.name);
  for (std::size_t i = 0; i < rare_.size(); ++i)
    rare_[i] = rare_[i] || !kRareFields[i].cell(row).empty();
}

std::string RowTexts::json_begin() const { return "["; }

std::string RowTexts::json(const ResultRow& row) {
  Json json;
  json["task"] = row.task;
  json["episode"] = row.episode;
  json["seed"] = row.seed;
  json["policy"] = row.policy;
  for (const std::string& name : metrics_) json[column_of(name)] = nullptr;
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
  if (row.only_success) json["only_success"] = true;
  if (!row.until.empty()) json["until"] = row.until;
  if (row.remark) json["remark"] = *row.remark;
  if (row.idle != 0) json["idle"] = row.idle;
  if (row.delay != 0) json["delay"] = row.delay;
  if (row.told_at) json["told_at"] = *row.told_at;
  for (const JointValue& joint : row.joints)
    json[std::string(kJoints)][joint.name] = joint.position;
  // An array of one, whose lines are those of a longer one. A policy's error text may hold any
  // bytes; what is not UTF-8 is replaced, never thrown.
  auto array = Json::array();
  array.push_back(std::move(json));
  const std::string text = array.dump(1);
  return (std::exchange(is_first_, false) ? "" : ",") + text.substr(1, text.size() - 3);
}

std::string RowTexts::json_end() const { return is_first_ ? "]\n" : "\n]\n"; }

std::string RowTexts::csv_begin() const {
  std::vector<std::string> header(std::begin(kBefore), std::end(kBefore));
  for (const std::string& name : metrics_) header.push_back(column_of(name));
  header.insert(header.end(), std::begin(kBehind), std::end(kBehind));
  for (std::size_t i = 0; i < rare_.size(); ++i) {
    if (rare_[i]) header.emplace_back(kRareFields[i].name);
  }
  for (const std::string& joint : joints_) header.push_back(std::string(kJointPrefix) + joint);
  return line_of(header);
}

std::string RowTexts::csv(const ResultRow& row) const {
  std::vector<std::string> cells = {row.task, std::to_string(row.episode),
                                    std::to_string(row.seed), row.policy};
  for (const std::string& name : metrics_) cells.push_back(cell(row, name));
  cells.push_back(std::to_string(row.steps));
  for (const std::string& value :
       {row.invalid.value_or(""), row.prompt_sha256, row.image_sha256, row.frames_sha256,
        row.sent_prompt_sha256.value_or(""), row.sent_image_sha256.value_or(""), row.trace_sha256,
        row.episode_id, row.start_id, row.trace}) {
    cells.push_back(value);
  }
  for (std::size_t i = 0; i < rare_.size(); ++i) {
    if (rare_[i]) cells.push_back(kRareFields[i].cell(row));
  }
  for (const std::string& joint : joints_) {
    const auto at = std::ranges::find(row.joints, joint, &JointValue::name);
    cells.push_back(at == row.joints.end() ? "" : exact_text(at->position));
  }
  return line_of(cells);
}

std::string results_to_json(std::span<const ResultRow> rows) {
  RowTexts texts;
  for (const ResultRow& row : rows) texts.know(row);
  std::string text = texts.json_begin();
  for (const ResultRow& row : rows) text += texts.json(row);
  return text + texts.json_end();
}

std::string results_to_csv(std::span<const ResultRow> rows) {
  RowTexts texts;
  for (const ResultRow& row : rows) texts.know(row);
  std::string text = texts.csv_begin();
  for (const ResultRow& row : rows) text += texts.csv(row);
  return text;
}

}  // namespace probe::store
