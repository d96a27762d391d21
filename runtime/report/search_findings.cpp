#include "runtime/report/search_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "runtime/base/paths.h"
#include "runtime/report/left_out.h"
#include "runtime/search/search.h"
#include "runtime/search/shown_value.h"

namespace probe::report {
namespace {

namespace fs = std::filesystem;

// Reads keys of an object; the first that is missing or of another kind is remembered, and then
// everything is empty.
class KeyReader {
 public:
  explicit KeyReader(std::string& wrong) : wrong_(wrong) {}

  const Json* has(const Json& from, const char* key) {
    const Json* const found = from.find(key);
    if (found == nullptr) miss(key);
    return found;
  }
  std::string text(const Json& from, const char* key) {
    const Json* const value = has(from, key);
    if (value != nullptr && !value->is_string()) miss(key);
    return value != nullptr && value->is_string() ? value->text() : "";
  }
  bool flag(const Json& from, const char* key) {
    const Json* const value = has(from, key);
    if (value != nullptr && !value->is_boolean()) miss(key);
    return value != nullptr && value->is_boolean() && value->get<bool>();
  }
  double number(const Json& from, const char* key) {
    const Json* const value = has(from, key);
    if (value == nullptr) return 0;
    return real(*value, key);
  }
  int whole(const Json& from, const char* key) {
    const double value = number(from, key);
    if (value < 0 || value > 1e9) miss(key);
    return static_cast<int>(std::clamp(value, 0.0, 1e9));
  }
  std::optional<int> whole_or_none(const Json& from, const char* key) {
    if (!from.contains(key)) return std::nullopt;
    return whole(from, key);
  }
  std::optional<double> number_or_none(const Json& from, const char* key) {
    if (!from.contains(key)) return std::nullopt;
    return number(from, key);
  }
  stats::Count count(const Json& from, const char* key) {
    const auto [k, n] = two(from, key);
    if (k < 0 || k > n || n > 1e12) {
      miss(key);
      return {};
    }
    return {static_cast<std::int64_t>(k), static_cast<std::int64_t>(n)};
  }
  stats::Interval interval(const Json& from, const char* key) {
    const auto [low, high] = two(from, key);
    return {low, high};
  }
  // Elements of a list that must be there; each has to be an object.
  std::vector<const Json*> objects(const Json& from, const char* key) {
    std::vector<const Json*> out;
    const Json* const list = has(from, key);
    if (list == nullptr) return out;
    if (!list->is_array()) miss(key);
    for (const Json& one : *list) {
      if (!one.is_object()) miss(key);
      out.push_back(&one);
    }
    return out;
  }

 private:
  void miss(const char* key) {
    if (wrong_.empty()) wrong_ = key;
  }
  double real(const Json& value, const char* key) {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      miss(key);
      return 0;
    }
    return value.get<double>();
  }
  std::pair<double, double> two(const Json& from, const char* key) {
    const Json* const value = has(from, key);
    if (value == nullptr) return {};
    if (!value->is_array() || value->size() != 2) {
      miss(key);
      return {};
    }
    return {real((*value)[0], key), real((*value)[1], key)};
  }

