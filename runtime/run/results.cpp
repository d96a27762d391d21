// Rows as JSON and as comma-separated values.
#include "runtime/run/results.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace probe::run {
namespace {

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string cell(const ResultRow& row, const std::string& metric) {
  if (row.invalid) return "";
  for (const MetricValue& value : row.metrics) {
    if (value.name != metric) continue;
    if (value.is_bool) return value.value != 0 ? "true" : "false";
    return number(value.value);
  }
  return "";
}

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
  auto array = nlohmann::ordered_json::array();
  for (const ResultRow& row : rows) {
    nlohmann::ordered_json json;
    json["task"] = row.task;
    json["episode"] = row.episode;
    json["seed"] = row.seed;
    json["policy"] = row.policy;
    for (const std::string& name : names) json[name] = nullptr;
    for (const MetricValue& metric : row.metrics) {
      if (row.invalid) continue;
      if (metric.is_bool) {
        json[metric.name] = metric.value != 0;
      } else {
        json[metric.name] = metric.value;
      }
    }
    json["steps"] = row.steps;
    json["invalid"] = row.invalid ? nlohmann::ordered_json(*row.invalid) : nullptr;
    json["prompt_sha256"] = row.prompt_sha256;
    json["image_sha256"] = row.image_sha256;
    json["frames_sha256"] = row.frames_sha256;
    json["trace_sha256"] = row.trace_sha256;
    json["episode_id"] = row.episode_id;
    json["start_id"] = row.start_id;
    json["trace"] = row.trace;
    array.push_back(std::move(json));
  }
  // A policy's error text may hold any bytes; what is not UTF-8 is replaced, never thrown.
  return array.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string results_to_csv(std::span<const ResultRow> rows) {
  const std::vector<std::string> names = metric_names(rows);
  std::string text = "task,episode,seed,policy";
  for (const std::string& name : names) text += "," + quoted(name);
  text +=
      ",steps,invalid,prompt_sha256,image_sha256,frames_sha256,trace_sha256,episode_id,start_id,"
      "trace\n";
  for (const ResultRow& row : rows) {
    text += quoted(row.task) + "," + std::to_string(row.episode) + "," + std::to_string(row.seed) +
            "," + quoted(row.policy);
    for (const std::string& name : names) text += "," + cell(row, name);
    text += "," + std::to_string(row.steps) + "," + quoted(row.invalid.value_or(""));
    for (const std::string* value :
         {&row.prompt_sha256, &row.image_sha256, &row.frames_sha256, &row.trace_sha256,
          &row.episode_id, &row.start_id, &row.trace}) {
      text += "," + quoted(*value);
    }
    text += "\n";
  }
  return text;
}

}  // namespace probe::run
