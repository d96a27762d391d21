#include "runtime/plan/claims.h"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace probe::plan {
namespace {

constexpr std::string_view kMetricOf = "body_";

}  // namespace

std::span<const ClaimRecord> claims_of(const Tables& tables, std::uint32_t task) {
  const auto is_before = [](const ClaimRecord& claim, std::uint32_t of) { return claim.task < of; };
  const auto begin = std::lower_bound(tables.claims.begin(), tables.claims.end(), task, is_before);
  const auto end = std::lower_bound(begin, tables.claims.end(), task + 1, is_before);
  return {begin, end};
}

std::string claim_metric(std::uint32_t body) {
  return std::string(kMetricOf) + std::to_string(body);
}

std::optional<std::uint32_t> claimed_body(std::string_view metric) {
  if (!metric.starts_with(kMetricOf)) return std::nullopt;
  std::uint32_t body = 0;
  const char* const end = metric.data() + metric.size();
  const auto [at, error] = std::from_chars(metric.data() + kMetricOf.size(), end, body);
  if (error != std::errc() || at != end || claim_metric(body) != metric) return std::nullopt;
  return body;
}

}  // namespace probe::plan
