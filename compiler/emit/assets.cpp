#include "compiler/emit/assets.h"

#include <algorithm>
#include <optional>
#include <span>

#include "runtime/base/file.h"
#include "runtime/base/paths.h"
#include "runtime/plan/limits.h"
#include "runtime/plan/text_rule.h"

namespace probe::emit {

bool AssetTable::has(const std::string& path) const {
  return is_file(root_.file(path));
}

const AssetFolder& AssetTable::folder(const std::string& path) {
  return folders_.try_emplace(path, path).first->second;
}

std::string AssetTable::find(const std::string& stem,
                             std::span<const std::string_view> extensions) const {
  for (const std::string_view extension : extensions) {
    std::string path = stem + std::string(extension);
    if (has(path)) return path;
  }
  return stem + std::string(extensions.front());
}

std::uint32_t AssetTable::add(const std::string& path, plan::AssetKind kind, const Span& span,
                              AssetOwner owner) {
  const auto [at, is_new] = known_.try_emplace({path, kind}, plan::kNone);
  const auto miss = [&](std::string why) {
    for (AssetMiss& known : misses_) {
      if (known.path != path) continue;
      if (std::ranges::find(known.owners, owner) == known.owners.end())
        known.owners.push_back(owner);
      return plan::kNone;
    }
    misses_.push_back({path, std::move(why), span, {owner}});
    return plan::kNone;
  };
  if (!is_new && at->second != plan::kNone) return at->second;
  if (!is_new) return miss({});  // why, is known
  // What the verifier would refuse without a place.
  if (!plan::is_asset_path(path))
    return miss("is not written straight, without `.`, `..`, `\\` and empty parts");
  if (path.size() > plan::kMaxStringBytes) return miss("is longer than a plan keeps");
  if (const char* defect = plan::find_text_defect(path)) return miss(defect);
  // A path leads below the root, so that a plan means the same files wherever the root lies.
  const std::string& holder = root_.holder(path);
  const auto file = folder(holder).resolve(path);
  if (!file) {
    const std::string& why = file.failure().message;
    return miss(why == "there is no such file" ? "is not there" : why);
  }
  auto known = hashed_.find(*file);
  if (known == hashed_.end()) {
    const auto bytes = read_file(*file);
    if (!bytes) return miss("cannot be read");
    if (bytes->empty()) return miss("is empty");
    known =
        hashed_.emplace(*file, HashedFile{bytes->size(), sha256(std::string_view(*bytes))}).first;
  }
  Asset asset{path, kind, known->second.byte_size, known->second.hash};
  if (inspect_) {
    const Status good = inspect_(holder, path, kind, asset.hash);
    if (!good) return miss(good.failure().message);
  }
  assets_.push_back(std::move(asset));
  return at->second = static_cast<std::uint32_t>(assets_.size() - 1);
}

std::optional<scene::ImageSize> AssetTable::image_size(std::uint32_t asset) {
  const auto [at, is_new] = sizes_.try_emplace(asset);
  if (!is_new) return at->second;
  const std::string& path = assets_[asset].path;
  const auto bytes = read_file(root_.file(path));
  if (!bytes) return at->second;
  const auto size = scene::image_size(std::as_bytes(std::span(*bytes)), path);
  if (size) at->second = *size;
  return at->second;
}

}  // namespace probe::emit
