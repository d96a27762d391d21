#include "runtime/doctor/doctor.h"

#include <algorithm>
#include <filesystem>

#include "runtime/base/asset_root.h"
#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/base/paths.h"
#include "runtime/doctor/golden_starts.h"
#include "runtime/render/renderer.h"
#include "runtime/scene/mesh_cache.h"
#include "runtime/stage/assets.h"

namespace probe::doctor {
namespace {

namespace fs = std::filesystem;

std::string value_of(const store::Fingerprint& fingerprint, const std::string& name) {
  for (const auto& [entry, value] : fingerprint.entries) {
    if (entry == name) return value;
  }
  return {};
}

std::string code_level() {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("x86-64-v4")) return "x86-64-v4";
  if (__builtin_cpu_supports("x86-64-v3")) return "x86-64-v3";
#endif
  return "as compiled";
}

// Compares every file with the manifest; returns the manifest's own hash.
Result<Sha256> check_manifest(const std::string& root, DoctorReport& report) {
  const std::string path = (fs::path(root) / "manifest.json").string();
  PROBE_ASSIGN(const std::string text, read_file(path));
  const auto json = Json::parse(text);
  const auto files = json.is_object() ? json.value("files", Json()) : Json();
  if (!files.is_array() && !files.is_object()) {
    return Failure{Fault::kAsset, "is no manifest of assets", path};
  }
  const auto check = [&](const std::string& name, const Json& entry) {
    ++report.asset_files;
    const auto bytes = read_file((fs::path(root) / name).string());
    if (!bytes) {
      report.asset_damage.push_back(name + ": " + bytes.failure().message);
      return;
    }
    const std::string hash = entry.value("sha256", "");
    if (to_hex(sha256(std::string_view(*bytes))) != hash) {
      report.asset_damage.push_back(name + ": has other bytes than the manifest says");
    }
  };
  if (files.is_array()) {
    for (const auto& entry : files) {
      if (entry.is_object()) check(entry.value("path", ""), entry);
    }
  } else {
    for (const auto& [name, entry] : files.items()) check(name, entry);
  }
  return sha256(std::string_view(text));
}

}  // namespace

bool DoctorReport::fine() const { return asset_damage.empty() && (!golden || golden->fine()); }

Result<DoctorReport> examine(const AssetRoot& assets, const SuiteMaker& suite) {
  DoctorReport report;
  PROBE_ASSIGN(const AssetRoot root, find_asset_root(assets));
  Sha256 manifest;
  std::string golden_root;  // of the golden pictures
  for (const std::string& folder : root.folders()) {
    report.asset_root += (report.asset_root.empty() ? "" : ", ") + folder;
    // Of several, a folder of one packed mug has none.
    if (root.folders().size() > 1 && !is_there(folder + "/manifest.json")) continue;
    PROBE_ASSIGN(manifest, check_manifest(folder, report));
    if (golden_root.empty() && shown_in_golden(folder)) golden_root = folder;
  }
  if (golden_root.empty()) golden_root = root.folders().front();
  report.fingerprint = store::take_fingerprint(manifest);
  report.code_level = code_level();
  const std::string cpu = value_of(report.fingerprint, "cpu");
  // "vendor family number set set ..."
  for (const char* set : {"sse4_2", "avx", "fma", "avx2", "avx512f", "avx512vl"}) {
    if ((" " + cpu + " ").find(std::string(" ") + set + " ") != std::string::npos) {
      report.cpu_sets.emplace_back(set);
    }
  }
  PROBE_ASSIGN(report.ray_engine, render::describe_ray_engine());
  report.mesh_cache = scene::default_mesh_cache();
  report.golden_folder = golden_folder();
  report.own_assets = report.golden_folder.empty() || shown_in_golden(golden_root);
  if (!report.own_assets) return report;
  PROBE_ASSIGN(auto frames, draw_golden_frames(golden_root));
  const auto plan = suite(golden_root);
  auto starts = plan ? draw_first_frames(*plan, golden_root)
                     : Result<std::vector<GoldenFrame>>(plan.failure());
  if (starts) {
    for (GoldenFrame& frame : *starts) frames.push_back(std::move(frame));
  } else {
    report.no_suite = to_text(starts.failure());
  }
  PROBE_ASSIGN(const GoldenSettle settle, settle_golden_objects(golden_root));
  report.settle_state = to_hex(settle.state);
  if (!report.golden_folder.empty()) {
    PROBE_ASSIGN(report.golden, check_golden(report.golden_folder, frames, settle));
  }
  return report;
}

