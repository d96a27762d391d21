// The URDF that a robot or a fixture names.
#pragma once

#include <optional>
#include <string>

#include "compiler/names/context.h"
#include "runtime/robot/urdf.h"

namespace probe::sema {

// Nothing, and the reason, where the file under the assets folder cannot be read. `what`: "the
// robot description".
std::optional<robot::RobotModel> described_by(Context& context, const Spelled& urdf,
                                              const std::string& what);

}  // namespace probe::sema
