// Files under the asset root that a plan refers to, by path and content. Each file is looked at
// once.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/emit/asset_hashes.h"
#include "compiler/emit/compile.h"
#include "compiler/source/source.h"
#include "runtime/base/asset_path.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/format.h"
#include "runtime/scene/image.h"

namespace probe::emit {

struct Asset {
  std::string path;  // relative to the asset root, with slashes
  plan::AssetKind kind = plan::AssetKind::kVisualMesh;
  std::uint64_t byte_size = 0;
  Sha256 hash;
};

// What a file is for, so that a missing one can be told with the tasks that need it.
struct AssetOwner {
  enum class Kind { kObject, kScene, kRobot, kFixture } kind = Kind::kObject;
  std::uint32_t id = 0;  // of the model

  bool operator==(const AssetOwner&) const = default;
};

// A file that is not there or not good.
struct AssetMiss {
  std::string path, why;
  Span span;                       // where it is named first
  std::vector<AssetOwner> owners;  // all that have it, each once
};

class AssetTable {
 public:
  // `hashed`: what is known of files already, and what is found out here.
  AssetTable(AssetRoot root, AssetInspector inspect, AssetHashes& hashed)
      : root_(std::move(root)), inspect_(std::move(inspect)), hashed_(hashed) {}

  // The index of the file; kNone, and a miss, when it is not there, not readable or not good. A
  // file is missed once, for all its owners.
  std::uint32_t add(const std::string& path, plan::AssetKind kind, const Span& span,
                    AssetOwner owner);

  bool has(const std::string& path) const;
  // Of one that is there: the size that it says it has; nothing where it is no image.
  std::optional<scene::ImageSize> image_size(std::uint32_t asset);
  // The first of `stem` + extension that is there, else with the first extension.
  std::string find(const std::string& stem, std::span<const std::string_view> extensions) const;

  const std::vector<AssetMiss>& misses() const { return misses_; }
  const std::vector<Asset>& assets() const { return assets_; }

 private:
  const AssetFolder& folder(const std::string& path);

  AssetRoot root_;
  std::map<std::string, AssetFolder> folders_;  // of the root, as they are needed
  AssetInspector inspect_;
  AssetHashes& hashed_;
  std::vector<AssetMiss> misses_;
  std::vector<Asset> assets_;
  std::map<std::pair<std::string, plan::AssetKind>, std::uint32_t> known_;
  std::map<std::uint32_t, std::optional<scene::ImageSize>> sizes_;
};

}  // namespace probe::emit
