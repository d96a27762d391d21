#include "runtime/assets/manifest.h"

#include <filesystem>

#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/base/paths.h"

namespace probe::assets {

const ManifestEntry* Manifest::find(std::string_view path) const {
  const auto found = files.find(path);
  return found == files.end() ? nullptr : &found->second;
}

std::string Manifest::to_json() const {
  Json list = Json::array();
  for (const auto& [path, entry] : files) {
    Json file = {{"path", path}, {"bytes", entry.bytes}, {"sha256", entry.sha256}};
    if (!entry.source.empty()) file["source"] = entry.source;
    list.push_back(std::move(file));
  }
  return Json{{"files", list}}.dump(1) + "\n";
}

Result<Manifest> read_manifest(const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / "manifest.json").string();
  if (!is_there(path)) return Manifest{};
  PROBE_ASSIGN(const std::string text, read_file(path, {.code = Fault::kAsset}));
  const auto root = Json::parse(text);
  const Failure malformed{Fault::kAsset, "is not a manifest of files with path, bytes and sha256",
                          path};
  if (!root.is_object() || !root.contains("files") || !root["files"].is_array()) return malformed;
  Manifest manifest;
  for (const auto& entry : root["files"]) {
    if (!entry.is_object() || !entry.contains("path") || !entry["path"].is_string() ||
        !entry.contains("bytes") || !entry["bytes"].is_number_unsigned() ||
        !entry.contains("sha256") || !entry["sha256"].is_string()) {
      return malformed;
    }
    manifest.files[entry["path"].get<std::string>()] = {
        entry["bytes"].get<std::uint64_t>(), entry["sha256"].get<std::string>(),
        entry.contains("source") && entry["source"].is_string() ? entry["source"].get<std::string>()
                                                                : std::string()};
  }
  return manifest;
}

}  // namespace probe::assets
