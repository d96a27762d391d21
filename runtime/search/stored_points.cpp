#include "runtime/search/stored_points.h"

#include <bit>
#include <cmath>
#include <filesystem>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/base/paths.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/ids.h"
#include "runtime/store/fingerprint.h"

namespace probe::search {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPlanName = "points.plan", kJsonName = "points.json";

constexpr const char* kRoundFormat = "vlaprobe search round";
constexpr int kRoundVersion = 1;

std::string plan_of(const std::string& folder) { return (fs::path(folder) / kPlanName).string(); }
std::string table_of(const std::string& folder) { return (fs::path(folder) / kJsonName).string(); }

Json numbers(std::span<const std::uint32_t> values) {
  Json out = Json::array();
  for (const std::uint32_t value : values) out.push_back(value);
  return out;
}

// Whole numbers below `bound`.
std::optional<std::vector<std::uint32_t>> whole_numbers(const Json* json, std::size_t bound) {
  if (json == nullptr || !json->is_array()) return std::nullopt;
  std::vector<std::uint32_t> out;
  for (const Json& one : *json) {
    if (!one.is_number()) return std::nullopt;
    const double number = one.get<double>();
    if (!(number >= 0 && number < static_cast<double>(bound)) || number != std::floor(number))
      return std::nullopt;
    out.push_back(static_cast<std::uint32_t>(number));
  }
  return out;
}

// What was found out about one point.
Json stored_json(const PlannedPoint& point) {
  return {{"starts", numbers(point.starts)},
          {"wanted", numbers(point.point.starts)},
          {"task", point.task ? Json(*point.task) : Json(nullptr)},
          {"why", point.why}};
}

// Starts of a point stand one for each start of its task in the plan, and are some of the base's.
bool read_stored(const Json& json, const plan::Plan& plan, std::size_t base_starts,
                 PlannedPoint& point) {
  auto starts = whole_numbers(json.find("starts"), base_starts);
  auto wanted = whole_numbers(json.find("wanted"), base_starts);
  const Json* const task = json.find("task");
  if (!starts || !wanted || task == nullptr) return false;
  point.starts = std::move(*starts);
  point.point.starts = std::move(*wanted);
  point.why = json.value("why", "");
  if (!task->is_number()) return task->is_null() && point.starts.empty();
  point.task = plan.find_task(point.point.name);
  return point.task && Json(*point.task) == *task &&
         plan.episodes(plan.tasks()[*point.task]).size() == point.starts.size();
}

std::string points_hash(const Json& json) { return to_hex(sha256(json.dump())); }

}  // namespace

bool is_stored_point_file(std::string_view name) { return name == kPlanName || name == kJsonName; }

std::string StoredPoints::key_of(std::span<const PlannedPoint> points) const {
  Hasher hasher;
  hasher.text(kRoundFormat).text(store::own_build_id()).text(base_.hash());
  hasher.text(base_.options().assets.text()).text(base_.options().library);
  for (const PlannedPoint& one : points) {
    hasher.text(one.point.name).u64(one.point.draw).u64(one.point.values.size());
    for (const double value : one.point.values) hasher.u64(std::bit_cast<std::uint64_t>(value));
    hasher.u64(one.point.starts.size());
    for (const std::uint32_t start : one.point.starts) hasher.u64(start);
  }
  return to_hex(hasher.finish());
}

bool StoredPoints::has_assets(const PlannedPoints& planned) {
  for (const plan::AssetRecord& asset : planned.plan.assets()) {
    const std::string file = planned.assets.file(planned.plan.text(asset.path));
    std::pair<std::string, std::string> known(file, to_hex(plan::to_sha256(asset.sha256)));
    if (same_.contains(known)) continue;
    const auto bytes = read_file(file);
    if (!bytes || to_hex(sha256(*bytes)) != known.second) return false;
    same_.insert(std::move(known));
  }
  return true;
}

std::optional<PlannedPoints> StoredPoints::find(std::span<const PlannedPoint> points,
                                                const std::string& folder) {
  const auto text = read_file(table_of(folder));
  if (!text) return std::nullopt;
  const Json json = Json::parse(*text);
  if (json.is_discarded() || json.value("format", "") != kRoundFormat ||
      json.value("version", Json(0)) != Json(kRoundVersion) ||
      json.value("key", "") != key_of(points))
    return std::nullopt;
  const Json* const kept = json.find("points");
  if (kept == nullptr || !kept->is_array() || kept->size() != points.size() ||
      json.value("points_sha256", "") != points_hash(*kept))
    return std::nullopt;
  const auto bytes = read_file(plan_of(folder));
  if (!bytes) return std::nullopt;
  const auto raw = std::as_bytes(std::span(*bytes));
  auto plan = plan::Plan::from_bytes({raw.begin(), raw.end()});
  if (!plan || to_hex(plan->root()) != json.value("plan_root", "")) return std::nullopt;
  PlannedPoints out{std::move(plan).value(),
                    0,
                    {points.begin(), points.end()},
                    base_.assets_beside(plan_of(folder))};
  const auto base_task = out.plan.find_task(base_.task().name);
  if (!base_task) return std::nullopt;
  out.base_task = *base_task;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!read_stored((*kept)[i], out.plan, base_.task().starts.size(), out.points[i]))
      return std::nullopt;
  }
  if (!has_assets(out)) return std::nullopt;
  return out;
}

Status StoredPoints::keep(std::span<const PlannedPoint> points, const PlannedPoints& planned,
                          const std::string& folder) const {
  if (store::own_build_id().empty()) return {};  // another program would not be told from this one
  Json kept = Json::array();
  for (const PlannedPoint& one : planned.points) kept.push_back(stored_json(one));
  const Json json = {{"format", kRoundFormat},
                     {"version", kRoundVersion},
                     {"key", key_of(points)},
                     {"plan_root", to_hex(planned.plan.root())},
                     {"points_sha256", points_hash(kept)},
                     {"points", std::move(kept)}};
  PROBE_TRY(write_file(plan_of(folder), planned.plan.bytes()));
  const std::string text = json.dump() + "\n";
  return write_file(table_of(folder), std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace probe::search
