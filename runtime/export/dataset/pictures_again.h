// The pictures of a dataset's demonstrations drawn again from their traces, to be held against
// those that it has.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/base/sha256.h"
#include "runtime/export/dataset/named_runs.h"
#include "runtime/export/dataset/repeater.h"

namespace probe::dataset {

class PicturesAgain {
 public:
  // `assets` as find_run_assets() takes them: of none, each run's own.
  PicturesAgain(const Shape& shape, AssetRoot assets)
      : shape_(shape), assets_(std::move(assets)) {}

  // In the dataset's cameras and sizes, valid until it returns.
  using See = std::function<Status(std::span<const Picture> pictures, std::size_t step)>;
  // Each proved to be what the policy saw. Fails as Repeater::repeat, and with files that are not
  // there (kAsset).
  Status draw(const NamedDemonstration& named, const See& see);
  // run::picture_hash of each step's, kept for the next wording of the same demonstration.
  Result<std::span<const Sha256>> hashes(const NamedDemonstration& named);

 private:
  Shape shape_;
  AssetRoot assets_;
  // Of the last demonstration's task; the next one's is mostly the same.
  const plan::Plan* plan_ = nullptr;
  std::string task_;
  std::optional<Repeater> repeater_;
  std::string hashed_;  // of which trace
  std::vector<Sha256> hashes_;
};

}  // namespace probe::dataset
