#include "runtime/base/asset_root.h"

#include <cstdlib>
#include <filesystem>

#include "runtime/base/own_folder.h"

namespace probe {

namespace fs = std::filesystem;

Result<std::string> find_asset_root(std::string_view chosen) {
  // A place that somebody named is the only one looked at.
  const auto only = [](std::string_view path, const char* who) -> Result<std::string> {
    if (fs::is_directory(path)) return std::string(path);
    return Failure{Fault::kAsset, std::string("the asset folder given by ") + who + " is not there",
                   std::string(path)};
  };
  if (!chosen.empty()) return only(chosen, "--assets");
  if (const char* named = std::getenv("VLAPROBE_ASSETS"); named != nullptr && *named != '\0') {
    return only(named, "VLAPROBE_ASSETS");
  }
  std::string looked;
  for (const fs::path& place : own_places("assets")) {
    // A build folder has an `assets` too, without a manifest.
    if (fs::exists(place / "manifest.json")) return place.string();
    looked += (looked.empty() ? "" : ", ") + place.string();
  }
  return Failure{
      Fault::kAsset,
      "no asset folder; looked at " + looked + "; name one with --assets or VLAPROBE_ASSETS", ""};
}

}  // namespace probe
