#include "runtime/export/dataset/pictures_again.h"

#include "runtime/export/dataset/pictures.h"
#include "runtime/store/run_plan.h"

namespace probe::dataset {

Status PicturesAgain::draw(const NamedDemonstration& named, const See& see) {
  const std::string& task = named.trace.header.task;
  if (plan_ != named.plan || task_ != task) {
    repeater_.reset();
    const std::uint32_t tasks[] = {*named.plan->find_task(task)};
    PROBE_ASSIGN(const AssetRoot root, store::find_run_assets(named.dir, assets_));
    PROBE_ASSIGN(auto assets, stage::SharedAssets::load(*named.plan, root, tasks));
    repeater_.emplace(*named.plan, std::move(assets));
    plan_ = named.plan;
    task_ = task;
  }
  return repeater_->repeat(named.trace, [&](auto frames, const auto&, std::size_t step) {
    return in_shape(shape_, frames, [&](auto pictures) { return see(pictures, step); });
  });
}

Result<std::span<const Sha256>> PicturesAgain::hashes(const NamedDemonstration& named) {
  if (hashed_ != named.trace_sha256) {
    hashed_.clear();
    hashes_.clear();
    PROBE_TRY(draw(named, [&](std::span<const Picture> pictures, std::size_t) -> Status {
      std::vector<std::span<const std::uint8_t>> rgb;
      for (const Picture& picture : pictures) rgb.push_back(picture.rgb);
      hashes_.push_back(hash_of(rgb));
      return {};
    }));
    hashed_ = named.trace_sha256;
  }
  return std::span<const Sha256>(hashes_);
}

}  // namespace probe::dataset
