// The description of a robot or of a fixture, with the bytes that a plan was built with.
#pragma once

#include <cstdint>
#include <string>

#include "runtime/base/asset_root.h"
#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/robot/urdf.h"

namespace probe::inspect {

// `asset`: of ASST. Fails (kAsset) when the file is not the one that the plan was built with,
// (kUrdf) when it cannot be used.
Result<robot::RobotModel> checked_urdf(const plan::Plan& plan, std::uint32_t asset,
                                       const AssetRoot& asset_root);

}  // namespace probe::inspect
