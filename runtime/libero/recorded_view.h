// What an imported task's cameras see of its first start, in states that no world has come to.
#pragma once

#include <span>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/libero/records.h"
#include "runtime/plan/plan.h"
#include "runtime/stage/stage.h"

namespace probe::libero {

// By object of the record, in its order: the body of the stage. The plan has objects in the order
// of their roles. Fails (kUsage) naming one that the import does not have.
Result<std::vector<std::size_t>> object_places(const stage::Stage& stage, const RecordedTask& task);

// As it is stored, before the waiting steps. Valid until the stage draws again, as below.
Result<std::span<const stage::CameraFrame>> first_frames(const plan::Plan& plan,
                                                         stage::Stage& stage);
// In a state of that start that was recorded. Fails (kUsage) where the import's robot, objects or
// fixtures are not those of the record.
Result<std::span<const stage::CameraFrame>> recorded_frames(const plan::Plan& plan,
                                                            stage::Stage& stage,
                                                            const RecordedTask& task,
                                                            const RecordedState& state);

}  // namespace probe::libero
