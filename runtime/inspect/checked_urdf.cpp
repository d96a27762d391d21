#include "runtime/inspect/checked_urdf.h"

#include "runtime/base/file.h"
#include "runtime/base/sha256.h"
#include "runtime/plan/ids.h"

namespace probe::inspect {

Result<robot::RobotModel> checked_urdf(const plan::Plan& plan, std::uint32_t asset,
                                       const AssetRoot& asset_root) {
  const plan::AssetRecord& record = plan.assets()[asset];
  const std::string path = asset_root.file(plan.text(record.path));
  PROBE_ASSIGN(const std::string bytes, read_file(path, {.code = Fault::kAsset}));
  if (sha256(bytes) != plan::to_sha256(record.sha256))
    return Failure{Fault::kAsset, "has other bytes than when the plan was built", path};
  return robot::load_urdf(path);
}

}  // namespace probe::inspect
