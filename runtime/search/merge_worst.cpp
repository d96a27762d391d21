#include "runtime/search/merge_worst.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <vector>

#include "runtime/search/search.h"
#include "runtime/search/shown_value.h"

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

bool is_confirmed(const Json& one) { return flag(one, "confirmed"); }

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
  std::size_t confirmed = 0;
  for (Json& one : found) {
    const std::string line = renumbered(one.value("sentence", ""), cases.size() + 1);
    one["sentence"] = line;
    confirmed += is_confirmed(one) ? 1 : 0;
    lines.push_back(line);
    cases.push_back(std::move(one));
  }
  if (cases.empty()) {
    lines.push_back(fmt::format("nothing failed in {} trials: no case is claimed, which does not "
                                "say that there is none",
                                whole(joined, "trials")));
  } else if (own.n > 0 && own.k == own.n) {
    lines = Json::array();
    lines.push_back(fmt::format("the task itself fails in {} trials: there is nothing to break",
                                k_of_n(own)));
  } else if (confirmed == 0) {
    lines.push_back("no case fails more often than the task itself does, as far as fresh trials tell");
  }
  if (own.n > 0) {
    joined["own_failures"] = {own.k, own.n};
    joined["rate"] = rate;
  }
  joined["shards"] = std::move(numbers);
  joined["cases"] = std::move(cases);
  joined["lines"] = std::move(lines);
  return joined;
}

}  // namespace probe::search
