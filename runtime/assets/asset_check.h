// Whether the files of an asset folder are good, before a plan is built on them. What the folder's
// manifest vouches for is not read again.
#pragma once

#include <string>

#include "runtime/assets/manifest.h"
#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/format.h"

namespace probe::assets {

class AssetCheck {
 public:
  // Fails (kAsset) on a manifest that cannot be read.
  static Result<AssetCheck> open(const std::string& root);

  // Reads the file as a run would and says what is wrong with it, without its path. A file whose
  // size, and hash where it is known, are the manifest's is taken as good.
  Status operator()(const std::string& path, plan::AssetKind kind, const Sha256* hash) const;

 private:
  AssetCheck(std::string root, Manifest manifest)
      : root_(std::move(root)), manifest_(std::move(manifest)) {}
  std::string root_;
  Manifest manifest_;
};

}  // namespace probe::assets
