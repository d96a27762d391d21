// Golden pictures of a plan's own scenes: what a policy sees first.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/doctor/golden_scenes.h"
#include "runtime/plan/plan.h"

namespace probe::doctor {

// The settled first picture of the first start of the first task in each scene, every camera's, a
// quarter of its pixels: "start_table_carrot_on_plate", further cameras with their name behind it.
// `root` is the asset folder the plan was built with.
Result<std::vector<GoldenFrame>> draw_first_frames(const plan::Plan& plan, const std::string& root);

}  // namespace probe::doctor
