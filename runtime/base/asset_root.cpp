#include "runtime/base/asset_root.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "runtime/base/own_folder.h"
#include "runtime/base/shell_word.h"

namespace probe {

namespace fs = std::filesystem;

namespace {

bool is_directory(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

// What a file is a part of: `objects/mug` of `objects/mug/visual.glb`.
std::string_view thing_of(std::string_view path) {
  const std::size_t first = path.find('/');
  if (first == std::string_view::npos) return path;
  return path.substr(0, path.find('/', first + 1));
}

bool has(const std::string& folder, std::string_view path) {
  std::error_code error;
  return fs::exists(fs::path(folder) / thing_of(path), error);
}

// A folder may have `:` in its name.
std::vector<std::string> split(const std::string& value) {
  if (is_directory(value)) return {value};
  std::vector<std::string> folders;
  for (std::size_t begin = 0; begin <= value.size();) {
    const std::size_t end = std::min(value.find(':', begin), value.size());
    if (end > begin) folders.push_back(value.substr(begin, end - begin));
    begin = end + 1;
  }
  return folders;
}

}  // namespace

AssetRoot::AssetRoot(std::string folder) {
  if (!folder.empty()) add(std::move(folder), Kind::kChosen);
}

AssetRoot::AssetRoot(const char* folder) : AssetRoot(std::string(folder)) {}

AssetRoot AssetRoot::chosen(const std::vector<std::string>& folders) {
  AssetRoot root;
  for (const std::string& folder : folders) {
    if (!folder.empty()) root.add(folder, Kind::kChosen);
  }
  return root;
}

AssetRoot AssetRoot::found(const std::vector<std::string>& folders) {
  AssetRoot root;
  for (const std::string& folder : folders) root.add(folder, Kind::kFound);
  return root;
}

void AssetRoot::add(std::string path, Kind kind) {
  for (const Folder& known : folders_) {
    std::error_code error;
    if (known.path == path || fs::equivalent(known.path, path, error)) return;
  }
  const auto behind = std::ranges::upper_bound(folders_, kind, {}, &Folder::kind);
  folders_.insert(behind, {std::move(path), kind});
}

std::vector<std::string> AssetRoot::folders() const {
  std::vector<std::string> paths;
  for (const Folder& folder : folders_) paths.push_back(folder.path);
  return paths;
}

std::string AssetRoot::text() const {
  std::string text;
  for (const Folder& folder : folders_) {
    if (folder.kind != Kind::kBeside) text += (text.empty() ? "`" : ", `") + folder.path + "`";
  }
  return text;
}

const std::string& AssetRoot::holder(std::string_view path) const {
  static const std::string kNone;
  if (folders_.empty()) return kNone;
  if (folders_.size() > 1) {
    for (const Folder& folder : folders_) {
      if (has(folder.path, path)) return folder.path;
    }
  }
  return folders_.front().path;
}

std::string AssetRoot::file(std::string_view path) const {
  return (fs::path(holder(path)) / path).string();
}

AssetRoot AssetRoot::beside(std::span<const std::string> texts) const {
  AssetRoot root = *this;
  std::vector<fs::path> seen;  // many texts lie in few folders
  for (const std::string& text : texts) {
    fs::path folder = fs::path(text).parent_path();
    if (folder.empty()) folder = ".";
    if (std::ranges::find(seen, folder) != seen.end()) continue;
    seen.push_back(folder);
    for (const fs::path& place : {folder, folder / "assets"}) {
      if (is_directory(place.string())) root.add(place.string(), Kind::kBeside);
    }
  }
  return root;
}

AssetRoot AssetRoot::kept_for(std::span<const std::string> paths) const {
  AssetRoot kept;
  bool is_needed = false;
  for (const Folder& folder : folders_) {
    const bool holds = std::ranges::any_of(
        paths, [&](const std::string& path) { return holder(path) == folder.path && has(folder.path, path); });
    if (folder.kind == Kind::kBeside && !holds) continue;
    is_needed = is_needed || folder.kind != Kind::kFound;
    kept.folders_.push_back(folder);
  }
  return is_needed ? kept : AssetRoot();
}

std::string AssetRoot::advice(std::string_view path) const {
  const auto is_known = [&](const std::string& place) {
    return std::ranges::any_of(folders_, [&](const Folder& one) { return one.path == place; });
  };
  std::string named, place;
  for (const Folder& folder : folders_) {
    if (folder.kind != Kind::kBeside) named += " --assets " + shell_word(folder.path);
  }
  const auto is_there = [&](const fs::path& folder) {
    std::error_code error;
    return fs::is_regular_file(folder / path, error);
  };
  for (const Folder& folder : folders_) {
    if (folder.kind != Kind::kBeside) continue;
    std::error_code error;
    for (fs::directory_iterator at(folder.path, error), end; !error && at != end; at.increment(error)) {
      const std::string other = at->path().lexically_normal().string();
      if (!is_there(at->path()) || is_known(other) || (!place.empty() && place < other)) continue;
      place = other;
    }
  }
  if (!place.empty()) return "it is in `" + place + "`: `--assets " + shell_word(place) + named + "`";
  for (const fs::path& own : own_places("assets")) {
    if (!is_there(own) || is_known(own.string())) continue;
    return "it is in `" + own.string() + "`: `" + (named.empty() ? "" : named.substr(1) + " ") +
           "--assets " + shell_word(own.string()) + "`";
  }
  return {};
}

Status AssetRoot::check() const {
  for (const Folder& folder : folders_) {
    if (is_directory(folder.path)) continue;
    const char* const who = folder.kind == Kind::kChosen   ? "the asset folder given by --assets is not there"
                            : folder.kind == Kind::kBeside ? "the asset folder beside the text is gone"
                                                           : "the asset folder is gone";
    return Failure{Fault::kAsset, who, folder.path};
  }
  return {};
}

Result<AssetRoot> find_asset_root(const AssetRoot& chosen) {
  // Places that somebody named are the only ones looked at.
  if (!chosen.empty()) {
    PROBE_TRY(chosen.check());
    return chosen;
  }
  if (const char* named = std::getenv("VLAPROBE_ASSETS"); named != nullptr && *named != '\0') {
    const std::vector<std::string> folders = split(named);
    if (folders.empty())
      return Failure{Fault::kAsset, "VLAPROBE_ASSETS names no folder", named};
    for (const std::string& folder : folders) {
      if (!is_directory(folder))
        return Failure{Fault::kAsset, "the asset folder given by VLAPROBE_ASSETS is not there",
                       folder};
    }
    return AssetRoot::found(folders);
  }
  std::string looked;
  for (const fs::path& place : own_places("assets")) {
    // A build folder has an `assets` too, without a manifest.
    if (fs::exists(place / "manifest.json")) return AssetRoot::found({place.string()});
    looked += (looked.empty() ? "" : ", ") + place.string();
  }
  return Failure{
      Fault::kAsset,
      "no asset folder; looked at " + looked + "; name one with --assets or VLAPROBE_ASSETS", ""};
}

}  // namespace probe