std::string to_json(const DoctorReport& report, const std::string& version) {
  Json json;
  json["version"] = version;
  json["fine"] = report.fine();
  json["cpu"] = value_of(report.fingerprint, "cpu");
  json["instruction_sets"] = report.cpu_sets;
  json["code_level"] = report.code_level;
  json["ray_engine"] = report.ray_engine;
  json["assets"] = {
      {"root", report.asset_root}, {"files", report.asset_files}, {"damage", report.asset_damage}};
  json["mesh_cache"] = report.mesh_cache;
  json["own_assets"] = report.own_assets;
  json["settle"]["state"] = report.settle_state;
  json["suite"] = nullptr;
  if (!report.no_suite.empty()) json["suite"] = report.no_suite;
  json["golden"] = nullptr;
  if (report.golden) {
    json["settle"]["result"] = to_text(report.golden->settle);
    json["settle"]["distance_m"] = report.golden->settle_distance;
    auto& golden = json["golden"];
    golden["folder"] = report.golden_folder;
    golden["other_build"] = report.golden->other_build;
    golden["frames"] = Json::array();
    for (const GoldenCheck& check : report.golden->frames) {
      golden["frames"].push_back({{"name", check.name},
                                  {"result", to_text(check.state)},
                                  {"ids", check.ids},
                                  {"colours", check.levels},
                                  {"depth_m", check.depth}});
    }
  }
  for (const auto& [name, value] : report.fingerprint.entries) json["fingerprint"][name] = value;
  return json.dump(2);
}

std::string to_text(const DoctorReport& report, const std::string& version) {
  std::string out;
  const auto line = [&out](const std::string& name, const std::string& value) {
    out += name + std::string(name.size() < 16 ? 16 - name.size() : 1, ' ') + value + "\n";
  };
  line("vlaprobe", version);
  for (const auto& [name, value] : report.fingerprint.entries) line(name, value);
  line("code level", report.code_level);
  line("rays", report.ray_engine);
  line("asset folder", report.asset_root + ", " + std::to_string(report.asset_files) + " files, " +
                           std::to_string(report.asset_damage.size()) + " damaged");
  for (const std::string& damage : report.asset_damage) line("", damage);
  line("mesh cache", report.mesh_cache.empty() ? "none" : report.mesh_cache);
  if (!report.own_assets) {
    line("golden pictures", "not compared: they show vlaprobe's own assets, these are others");
    return out;
  }
  if (!report.no_suite.empty()) line("suite not drawn", report.no_suite);
  if (!report.golden) {
    line("settled state", report.settle_state);
    line("golden pictures", "not stored here");
    return out;
  }
  line("settled state", report.settle_state + ", " + to_text(report.golden->settle));
  for (const std::string& other : report.golden->other_build) line("golden made by", other);
  int identical = 0;
  for (const GoldenCheck& check : report.golden->frames) {
    identical += check.state == GoldenState::kIdentical;
  }
  line("golden pictures", std::to_string(identical) + " of " +
                              std::to_string(report.golden->frames.size()) + " identical");
  for (const GoldenCheck& check : report.golden->frames) {
    if (check.state == GoldenState::kIdentical) continue;
    line("", check.name + ": " + to_text(check.state) + ", " + std::to_string(check.ids) +
                 " pixels show another thing, " + std::to_string(check.levels) +
                 " have another colour");
  }
  return out;
}

}  // namespace probe::doctor
