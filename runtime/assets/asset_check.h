// Whether the files of an asset folder are good, before a plan is built on them. What the folder's
// manifest vouches for is not read again.
#pragma once

#include <map>
#include <string>

#include "runtime/assets/manifest.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/format.h"

namespace probe::assets {

class AssetCheck {
 public:
  // Fails (kAsset) on a manifest that cannot be read.
  static Result<AssetCheck> open(const AssetRoot& root);

  // Reads the file as a run would and says what is wrong with it, without its path. A file whose
  // size and hash are the manifest's is taken as good. `folder` may be another
  // than those that were opened, beside a text: what is no manifest of ours vouches for nothing.
  Status operator()(const std::string& folder, const std::string& path, plan::AssetKind kind,
                    const Sha256& hash) const;

 private:
  const Manifest& manifest(const std::string& folder) const;
  mutable std::map<std::string, Manifest> manifests_;  // by folder
};

}  // namespace probe::assets
