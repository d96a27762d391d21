// Files under the asset root that a plan refers to, by path and content. Each file is looked at
// once.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/source/source.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/format.h"

namespace probe::emit {

struct Asset {
  std::string path;  // relative to the asset root, with slashes
  plan::AssetKind kind = plan::AssetKind::kVisualMesh;
  std::uint64_t byte_size = 0;
  Sha256 hash;
};

class AssetTable {
 public:
  // `hashes` off: files are only looked for, which is enough to check a text.
  AssetTable(std::string root, bool hashes, Diagnostics& diagnostics)
      : root_(std::move(root)), hashes_(hashes), diagnostics_(diagnostics) {}

  // The index of the file; kNone, and P0202 at `span`, when it is not there or not readable. A file
  // is missed once.
  std::uint32_t add(const std::string& path, plan::AssetKind kind, const Span& span);

  const std::vector<Asset>& assets() const { return assets_; }

 private:
  std::string root_;
  bool hashes_;
  Diagnostics& diagnostics_;
  std::vector<Asset> assets_;
  std::map<std::pair<std::string, plan::AssetKind>, std::uint32_t> known_;
};

}  // namespace probe::emit
