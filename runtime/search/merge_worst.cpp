#include "runtime/search/merge_worst.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <set>
#include <vector>

#include "runtime/base/inside.h"
#include "runtime/search/hunt.h"

namespace probe::search {
namespace {

int count_of(const Json& value) { return value.is_number() ? value.get<int>() : 0; }

int whole(const Json& from, const char* key) {
  const Json* const value = from.find(key);
  return value == nullptr ? 0 : count_of(*value);
}

double number(const Json& from, const char* key) {
  const Json* const value = from.find(key);
  return value != nullptr && value->is_number() ? value->get<double>() : 0;
}

bool flag(const Json& from, const char* key) {
  const Json* const value = from.find(key);
  return value != nullptr && value->is_boolean() && value->get<bool>();
}

// "case 3: light.power x 0.3: fails in ..." with another number.
std::string renumbered(const std::string& sentence, std::size_t number) {
  return fmt::format("case {}{}", number, sentence.substr(std::min(sentence.find(':'), sentence.size())));
}

}  // namespace

Result<WorstShard> worst_shard(const std::string& folder, Json findings) {
  WorstShard shard{folder, std::move(findings), 0, 0};
  const std::string text = shard.findings.at("asked").value(kShardKey, "");
  const char* const last = text.data() + text.size();
  const auto number = std::from_chars(text.data(), last, shard.number);
  const auto of = number.ptr == last ? number : std::from_chars(number.ptr + 1, last, shard.of);
  if (of.ec != std::errc() || shard.number < 1 || shard.number > shard.of)
    return Failure{Fault::kUsage, "it is no shard of a search for the worst", folder};
  if (!flag(shard.findings, "done"))
    return Failure{Fault::kUsage,
                   "it is not finished, and cases are confirmed at the end: the same `search` "
                   "command goes on with it",
                   folder};
  const Json* const cases = shard.findings.find("cases");
  if (cases == nullptr || !cases->is_array())
    return Failure{Fault::kUsage, "it has no cases", folder};
  return shard;
}

Json joined_worst(std::span<const WorstShard> shards) {
  Json joined = shards.front().findings;
  joined["asked"].erase(kShardKey);
  joined["asked"]["shards"] = shards.front().of;
  Json numbers = Json::array(), lines = Json::array(), cases = Json::array();
  stats::Count own;
  double rate = 0;
  std::vector<Json> found;
  std::set<std::string> names;
  for (const char* const key : {"trials", "episodes", "left_out", "invalid", "expert_starts",
                                "expert_unsolved", "expert_not_attempted"}) {
    int sum = 0;
    for (const WorstShard& shard : shards) sum += whole(shard.findings, key);
    if (joined.find(key) != nullptr) joined[key] = sum;
  }
  for (const WorstShard& shard : shards) {
    numbers.push_back(shard.number);
    const Json* const failures = shard.findings.find("own_failures");
    if (failures != nullptr && failures->is_array() && failures->size() == 2) {
      own.k += count_of((*failures)[0]);
      own.n += count_of((*failures)[1]);
      rate = std::max(rate, number(shard.findings, "rate"));
    }
    for (const Json& one : shard.findings.at("cases")) {
      if (!names.insert(one.value("name", "")).second) continue;
      found.push_back(one);
    }
  }
  std::ranges::stable_sort(found, [](const Json& a, const Json& b) {
    if (is_confirmed(a) != is_confirmed(b)) return is_confirmed(a);
    return number(a, "distance") < number(b, "distance");
  });
  for (Json& one : found) {
    one["sentence"] = renumbered(one.value("sentence", ""), cases.size() + 1);
    cases.push_back(std::move(one));
  }
  if (const int invalid = whole(joined, "invalid"); invalid > 0)
    lines.push_back(
        fmt::format("{} of {} trials are invalid and left out (`search show` of a shard names "
                    "its first)",
                    invalid, whole(joined, "trials")));
  for (const std::string& line : worst_lines(cases, own, whole(joined, "trials")))
    lines.push_back(line);
  if (own.n > 0) {
    joined["own_failures"] = {own.k, own.n};
    joined["rate"] = rate;
  }
  joined["shards"] = std::move(numbers);
  joined["cases"] = std::move(cases);
  joined["lines"] = std::move(lines);
  return joined;
}

Status keep_found(const Json& findings, const std::string& folder) {
  const Json& asked = findings.at("asked");
  TextOptions text;
  text.file = findings.value("file", "");
  text.space = asked.value("space", "");
  std::string said;
  PROBE_ASSIGN(const std::unique_ptr<BaseTask> base, BaseTask::open(text, said));
  if (base->hash() != asked.value("text_sha256", ""))
    return Failure{Fault::kUsage, "the text has changed since the search", text.file};
  std::vector<KeptPoint> kept;
  for (const Json& one : findings.at("cases")) {
    if (!is_confirmed(one)) continue;
    PROBE_ASSIGN(Case found, read_case(base->space(), one, folder));
    kept.push_back({{one.value("name", ""), std::move(found.values), *found.draw, {}},
                    one.value("sentence", "")});
  }
  if (kept.empty()) return {};
  PROBE_ASSIGN(const std::string file, file_inside(folder, "found.probe"));
  return write_found(*base, kept, file);
}

}  // namespace probe::search