  std::string& wrong_;
};

Tolerance read_side(KeyReader& read, const Json& from) {
  Tolerance out;
  out.axis = read.text(from, "axis");
  out.side = read.text(from, "side");
  out.status = read.text(from, "status");
  out.unit = read.text(from, "unit");
  out.sentence = read.text(from, "sentence");
  out.up = read.flag(from, "up");
  out.own = read.number(from, "own");
  out.end = read.number(from, "end");
  out.last_fair = read.number(from, "last_fair");
  out.at = read.number_or_none(from, "tolerance");
  if (out.at || out.is_found()) {
    out.at = read.number(from, "tolerance");
    out.near = read.number(from, "low");
    out.far = read.number(from, "high");
  }
  out.trials = read.whole(from, "trials");
  out.left_out = read.whole(from, "left_out");
  out.own_success = read.count(from, "own_success");
  return out;
}

WorstCase read_case(KeyReader& read, const Json& from) {
  return {.name = read.text(from, "name"),
          .text = read.text(from, "text"),
          .sentence = read.text(from, "sentence"),
          .distance = read.number(from, "distance"),
          .at_least = read.number(from, "at_least"),
          .p = read.number(from, "p"),
          .failures = read.count(from, "failures"),
          .confirmed = read.flag(from, "confirmed")};
}

AxisShare read_axis(KeyReader& read, const Json& from) {
  return {.axis = read.text(from, "axis"),
          .side = read.text(from, "side"),
          .matters = read.flag(from, "matters"),
          .p = read.number(from, "p"),
          .first = read.number(from, "first"),
          .first_interval = read.interval(from, "first_interval"),
          .total_interval = read.interval(from, "total_interval"),
          .there = read.count(from, "failures_there"),
          .elsewhere = read.count(from, "failures_elsewhere")};
}

PairShare read_pair(KeyReader& read, const Json& from) {
  return {.a = read.text(from, "a"),
          .b = read.text(from, "b"),
          .side_a = read.text(from, "side_a"),
          .side_b = read.text(from, "side_b"),
          .named = read.flag(from, "named"),
          .tested = read.flag(from, "tested"),
          .synergy = read.flag(from, "synergy"),
          .p = read.number(from, "p"),
          .both = read.count(from, "both"),
          .only_a = read.count(from, "only_a"),
          .only_b = read.count(from, "only_b"),
          .neither = read.count(from, "neither")};
}

// "light.power, clutter": where a set has no words of its own.
std::string names_of(const Json& changes) {
  std::string text;
  for (const auto& [axis, value] : changes.items()) text += (text.empty() ? "" : ", ") + axis;
  return text.empty() ? "nothing" : text;
}

TriedSet read_set(KeyReader& read, const Json& from) {
  const std::string text = from.value("text", "");
  const Json* const changes = read.has(from, "changes");
  return {.text = text.empty() && changes != nullptr ? names_of(*changes) : text,
          .verdict = read.text(from, "verdict"),
          .failures = read.count(from, "failures")};
}

// What the method has found; nothing before its search has come that far.
void read_method(KeyReader& read, SearchFindings& out) {
  const Json& json = out.json;
  if (out.method == "boundary" && json.contains("axes")) {
    for (const Json* one : read.objects(json, "axes")) out.sides.push_back(read_side(read, *one));
  }
  if (out.method == "worst" && json.contains("cases")) {
    if (json.contains("own_failures")) out.own_failures = read.count(json, "own_failures");
    for (const Json* one : read.objects(json, "cases")) out.cases.push_back(read_case(read, *one));
  }
  if (out.method == "minimal" && json.contains("tried")) {
    out.sentence = read.text(json, "sentence");
    if (const Json* const whole = read.has(json, "case")) out.case_text = names_of(*whole);
    for (const Json* one : read.objects(json, "tried")) out.tried.push_back(read_set(read, *one));
  }
  if (out.method == "axes" && json.contains("effects")) {
    out.failures = read.count(json, "failures");
    for (const Json* one : read.objects(json, "effects")) out.axes.push_back(read_axis(read, *one));
    for (const Json* one : read.objects(json, "pairs")) out.pairs.push_back(read_pair(read, *one));
  }
}

}  // namespace

std::string Tolerance::text_of(double value) const { return search::shown_text(axis, unit, value); }

std::string Tolerance::interval() const {
  if (!near || !far) return "";
  return text_of(std::min(*near, *far)) + " to " + text_of(std::max(*near, *far));
}

std::string Tolerance::in_words() const {
  if (is_found()) return "falls to half at " + text_of(*at);
  if (status == "no fall") return "stays above half to " + text_of(last_fair);
  if (status == "fails unchanged")
    return fmt::format("nothing to fall from: {} of {} succeed unchanged", own_success.k,
                       own_success.n);
  if (status == "not monotone") return "falls and rises again: no one tolerance";
  if (status == "undecided") return near ? "undecided: " + interval() : "undecided";
  if (status == "left out") return "nothing but the task itself is fair";
  return status;
}

Result<SearchFindings> read_findings(const std::string& folder) {
  PROBE_ASSIGN(search::SearchSummary summary, search::read_search(folder));
  SearchFindings out;
  out.folder = folder;
  out.json = std::move(summary.findings);
  out.trials = summary.trials;
  out.episodes = summary.episodes;
  out.left_out = summary.left_out;
  out.lines = std::move(summary.lines);
  out.done = summary.is_done;
  std::string wrong;
  KeyReader read(wrong);
  if (const Json* const asked = read.has(out.json, "asked")) {
    out.method = read.text(*asked, "method");
    out.space = read.text(*asked, "space");
    out.task = read.text(*asked, "task");
    out.text_sha256 = read.text(*asked, "text_sha256");
    out.policy = read.text(*asked, "policy");
    out.policy_content = asked->value("policy_content", "");
    const double seed = read.number(*asked, "seed");
    out.seed = seed >= 0 && seed < 1e19 ? static_cast<std::uint64_t>(seed) : 0;
    out.error = read.number(*asked, "error");
    out.proved = read.flag(*asked, "proved_by_expert");
  }
  out.file = out.json.value("file", "");
  out.expert_starts = read.whole_or_none(out.json, "expert_starts");
  out.expert_unsolved = read.whole_or_none(out.json, "expert_unsolved");
  out.expert_not_attempted = read.whole_or_none(out.json, "expert_not_attempted");
  if (wrong.empty() && !search::method_of(out.method)) wrong = "method";
  if (wrong.empty()) read_method(read, out);
  if (!wrong.empty())
    return Failure{Fault::kStore, "`" + wrong + "` is not what a search writes there",
                   (fs::path(folder) / "search.json").string()};
  read_left_out(folder, out.reasons, out.notes);
  return out;
}

}  // namespace probe::report
